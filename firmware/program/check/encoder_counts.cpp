// SPDX-License-Identifier: Apache-2.0
#include "check/encoder_counts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "calibration/plausible_units.hpp"

namespace millforce::host {

namespace {

/// Beyond it the direction of the turn is not known (estimation/signal/encoder_angle.hpp).
constexpr double farthest_step_rev = 0.45;
constexpr std::size_t fewest_pulses = 3;
constexpr const char* counts_key = "spindle.encoder_counts_per_rev";

}  // namespace

void EncoderCounts::add(const hal::DriveSample& sample) {
    if ((sample.present & hal::mask(hal::Present::spindle_count)) == 0) {
        has_last_ = false;
        index_number_ = 0;
        return;
    }
    follow_turning(sample);
    ++since_pulse_;
    if (sample.spindle_index_number == index_number_) {
        return;
    }
    // With a sample or none between two pulses, pulses may have been missed.
    constexpr int fewest_between = 3;
    if (index_number_ != 0 && since_pulse_ >= fewest_between) {
        const auto counts = static_cast<std::int32_t>(sample.spindle_index_count - index_count_);
        between_pulses_rev_.push_back(counts / counts_per_rev_);
    }
    index_number_ = sample.spindle_index_number;
    index_count_ = sample.spindle_index_count;
    since_pulse_ = 0;
}

void EncoderCounts::follow_turning(const hal::DriveSample& sample) {
    const double step_rev = static_cast<std::int32_t>(sample.spindle_count - last_count_) / counts_per_rev_;
    if (has_last_ && step_rev != 0.0) {
        ++steps_;
        backwards_ += step_rev < 0.0 ? 1U : 0U;
        too_far_ += std::abs(step_rev) >= farthest_step_rev ? 1U : 0U;
    }
    has_last_ = true;
    last_count_ = sample.spindle_count;
}

bool EncoderCounts::is_enough() const {
    return between_pulses_rev_.size() >= fewest_pulses;
}

double EncoderCounts::typical_rev() const {
    return median_of(between_pulses_rev_);
}

double EncoderCounts::tolerance_rev() const {
    return 1e-3 + 1.0 / counts_per_rev_;
}

bool EncoderCounts::is_proven(bool has_index) const {
    return has_index && is_enough() && std::abs(typical_rev() - 1.0) <= tolerance_rev();
}

Finding EncoderCounts::wrong_count() const {
    const double turned_rev = typical_rev();
    constexpr double degrees_per_rad = 180.0 / std::numbers::pi;
    const bool is_in_degrees = std::abs(turned_rev / degrees_per_rad - 1.0) < 0.01;
    return {Severity::error,
            fmt::format("spindle: from one index pulse to the next the recorded angle turns by {:.5g} revolutions{}",
                        turned_rev,
                        is_in_degrees ? "; is it in degrees?"
                                      : fmt::format(": {:.0f} counts per revolution instead of {:.0f}?",
                                                    std::abs(turned_rev) * counts_per_rev_, counts_per_rev_)),
            is_in_degrees ? "spindle_angle_rad" : counts_key};
}

Findings EncoderCounts::findings(const Beside& beside) const {
    const auto is_most = [this](std::size_t count) { return 2 * count > steps_; };
    if (steps_ == 0) {
        return {{Severity::note, "spindle: it never turns: its encoder is not judged", counts_key}};
    }
    if (beside.has_index && is_enough() && std::abs(std::abs(typical_rev()) - 1.0) > tolerance_rev()) {
        return {wrong_count()};
    }
    if (is_most(too_far_)) {
        return {{Severity::error,
                 fmt::format("spindle: it turns by {} revolutions or more from one sample to the next; expected "
                             "closer samples, and an angle in rad",
                             farthest_step_rev),
                 "spindle_angle_rad"}};
    }
    if (is_most(backwards_)) {
        return {{Severity::error, "spindle: it turns backwards; expected an angle that grows in the cutting direction",
                 "bus.spindle.count_reversed"}};
    }
    if (!beside.has_index || !is_enough()) {
        return {{Severity::note,
                 fmt::format("spindle: no index pulses in the recording: the encoder's counts are {}",
                             beside.has_command ? "compared with the commanded speed alone" : "not compared"),
                 counts_key}};
    }
    return {};
}

}  // namespace millforce::host
