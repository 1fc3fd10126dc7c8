// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>

#include "emulated_controller.hpp"
#include "estimation/number/fixed_point.hpp"
#include "faults/campaign.hpp"
#include "firmware/parameters_in.hpp"
#include "loop/bounds.hpp"
#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "loop/simulation.hpp"

#include <CppUTest/TestHarness.h>

// A whole scenario milled by an image on an emulated processor, in lock-step with the plant on the host. The same tick
// runs on the host beside it: every answer must have the same bits. MILLFORCE_LOOP_SCENARIO names another scenario.

using namespace millforce;
using faults::SignalFault;

namespace {

bool has_own_scenario() {
    return std::getenv("MILLFORCE_LOOP_SCENARIO") != nullptr;
}

std::string scenario_file() {
    return has_own_scenario() ? std::getenv("MILLFORCE_LOOP_SCENARIO")
                              : MILLFORCE_SOURCE_DIR "/sim/scenarios/width_step.toml";
}

/// Gives the plant what the image says, and compares it with the host's own tick.
template <typename Scalar>
class ComparedController : public sim::OverrideSource {
  public:
    ComparedController(const std::string& processor, const firmware::Parameters<float>& parameters)
        : image_(processor, parameters), host_(firmware::parameters_in<Scalar>(parameters)), monitor_(parameters) {}

    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override {
        lock_step::Request request{};
        request.sample = sample;
        request.program = program;
        const hal::FeedOverride feed = host_.step(sample, program);  // as a chip: the law first
        firmware::finish_work(host_);
        const lock_step::Answer ours = lock_step::answer_of(host_, feed);
        const lock_step::Answer theirs = image_.step(request);
        ++steps;
        with_engagement += (ours.valid & 4U) != 0U ? 1 : 0;
        different += lock_step::same_bits(ours, theirs) ? 0 : 1;
        most_instructions = std::max(most_instructions, theirs.instructions);
        monitor_.step(sample, program);
        hal::FeedOverride held;
        return image_.works() ? theirs.feed : held;
    }
    void describe(sim::TracePoint& point) const override { monitor_.describe(point); }
    [[nodiscard]] bool image_works() const { return image_.works(); }

    int steps = 0;
    int with_engagement = 0;
    int different = 0;
    std::uint32_t most_instructions = 0;

  private:
    EmulatedController image_;
    firmware::SmallTick<Scalar> host_;
    sim::MillforceController monitor_;
};

/// `budget`: instructions of a step and a slice of the work beside it.
template <typename Scalar>
void mill_on(const std::string& processor, std::uint32_t budget) {
    const sim::Scenario scenario = sim::read_scenario(scenario_file());
    ComparedController<Scalar> controller(processor, scenario.parameters);
    CHECK_TRUE_TEXT(controller.image_works(), "the emulator does not start");
    const sim::Simulated run = sim::simulate(scenario, controller, processor);
    CHECK_TRUE(controller.image_works());
    CHECK_COMPARE(controller.steps, >, 1000);
    CHECK_COMPARE(controller.with_engagement, >, 1000);
    LONGS_EQUAL(0, controller.different);
    CHECK_TRUE(run.result.figures.finished);
    CHECK_TRUE(sim::bounds_hold(run.result.figures));

    UT_PRINT(StringFromFormat("%s: %d steps, with their longest slices %u instructions at most", processor.c_str(),
                              controller.steps, controller.most_instructions));
    CHECK_COMPARE(controller.most_instructions, >, 100U);  // they were counted
    CHECK_COMPARE(controller.most_instructions, <=, budget);
}

/// What a fault leads to on the host is what it leads to on the processor.
template <typename Scalar>
void meet_on(const std::string& processor, std::initializer_list<SignalFault> kinds) {
    const faults::Part part = faults::part_named("slot_entry");
    std::uint64_t seed = 0;
    for (const SignalFault fault : kinds) {
        ComparedController<Scalar> controller(processor, part.stated);
        CHECK_TRUE_TEXT(controller.image_works(), "the emulator does not start");
        faults::Tally tally;
        tally.add(faults::mill_with_controller(part, controller, fault, ++seed));
        LONGS_EQUAL_TEXT(0, controller.different, faults::name_of(fault));
        LONGS_EQUAL_TEXT(0, tally.violations(), faults::name_of(fault));
    }
}

}  // namespace

TEST_GROUP(ProcessorInTheLoop){void setup() override{std::signal(SIGPIPE, SIG_IGN);
setenv("MILLFORCE_ICOUNT", "1", 1);
}
void teardown() override {
    unsetenv("MILLFORCE_ICOUNT");
    std::signal(SIGPIPE, SIG_DFL);
}
}
;

TEST(ProcessorInTheLoop, a_Cortex_M4F_mills_a_part_as_the_host_does_bit_for_bit) {
    mill_on<float>("cortex-m4f", 16'800);
}

TEST(ProcessorInTheLoop, a_Cortex_M3_mills_it_in_fixed_point_bit_for_bit) {
    mill_on<estimation::Fixed>("cortex-m3", 47'000);
}

TEST(ProcessorInTheLoop, a_Cortex_M4F_meets_faults_as_the_host_does_bit_for_bit) {
    meet_on<float>("cortex-m4f", {SignalFault::spindle_frozen, SignalFault::x_tenfold, SignalFault::encoder_double,
                                  SignalFault::not_a_number, SignalFault::rapid_stuck, SignalFault::time_backwards});
}

// Of those that leave the range of fixed point, if anything does, and of one that does not.
TEST(ProcessorInTheLoop, a_Cortex_M3_meets_faults_as_the_host_does_in_fixed_point) {
    meet_on<estimation::Fixed>("cortex-m3",
                               {SignalFault::velocities_huge, SignalFault::not_a_number, SignalFault::spindle_weak});
}
