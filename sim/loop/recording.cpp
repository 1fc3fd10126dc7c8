#include "loop/recording.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "files/atomic_file.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr double revolution = 2.0 * std::numbers::pi;
constexpr std::array<std::string_view, 3> axis_names{"x", "y", "z"};

}  // namespace

void write_recording(const std::filesystem::path& file, const std::vector<RecordedSample>& samples) {
    constexpr std::array<std::string_view, 10> columns{
        "time_s",          "spindle_angle_rad", "spindle_current_A", "x_current_A",     "y_current_A",
        "z_current_A",     "x_velocity_mm_s",   "y_velocity_mm_s",   "z_velocity_mm_s", "override"};
    AtomicFile target(file);
    CsvWriter csv(target.stream(), columns);
    for (const RecordedSample& recorded : samples) {
        const hal::DriveSample& s = recorded.sample;
        const auto rounded = [](float value) { return std::round(static_cast<double>(value) * 1e6) / 1e6; };
        const std::array<double, 10> row{static_cast<double>(s.time_us) * 1e-6,
                                         recorded.spindle_angle_rad,
                                         rounded(s.spindle_current_A),
                                         rounded(s.axis_current_A[0]),
                                         rounded(s.axis_current_A[1]),
                                         rounded(s.axis_current_A[2]),
                                         rounded(s.axis_velocity_mm_s[0]),
                                         rounded(s.axis_velocity_mm_s[1]),
                                         rounded(s.axis_velocity_mm_s[2]),
                                         recorded.override_ratio};
        csv.row(row);
    }
    target.commit();
}

RecordingReader::RecordingReader(const std::filesystem::path& file, std::uint32_t encoder_counts_per_rev)
    : csv_(file),
      counts_per_rev_(encoder_counts_per_rev),
      time_(csv_.require("time_s")),
      angle_(csv_.require("spindle_angle_rad", "averages are taken over the spindle's angle")),
      spindle_current_(csv_.require("spindle_current_A", "the tangential force comes from it")),
      override_(csv_.find("override")) {
    bool any = false;
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        axes_[k].current = csv_.find(fmt::format("{}_current_A", axis_names[k]));
        axes_[k].velocity = csv_.find(fmt::format("{}_velocity_mm_s", axis_names[k]));
        any = any || (axes_[k].current && axes_[k].velocity);
    }
    if (!any) {
        throw InputError(fmt::format("{}:1: expected the columns x_current_A and x_velocity_mm_s, or those of y or z: "
                                     "the feed per tooth comes from the velocities",
                                     file.string()));
    }
}

bool RecordingReader::next() {
    if (!csv_.next_row()) {
        return false;
    }
    const double time_s = csv_.required_number(time_, -1e9, 1e9);
    if (time_s <= time_s_) {
        csv_.fail(time_, fmt::format("{} after {}, expected a time that grows", time_s, time_s_));
    }
    time_s_ = time_s;
    sample_ = {};
    sample_.time_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround((time_s + 1e9) * 1e6)));
    const double angle = csv_.number(angle_);
    if (std::isfinite(angle)) {
        if (std::abs(angle) > 1e7) {
            csv_.fail(angle_, fmt::format("{}, expected an angle within ±1e7 rad", angle));
        }
        sample_.spindle_count = static_cast<std::uint32_t>(
            static_cast<std::int64_t>(std::floor(angle / revolution * static_cast<double>(counts_per_rev_) + 1e-6)));
        sample_.present |= hal::mask(hal::Present::spindle_count);
    }
    const double current = csv_.number(spindle_current_);
    if (std::isfinite(current)) {
        sample_.spindle_current_A = static_cast<float>(current);
        sample_.present |= hal::mask(hal::Present::spindle_current);
    }
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        const double axis_current = csv_.number(axes_[k].current);
        const double velocity = csv_.number(axes_[k].velocity);
        if (std::isfinite(axis_current) && std::isfinite(velocity)) {
            sample_.axis_current_A[k] = static_cast<float>(axis_current);
            sample_.axis_velocity_mm_s[k] = static_cast<float>(velocity);
            sample_.present |= hal::axis_mask(k);
        }
    }
    return true;
}

double RecordingReader::override_ratio() const { return csv_.number(override_); }

}  // namespace millforce::sim
