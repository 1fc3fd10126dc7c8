// SPDX-License-Identifier: Apache-2.0
#include "recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "estimation/number/circle.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

constexpr double turn_rad = estimation::turn_rad<double>;
constexpr std::array<std::string_view, hal::axis_count> axis_names{"x", "y", "z"};

constexpr std::string_view header =
    "time_s,spindle_angle_rad,spindle_current_A,x_current_A,y_current_A,z_current_A,x_velocity_mm_s,y_velocity_mm_s,"
    "z_velocity_mm_s,override,spindle_index_angle_rad,programmed_feed_mm_s,rapid,commanded_speed_rad_s";

bool has(const hal::DriveSample& sample, std::uint8_t mask) {
    return (sample.present & mask) != 0;
}

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& file, std::uint32_t encoder_counts_per_rev,
                                 bool has_force_sensor)
    : file_(file), counts_(encoder_counts_per_rev), has_force_sensor_(has_force_sensor) {
    file_.stream() << header << (has_force_sensor_ ? ",fx_N,fy_N\n" : "\n");
}

template <typename Value>
void RecordingWriter::cell(Value value, bool present) {
    line_ += ',';
    if (present) {
        line_ += CsvWriter::cell(value);
    }
}

void RecordingWriter::add(const RecordedStep& step) {
    const hal::DriveSample& s = step.sample;
    counts_.follow(s);
    const bool has_force = has_force_sensor_ && has(s, hal::mask(hal::Present::force_sensor));
    line_ = CsvWriter::cell(counts_.time_s());
    cell(counts_.angle_rad(), ContinuousCounts::has_count(s));
    cell(s.spindle_current_A, has(s, hal::mask(hal::Present::spindle_current)));
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        cell(s.axis_current_A[k], has(s, hal::axis_mask(k)));
    }
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        cell(s.axis_velocity_mm_s[k], has(s, hal::axis_mask(k)) || (k < s.force_N.size() && has_force));
    }
    cell(step.override_ratio);
    cell(counts_.index_angle_rad(s), ContinuousCounts::has_index(s));
    cell(step.program.programmed_feed_mm_s);
    line_ += step.program.rapid ? ",1" : ",0";
    cell(step.program.commanded_speed_rad_s);
    for (std::size_t k = 0; has_force_sensor_ && k < s.force_N.size(); ++k) {
        cell(s.force_N[k], has_force);
    }
    line_ += '\n';
    file_.stream() << line_;
}

RecordingReader::RecordingReader(const std::filesystem::path& file, std::uint32_t encoder_counts_per_rev)
    : RecordingReader(std::make_unique<CsvReader>(file), encoder_counts_per_rev) {}

RecordingReader::RecordingReader(std::unique_ptr<NumberTable> rows, std::uint32_t encoder_counts_per_rev)
    : rows_(std::move(rows)),
      counts_per_rev_(encoder_counts_per_rev),
      time_(rows_->require("time_s")),
      angle_(rows_->require("spindle_angle_rad", "averages are taken over the spindle's angle")),
      spindle_current_(rows_->find("spindle_current_A")),
      fx_(rows_->find("fx_N")),
      fy_(rows_->find("fy_N")),
      index_angle_(rows_->find("spindle_index_angle_rad")),
      programmed_feed_(rows_->find("programmed_feed_mm_s")),
      rapid_(rows_->find("rapid")),
      commanded_speed_(rows_->find("commanded_speed_rad_s")),
      tool_(rows_->find("tool")) {
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        axes_[k].current = rows_->find(fmt::format("{}_current_A", axis_names[k]));
        axes_[k].velocity = rows_->find(fmt::format("{}_velocity_mm_s", axis_names[k]));
    }
    require_drives();
}

/// A force sensor replaces the currents, but not the velocities.
void RecordingReader::require_drives() const {
    if (!has_force_sensor()) {
        rows_->require("spindle_current_A", "the tangential force comes from it");
    }
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        const bool gives_feed = has_force_sensor() ? k < 2 : axes_[k].current.has_value();
        if (gives_feed && axes_[k].velocity) {
            return;
        }
    }
    const char* expected = has_force_sensor()
                               ? "expected the column x_velocity_mm_s or y_velocity_mm_s: the feed per tooth and its "
                                 "direction come from the velocities"
                               : "expected the columns x_current_A and x_velocity_mm_s, or those of y or z: the feed "
                                 "per tooth comes from the velocities";
    rows_->fail_names(expected);
}

bool RecordingReader::next() {
    if (!rows_->next_row()) {
        return false;
    }
    const double time_s = rows_->required_number(time_, -1e9, 1e9);
    if (time_s <= time_s_) {
        rows_->fail(time_, fmt::format("{} after {}, expected a time that grows", time_s, time_s_));
    }
    time_s_ = time_s;
    sample_ = {};
    sample_.time_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround((time_s + 1e9) * 1e6)));
    read_spindle();
    read_axes();
    read_force_sensor();
    read_program();
    read_tool();
    return true;
}

