// SPDX-License-Identifier: Apache-2.0
#include "check/check_recording.hpp"

#include "calibration/plausible_units.hpp"
#include "check/air.hpp"
#include "check/axis_friction.hpp"
#include "check/commanded_speed.hpp"
#include "check/recorded_units.hpp"
#include "check/spindle_idle.hpp"
#include "check/tooth_lines.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"
#include "firmware/usable_signals.hpp"
#include "recording/recording.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

namespace millforce::host {

namespace {

bool has(const hal::DriveSample& sample, hal::Present quantity) {
    return (sample.present & hal::mask(quantity)) != 0;
}

/// The sample without what the controller does not use either: what is not finite, or faster than any axis.
hal::DriveSample usable_sample(const hal::DriveSample& sample) {
    hal::DriveSample usable = firmware::usable_drives_of(sample);
    if (has(sample, hal::Present::spindle_count)) {
        usable.spindle_count = sample.spindle_count;
        usable.spindle_index_count = sample.spindle_index_count;
        usable.spindle_index_number = sample.spindle_index_number;
        hal::set_present(usable, hal::Present::spindle_count);
    }
    if (has(sample, hal::Present::force_sensor) && std::isfinite(sample.force_N[0])) {
        usable.force_N = sample.force_N;
        hal::set_present(usable, hal::Present::force_sensor);
    }
    return usable;
}

}  // namespace

RecordingCheck::RecordingCheck(const firmware::Parameters<float>& parameters, bool has_index)
    : parameters_(parameters),
      has_index_(has_index),
      windows_(parameters.machine.encoder_counts_per_rev),
      encoder_(parameters.machine.encoder_counts_per_rev) {
    parameters_.machine.spindle = firmware::spindle_parameters(parameters.machine);
}

void RecordingCheck::Channel::add(bool is_present, float value) {
    if (is_present) {
        changed_ = changed_ || (samples_ > 0 && value != first_);
        first_ = samples_ == 0 ? value : first_;
        ++samples_;
    }
}

void RecordingCheck::add(double time_s, const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    const hal::DriveSample usable = usable_sample(sample);
    first_s_ = samples_ == 0 ? time_s : first_s_;
    last_s_ = time_s;
    ++samples_;
    windows_.add(time_s, usable, program);
    encoder_.add(usable);
    channels_[0].add(has(usable, hal::Present::spindle_current), usable.spindle_current_A);
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        channels_.at(k + 1).add((usable.present & hal::axis_mask(k)) != 0, usable.axis_current_A.at(k));
    }
    add_to_spectrum(time_s, usable);
}

void RecordingCheck::add_to_spectrum(double time_s, const hal::DriveSample& sample) {
    const bool has_force = has(sample, hal::Present::force_sensor);
    has_force_ = has_force_ || has_force;
    if (!has(sample, hal::Present::spindle_count) || !(has_force || has(sample, hal::Present::spindle_current))) {
        last_count_.reset();
        return;
    }
    // A first sample turns by more than any may: a new block begins.
    const double turned_rev = last_count_ ? static_cast<std::int32_t>(sample.spindle_count - *last_count_) /
                                                static_cast<double>(parameters_.machine.encoder_counts_per_rev)
                                          : 1.0;
    last_count_ = sample.spindle_count;
    blocks_.add(time_s, turned_rev, static_cast<double>(has_force ? sample.force_N[0] : sample.spindle_current_A));
}

/// A thousandth of the rate that the machine's file states: within a factor of 3.
Findings RecordingCheck::why_nothing_is_judged() const {
    constexpr std::size_t fewest_samples = 10;
    const double rate_hz = static_cast<double>(samples_) / (last_s_ - first_s_);
    const double of_stated = rate_hz / static_cast<double>(parameters_.machine.cnc.sample_rate_hz);
    if (samples_ >= fewest_samples && of_stated > 0.33e-3 && of_stated < 3e-3) {
        return {{Severity::error,
                 fmt::format("{:.4g} samples per second, and the machine's file says {:g}; is the time in ms?", rate_hz,
                             parameters_.machine.cnc.sample_rate_hz),
                 "time_s"}};
    }
    return {{Severity::note, "too short, or too few samples per second, to judge anything", "time_s"}};
}

Findings RecordingCheck::findings(const std::string& name) const {
    std::vector<MotionWindow> windows = windows_.windows();
    if (windows.empty()) {
        return why_nothing_is_judged();
    }
    find_air(windows, parameters_, !channels_[0].stands());
    std::array<bool, hal::axis_count> axes_stand{};
    for (std::size_t k = 0; k < axes_stand.size(); ++k) {
        axes_stand.at(k) = channels_.at(k + 1).stands();
    }
    Findings findings = check_motion(name, windows, parameters_);
    const bool is_motion_wrong = is_something_wrong(findings);
    const std::optional<double> to_command = ratio_to_commanded_speed(windows);
    Findings of_encoder = encoder_.findings({has_index_, to_command.has_value()});
    if (!is_something_wrong(of_encoder)) {
        append(of_encoder, check_commanded_speed(to_command, parameters_.machine, encoder_.is_proven(has_index_)));
    }
    append(findings, std::move(of_encoder));
    append(findings, check_spindle_current(windows, parameters_.machine, channels_[0].stands()));
    if (is_motion_wrong) {  // in another unit: nothing of what is worked out from it would help
        return findings;
    }
    append(findings, check_axis_currents(windows, parameters_.machine, axes_stand));
    const bool comes_seldom = !has_force_ && parameters_.machine.spindle_load_period_s > 0.0F;
    append(findings,
           check_teeth({blocks_.blocks(), encoder_.is_proven(has_index_), comes_seldom}, windows, parameters_.tool));
    return findings;
}

Findings check_recording(const std::filesystem::path& recording, const firmware::Parameters<float>& parameters) {
    // It makes all that is worked out from the angle wrong, and is looked for first.
    if (const auto why = angle_in_another_unit(recording)) {
        return {{Severity::error, *why, "spindle_angle_rad"}};
    }
    RecordingReader reader(recording, parameters.machine.encoder_counts_per_rev);
    RecordingCheck check(parameters, reader.has_index());
    Progress progress("reading " + recording.string());
    bool has_rows = false;
    while (reader.next()) {
        has_rows = true;
        progress.update(reader.fraction_read());
        check.add(reader.time_s(), reader.sample(), reader.program());
    }
    if (!has_rows) {
        throw InputError(recording.string() + ": no rows after the header, expected a recording");
    }
    return check.findings(recording.string());
}

}  // namespace millforce::host
