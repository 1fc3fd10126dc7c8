// SPDX-License-Identifier: Apache-2.0
#include "replay/slow_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "files/input_error.hpp"
#include "recording/recording.hpp"

namespace millforce::host {

namespace {

double middle_turn_rev(RecordingReader& recording, std::uint32_t encoder_counts_per_rev) {
    constexpr std::size_t looked_at = 2000;
    std::vector<double> turns_rev;
    std::uint32_t last_count = 0;
    for (std::size_t k = 0; k < looked_at && recording.next(); ++k) {
        const auto turned = static_cast<std::int32_t>(recording.sample().spindle_count - last_count);
        last_count = recording.sample().spindle_count;
        if (k > 0 && turned > 0) {
            turns_rev.push_back(static_cast<double>(turned) / encoder_counts_per_rev);
        }
    }
    if (turns_rev.empty()) {
        return 0.0;
    }
    const auto middle = turns_rev.begin() + static_cast<std::ptrdiff_t>(turns_rev.size() / 2);
    std::nth_element(turns_rev.begin(), middle, turns_rev.end());
    return *middle;
}

}  // namespace

int parts_of_slow_samples(const std::filesystem::path& log, std::uint32_t encoder_counts_per_rev) {
    constexpr double too_far_rev = 20.0;
    if (!std::filesystem::is_regular_file(log)) {
        return 1;  // what comes through a pipe can be read only once
    }
    RecordingReader recording(log, encoder_counts_per_rev);
    if (recording.has_force_sensor()) {
        return 1;
    }
    const double turn_rev = middle_turn_rev(recording, encoder_counts_per_rev);
    if (turn_rev >= too_far_rev) {
        throw InputError(
            fmt::format("{}: the spindle turns by {:.3g} revolutions between two samples; expected less than {:g}, and "
                        "spindle_angle_rad in rad",
                        log.string(), turn_rev, too_far_rev));
    }
    return turn_rev < farthest_rev ? 1 : static_cast<int>(std::ceil(turn_rev * filled_samples_per_rev));
}

firmware::MachineParameters<float> for_slow_samples(firmware::MachineParameters<float> machine, int parts) {
    const float factor = std::sqrt(static_cast<float>(parts));
    machine.spindle.current_sd_A *= factor;
    for (auto& axis : machine.axes) {
        axis.current_sd_A *= factor;
    }
    return machine;
}

hal::DriveSample sample_between(const hal::DriveSample& from, const hal::DriveSample& to, double share) {
    const auto mixed = [share](float a, float b) { return a + static_cast<float>(share) * (b - a); };
    const auto counted = [share](std::uint32_t a, std::uint32_t b) {
        const auto whole = static_cast<std::int32_t>(b - a);
        return a + static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(share * whole)));
    };
    hal::DriveSample between = to;
    between.present = static_cast<std::uint8_t>(from.present & to.present);
    between.time_us = counted(from.time_us, to.time_us);
    between.spindle_count = counted(from.spindle_count, to.spindle_count);
    between.spindle_index_count = from.spindle_index_count;
    between.spindle_index_number = from.spindle_index_number;
    between.spindle_current_A = mixed(from.spindle_current_A, to.spindle_current_A);
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        between.axis_current_A[k] = mixed(from.axis_current_A[k], to.axis_current_A[k]);
        between.axis_velocity_mm_s[k] = mixed(from.axis_velocity_mm_s[k], to.axis_velocity_mm_s[k]);
    }
    return between;
}

}  // namespace millforce::host
