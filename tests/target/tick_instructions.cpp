// SPDX-License-Identifier: Apache-2.0
// Counts the instructions of each tick of the synthetic cuts, and the stack that they need: with the engagement solved
// in portions and without the wide-band methods, as a small processor runs it. To be run with MILLFORCE_ICOUNT=1, see
// instruction_counter.hpp. Prints one line per figure: SCALAR KIND FIGURE VALUE. Exit code 1: the estimator did not
// find the cut.

#include <cstdint>
#include <new>
#include <type_traits>

#include "common/processor.hpp"
#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in.hpp"
#include "firmware/tick.hpp"
#include "instructions/synthetic_cut.hpp"
#include "target/instruction_counter.hpp"
#include "target/semihosting.hpp"

namespace {

using namespace millforce;
using target::write_number;
using target::write_text;

struct Count {
    std::uint32_t steps = 0;
    std::uint32_t sum = 0;
    std::uint32_t worst = 0;
    void add(std::uint32_t instructions) {
        ++steps;
        sum += instructions;
        worst = instructions > worst ? instructions : worst;
    }
};

void print(const char* scalar, const char* kind, const char* figure, std::uint32_t value) {
    for (const char* word : {scalar, " ", kind, " ", figure, " "}) {
        write_text(word);
    }
    write_number(value);
    write_text("\n");
}

void print(const char* scalar, const char* kind, const Count& count) {
    print(scalar, kind, "mean", (count.sum + count.steps / 2) / count.steps);
    print(scalar, kind, "worst", count.worst);
}

template <typename Scalar>
using Tick = firmware::SmallTick<Scalar>;

/// Values of the solver in one tick: so many that its worst is about that of a tooth period's end. Without an FPU one,
/// whichever the scalar: what is compared there does the same work.
#ifdef __ARM_FP
template <typename Scalar>
constexpr float solver_values_per_tick = std::is_same_v<Scalar, float> ? 6.0F : 1.0F;
#else
template <typename Scalar>
constexpr float solver_values_per_tick = 1.0F;
#endif

template <typename Scalar>
[[gnu::noipa]] hal::FeedOverride counted_step(Tick<Scalar>& tick, const hal::DriveSample& sample,
                                              const hal::ProgramStatus& program) {
    return tick.step(sample, program);
}

template <typename Scalar>
bool count_steps(const char* name, const instructions::Cut& cut, std::uint32_t& stack) {
    const target::InstructionCounter counter;
    auto parameters = instructions::machine_and_tool();
    parameters.machine.cnc.solver_values_per_tick = solver_values_per_tick<Scalar>;
    alignas(Tick<Scalar>) static unsigned char memory[sizeof(Tick<Scalar>)];
    Tick<Scalar>& tick = *new (memory) Tick<Scalar>(firmware::parameters_in<Scalar>(parameters));
    Count all;
    std::uint32_t estimates = 0;
    std::uint32_t with_engagement = 0;
    const int settled = cut.air_samples + cut.settling_samples;
    for (int index = 0; index < cut.samples(); ++index) {
        const hal::DriveSample sample = instructions::sample_of(index, parameters, cut);
        const hal::ProgramStatus program = instructions::program_at(index, cut);
        const Scalar before_s = tick.estimator().since_period_s();
        board::paint_stack();
        const std::uint32_t untouched = board::untouched_stack_bytes();
        const std::uint32_t start = counter.now();
        counted_step(tick, sample, program);
        const std::uint32_t instructions = counter.since(start);
        const std::uint32_t used = untouched - board::untouched_stack_bytes();
        stack = used > stack ? used : stack;
        if (index < settled) {
            continue;
        }
        const bool is_new = tick.estimator().since_period_s() < before_s;
        all.add(instructions);
        const auto& estimate = tick.estimate();
        estimates += is_new ? 1U : 0U;
        // At the end of a tooth period the forces are new, and the engagement comes back with the peaks, a tick later.
        const bool knows = estimate.engagement.immersion_valid && estimate.engagement.depth_valid;
        with_engagement += !is_new && knows ? 1U : 0U;
    }
    print(name, cut.name, all);
    return estimates > 0 && with_engagement >= estimates;
}

}  // namespace

void millforce::board::run_image() {
    bool all_found = true;
    std::uint32_t stack = 0;
    for (const auto& cut : instructions::cuts) {
        all_found = count_steps<MILLFORCE_SCALAR>(MILLFORCE_SCALAR_NAME, cut, stack) && all_found;
    }
    print(MILLFORCE_SCALAR_NAME, "tick", "RAM", sizeof(Tick<MILLFORCE_SCALAR>));
    print(MILLFORCE_SCALAR_NAME, "tick", "stack", stack);
    target::exit_emulator(all_found ? 0 : 1);
}