/// The encoder's count at an angle; the tolerance is for the angle's last digit.
std::optional<std::uint32_t> RecordingReader::count_at(std::optional<CsvColumn> column) const {
    const double angle = rows_->number(column);
    if (std::isnan(angle)) {
        return std::nullopt;
    }
    if (std::abs(angle) > 1e7) {
        rows_->fail(*column, fmt::format("{}, expected an angle within ±1e7 rad", angle));
    }
    return static_cast<std::uint32_t>(
        static_cast<std::int64_t>(std::floor(angle / turn_rad * static_cast<double>(counts_per_rev_) + 1e-6)));
}

/// An angle that begins again after each turn goes on.
void RecordingReader::follow_turns(double angle_rad) {
    const bool within_a_turn = std::max(std::abs(angle_rad), std::abs(last_angle_rad_)) < 1.05 * turn_rad;
    if (within_a_turn && angle_rad < last_angle_rad_ - 0.5 * turn_rad) {
        ++whole_turns_;
    }
    last_angle_rad_ = angle_rad;
}

/// Without a column for the index pulses the angle's zero is where they come: at the last whole turn.
std::optional<std::uint32_t> RecordingReader::index_of_zero() const {
    if ((sample_.present & hal::mask(hal::Present::spindle_count)) == 0) {
        return std::nullopt;
    }
    const double turns = std::floor(rows_->number(angle_) / turn_rad + 1e-9) + whole_turns_;
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(turns) * static_cast<std::int64_t>(counts_per_rev_));
}

void RecordingReader::read_spindle() {
    if (const auto count = count_at(angle_)) {
        if (!index_angle_) {
            follow_turns(rows_->number(angle_));
        }
        sample_.spindle_count = *count + static_cast<std::uint32_t>(whole_turns_) * counts_per_rev_;
        sample_.present |= hal::mask(hal::Present::spindle_count);
    }
    if (const auto index = index_angle_ ? count_at(index_angle_) : index_of_zero();
        index && (index_number_ == 0 || *index != index_count_)) {
        index_count_ = *index;
        index_number_ = static_cast<std::uint8_t>(index_number_ == 255 ? 1 : index_number_ + 1);
    }
    sample_.spindle_index_count = index_count_;
    sample_.spindle_index_number = index_number_;
    const double current = rows_->number(spindle_current_);
    if (std::isfinite(current)) {
        sample_.spindle_current_A = static_cast<float>(current);
        sample_.present |= hal::mask(hal::Present::spindle_current);
    }
}

void RecordingReader::read_axes() {
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        const double current = rows_->number(axes_[k].current);
        const double velocity = rows_->number(axes_[k].velocity);
        if (std::isfinite(current) && std::isfinite(velocity)) {
            sample_.axis_current_A[k] = static_cast<float>(current);
            sample_.axis_velocity_mm_s[k] = static_cast<float>(velocity);
            sample_.present |= hal::axis_mask(k);
        }
    }
}

void RecordingReader::read_force_sensor() {
    if (!has_force_sensor()) {
        return;
    }
    const std::array<double, 2> force_N{rows_->number(fx_), rows_->number(fy_)};
    bool is_there = true;
    for (std::size_t k = 0; k < force_N.size(); ++k) {
        const double velocity_mm_s = axes_[k].velocity ? rows_->number(axes_[k].velocity) : 0.0;
        is_there = is_there && std::isfinite(force_N[k]) && std::isfinite(velocity_mm_s);
        sample_.force_N[k] = static_cast<float>(force_N[k]);
        sample_.axis_velocity_mm_s[k] = static_cast<float>(velocity_mm_s);
    }
    sample_.present |= is_there ? hal::mask(hal::Present::force_sensor) : std::uint8_t{0};
}

void RecordingReader::read_program() {
    const double feed_mm_s = rows_->number(programmed_feed_);
    if (feed_mm_s < 0.0 || feed_mm_s > 1e5) {
        rows_->fail(*programmed_feed_, fmt::format("{}, expected a feed from 0 to 1e5 mm/s", feed_mm_s));
    }
    program_.programmed_feed_mm_s = std::isnan(feed_mm_s) ? 0.0F : static_cast<float>(feed_mm_s);
    program_.rapid = rows_->number(rapid_) > 0.5;
    const double speed_rad_s = rows_->number(commanded_speed_);
    if (speed_rad_s < 0.0 || speed_rad_s > 1e5) {
        rows_->fail(*commanded_speed_, fmt::format("{}, expected a speed from 0 to 1e5 rad/s", speed_rad_s));
    }
    program_.commanded_speed_rad_s = std::isnan(speed_rad_s) ? 0.0F : static_cast<float>(speed_rad_s);
}

void RecordingReader::read_tool() {
    const double number = rows_->number(tool_);
    if (std::isnan(number)) {
        tool_number_ = 0;
        return;
    }
    constexpr double largest = std::numeric_limits<std::uint32_t>::max();
    if (!(number >= 0.0 && number <= largest) || number != std::floor(number)) {
        rows_->fail(*tool_, fmt::format("{}, expected the number of a tool; 0 or nothing where there is none", number));
    }
    tool_number_ = static_cast<std::uint32_t>(number);
}

}  // namespace millforce::host
