// SPDX-License-Identifier: Apache-2.0
#include "remote/outside_controller.hpp"

#include <fmt/format.h>

#include "files/input_error.hpp"
#include "remote/controller_messages.hpp"

namespace millforce::sim {

namespace {

/// Nobody at the simulated machine holds the feed but the controller: a part on which it never comes back would not
/// end.
constexpr double longest_standstill_s = 10.0;

}  // namespace

OutsideController::OutsideController(const Scenario& scenario)
    : cnc_(scenario.parameters.machine.cnc),
      monitor_(monitoring(scenario.parameters)),
      counts_(scenario.parameters.machine.encoder_counts_per_rev) {}

std::string OutsideController::ask(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    monitor_.step(sample, program);
    counts_.follow(sample);
    ++samples_;
    TracePoint estimate;
    monitor_.describe(estimate);
    return sample_message({samples_, sample, program, counts_, estimate});
}

hal::FeedOverride OutsideController::take(std::string_view line) {
    const ControllerAnswer answer = read_answer(line, samples_, cnc_);
    own_estimate_ = answer.estimate;
    hal::FeedOverride output;
    output.ratio = answer.override_ratio;
    output.hold = answer.hold;
    output.heartbeat = static_cast<std::uint32_t>(samples_);
    refuse_standstill(output);
    return output;
}

void OutsideController::refuse_standstill(const hal::FeedOverride& output) {
    const bool stands = counts_.time_s() > 0.0 && (output.hold || !(output.ratio > 0.0F));
    stands_since_s_ = stands ? stands_since_s_ : counts_.time_s();
    if (stands && counts_.time_s() - stands_since_s_ > longest_standstill_s) {
        throw host::InputError(fmt::format("sample {}: the feed has been held for {:g} s, the program would not end",
                                           samples_, longest_standstill_s));
    }
}

void OutsideController::describe(TracePoint& point) const {
    monitor_.describe(point);
    point.limit = 0;
    point.fault = 0;
    if (own_estimate_) {
        copy_estimate(*own_estimate_, point);
    }
}

}  // namespace millforce::sim
