// SPDX-License-Identifier: Apache-2.0
#include "import/quantity.hpp"

#include <array>
#include <stdexcept>

#include "estimation/number/circle.hpp"

namespace millforce::host {

namespace {

constexpr double turn_rad = estimation::turn_rad<double>;
constexpr double inch_mm = 25.4;
constexpr double pound_force_N = 4.4482216152605;  // exact by definition

constexpr std::uint8_t needs_nothing = 0;
constexpr auto needs_rated = static_cast<std::uint8_t>(UnitNeed::rated_A);
constexpr auto needs_counts = static_cast<std::uint8_t>(UnitNeed::counts_per_rev);
constexpr auto needs_pitch = static_cast<std::uint8_t>(UnitNeed::screw_pitch_mm);
constexpr auto needs_rate = static_cast<std::uint8_t>(UnitNeed::rate_hz);

constexpr std::array known_units{
    Unit{Quantity::time, "s", 1.0, needs_nothing},
    Unit{Quantity::time, "ms", 1e-3, needs_nothing},
    Unit{Quantity::time, "us", 1e-6, needs_nothing},
    Unit{Quantity::time, "ns", 1e-9, needs_nothing},
    Unit{Quantity::time, "samples", 1.0, needs_rate},
    Unit{Quantity::angle, "rad", 1.0, needs_nothing},
    Unit{Quantity::angle, "deg", turn_rad / 360.0, needs_nothing},
    Unit{Quantity::angle, "rev", turn_rad, needs_nothing},
    Unit{Quantity::angle, "counts", turn_rad, needs_counts},
    Unit{Quantity::speed, "rad/s", 1.0, needs_nothing},
    Unit{Quantity::speed, "rpm", turn_rad / 60.0, needs_nothing},
    Unit{Quantity::speed, "rev/s", turn_rad, needs_nothing},
    Unit{Quantity::speed, "deg/s", turn_rad / 360.0, needs_nothing},
    Unit{Quantity::pulse, "1", 1.0, needs_nothing},
    Unit{Quantity::current, "A", 1.0, needs_nothing},
    Unit{Quantity::current, "mA", 1e-3, needs_nothing},
    Unit{Quantity::current, "%", 1e-2, needs_rated},
    Unit{Quantity::current, "permille", 1e-3, needs_rated},
    Unit{Quantity::current, "rated", 1.0, needs_rated},
    Unit{Quantity::velocity, "mm/s", 1.0, needs_nothing},
    Unit{Quantity::velocity, "mm/min", 1.0 / 60.0, needs_nothing},
    Unit{Quantity::velocity, "m/min", 1000.0 / 60.0, needs_nothing},
    Unit{Quantity::velocity, "m/s", 1000.0, needs_nothing},
    Unit{Quantity::velocity, "in/min", inch_mm / 60.0, needs_nothing},
    Unit{Quantity::velocity, "in/s", inch_mm, needs_nothing},
    Unit{Quantity::velocity, "rev/s", 1.0, needs_pitch},
    Unit{Quantity::velocity, "rpm", 1.0 / 60.0, needs_pitch},
    Unit{Quantity::velocity, "counts/s", 1.0, needs_pitch | needs_counts},
    Unit{Quantity::position, "mm", 1.0, needs_nothing},
    Unit{Quantity::position, "um", 1e-3, needs_nothing},
    Unit{Quantity::position, "m", 1e3, needs_nothing},
    Unit{Quantity::position, "in", inch_mm, needs_nothing},
    Unit{Quantity::position, "rev", 1.0, needs_pitch},
    Unit{Quantity::position, "counts", 1.0, needs_pitch | needs_counts},
    Unit{Quantity::feed, "mm/s", 1.0, needs_nothing},
    Unit{Quantity::feed, "mm/min", 1.0 / 60.0, needs_nothing},
    Unit{Quantity::feed, "m/min", 1000.0 / 60.0, needs_nothing},
    Unit{Quantity::feed, "m/s", 1000.0, needs_nothing},
    Unit{Quantity::feed, "in/min", inch_mm / 60.0, needs_nothing},
    Unit{Quantity::feed, "in/s", inch_mm, needs_nothing},
    Unit{Quantity::force, "N", 1.0, needs_nothing},
    Unit{Quantity::force, "kN", 1e3, needs_nothing},
    Unit{Quantity::force, "lbf", pound_force_N, needs_nothing},
    Unit{Quantity::ratio, "1", 1.0, needs_nothing},
    Unit{Quantity::ratio, "%", 1e-2, needs_nothing},
    Unit{Quantity::state, "1", 1.0, needs_nothing},
};

constexpr std::array columns_of_recording{
    RecordingColumn{"time_s", Quantity::time},
    RecordingColumn{"spindle_angle_rad", Quantity::angle},
    RecordingColumn{"spindle_current_A", Quantity::current},
    RecordingColumn{"x_current_A", Quantity::current},
    RecordingColumn{"y_current_A", Quantity::current},
    RecordingColumn{"z_current_A", Quantity::current},
    RecordingColumn{"x_velocity_mm_s", Quantity::velocity},
    RecordingColumn{"y_velocity_mm_s", Quantity::velocity},
    RecordingColumn{"z_velocity_mm_s", Quantity::velocity},
    RecordingColumn{"fx_N", Quantity::force},
    RecordingColumn{"fy_N", Quantity::force},
    RecordingColumn{"fz_N", Quantity::force},
    RecordingColumn{"override", Quantity::ratio},
    RecordingColumn{"programmed_feed_mm_s", Quantity::feed},
    RecordingColumn{"rapid", Quantity::state},
    RecordingColumn{"commanded_speed_rad_s", Quantity::speed},
};

}  // namespace

double Unit::to_ours(const UnitSettings& settings) const {
    double result = factor;
    result *= needs_setting(UnitNeed::rated_A) ? settings.rated_A : 1.0;
    result *= needs_setting(UnitNeed::screw_pitch_mm) ? settings.screw_pitch_mm : 1.0;
    result /= needs_setting(UnitNeed::counts_per_rev) ? settings.counts_per_rev : 1.0;
    result /= needs_setting(UnitNeed::rate_hz) ? settings.rate_hz : 1.0;
    return result;
}

std::vector<std::string> unit_names(Quantity quantity) {
    std::vector<std::string> names;
    for (const Unit& unit : known_units) {
        if (unit.quantity == quantity) {
            names.emplace_back(unit.name);
        }
    }
    return names;
}

const Unit& unit_of(Quantity quantity, std::size_t index) {
    for (const Unit& unit : known_units) {
        if (unit.quantity == quantity && index-- == 0) {
            return unit;
        }
    }
    throw std::logic_error("unit_of: no such unit");
}

std::span<const RecordingColumn> recording_columns() {
    return columns_of_recording;
}

}  // namespace millforce::host
