// SPDX-License-Identifier: Apache-2.0
// Counts the instructions of the tick as a small processor has it, without the wide-band methods, and the stack that it
// needs, in a cut of which each revolution is another one. The side of the tool is known, then it is not, which doubles
// the solver's work. To be run with MILLFORCE_ICOUNT=1, see instruction_counter.hpp. Prints one line per figure:
// SCALAR FIGURE VALUE. Exit code 1: the estimator did not find the cut.

#include <algorithm>
#include <cstdint>
#include <new>

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
using Scalar = MILLFORCE_SCALAR;
using Tick = firmware::SmallTick<Scalar>;

/// The most instructions of each.
struct Worst {
    std::uint32_t step = 0;
    std::uint32_t slice = 0;
    std::uint32_t estimate = 0;           ///< all slices of one
    std::uint32_t step_and_estimate = 0;  ///< both between two samples
    std::uint32_t stack_bytes = 0;
};

void print(const char* figure, std::uint32_t value) {
    for (const char* word : {MILLFORCE_SCALAR_NAME, " ", figure, " "}) {
        write_text(word);
    }
    write_number(value);
    write_text("\n");
}

/// Kept as a function of its own, so that only its instructions are counted; so is counted_slice().
[[gnu::noipa]] hal::FeedOverride counted_step(Tick& tick, const hal::DriveSample& sample,
                                              const hal::ProgramStatus& program) {
    return tick.step(sample, program);
}

[[gnu::noipa]] void counted_slice(Tick& tick) {
    tick.work();
}

/// Instructions of a call, and its stack.
template <typename Call>
std::uint32_t count(const target::InstructionCounter& counter, Worst& worst, Call call) {
    board::paint_stack();
    const std::uint32_t untouched = board::untouched_stack_bytes();
    const std::uint32_t start = counter.now();
    call();
    const std::uint32_t instructions = counter.since(start);
    worst.stack_bytes = std::max(worst.stack_bytes, untouched - board::untouched_stack_bytes());
    return instructions;
}

bool count_cut(estimation::CutSide side, Worst& worst) {
    const target::InstructionCounter counter;
    const instructions::Cut& cut = instructions::fast_widening_cut;
    auto parameters = instructions::machine_and_tool();
    parameters.tool.side = side;
    alignas(Tick) static unsigned char memory[sizeof(Tick)];
    Tick& tick = *new (memory) Tick(firmware::parameters_in<Scalar>(parameters));
    for (int index = 0; index < cut.samples(); ++index) {
        const hal::DriveSample sample = instructions::sample_of(index, parameters, cut);
        const hal::ProgramStatus program = instructions::program_at(index, cut);
        const std::uint32_t step = count(counter, worst, [&] { counted_step(tick, sample, program); });
        std::uint32_t estimate = 0;
        while (tick.work_due()) {
            const std::uint32_t slice = count(counter, worst, [&] { counted_slice(tick); });
            worst.slice = std::max(worst.slice, slice);
            estimate += slice;
        }
        worst.step = std::max(worst.step, step);
        worst.estimate = std::max(worst.estimate, estimate);
        worst.step_and_estimate = std::max(worst.step_and_estimate, step + estimate);
    }
    const auto& engagement = tick.estimate().engagement;
    return engagement.immersion_valid && engagement.depth_valid;
}

}  // namespace

void millforce::board::run_image() {
    Worst worst;
    bool has_found = count_cut(estimation::CutSide::down, worst);
    print("step_and_estimate_of_known_side", worst.step_and_estimate);
    has_found = count_cut(estimation::CutSide::unknown, worst) && has_found;
    print("step", worst.step);
    print("slice", worst.slice);
    print("step_and_slice", worst.step + worst.slice);
    print("estimate", worst.estimate);
    print("step_and_estimate", worst.step_and_estimate);
    print("RAM", sizeof(Tick));
    print("stack", worst.stack_bytes);
    target::exit_emulator(has_found ? 0 : 1);
}
