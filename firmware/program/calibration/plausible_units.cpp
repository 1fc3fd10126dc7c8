// SPDX-License-Identifier: Apache-2.0
#include "calibration/plausible_units.hpp"

#include "estimation/number/circle.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millforce::host {

double largest_feed_per_tooth_mm(double tool_diameter_mm) {
    constexpr double largest_mm = 1.5;
    constexpr double largest_per_diameter = 0.06;
    return std::min(largest_mm, largest_per_diameter * tool_diameter_mm);
}

void refuse_implausible_cut(const std::string& place, const CutKinematics& cut, std::string_view feed_column,
                            std::string_view speed_column) {
    constexpr double largest_cutting_speed_m_s = 120.0;
    constexpr double rpm = 30.0 / std::numbers::pi;  // in 1 rad/s
    const double limit_mm = largest_feed_per_tooth_mm(cut.tool_diameter_mm);
    if (cut.feed_per_tooth_mm > limit_mm) {
        throw InputError(
            fmt::format("{}: column '{}': {:.4g} mm/s is a chip of {:.3g} mm on a tool of Ø{:g} mm; expected at "
                        "most {:.3g} mm; is it in mm/min?",
                        place, feed_column, cut.feed_mm_s, cut.feed_per_tooth_mm, cut.tool_diameter_mm, limit_mm));
    }
    const double cutting_speed_m_s = 0.5e-3 * cut.tool_diameter_mm * cut.spindle_rad_s;
    if (cutting_speed_m_s > largest_cutting_speed_m_s) {
        throw InputError(fmt::format(
            "{}: column '{}': {:.5g} rad/s is {:.6g} 1/min, {:.3g} m/s on a tool of Ø{:g} mm; expected at most {:g} "
            "m/s; is it in 1/min or in degrees?",
            place, speed_column, cut.spindle_rad_s, cut.spindle_rad_s * rpm, cutting_speed_m_s, cut.tool_diameter_mm,
            largest_cutting_speed_m_s));
    }
}

void refuse_implausible_pressure(const std::string& file, const std::vector<CutRow>& cuts, estimation::CutSide side,
                                 std::string_view hint) {
    std::vector<double> pressures;
    for (const CutRow& row : cuts) {
        const auto measured = row.measurement(side);
        const double area_mm2 = measured.cut.feed_per_tooth_mm * measured.cut.axial_depth_mm * measured.cut.teeth *
                                estimation::engagement_integrals(measured.cut.engagement).c /
                                estimation::turn_rad<double>;
        if (std::isfinite(measured.tangential_N) && area_mm2 > 0.0) {
            pressures.push_back(measured.tangential_N / area_mm2);
        }
    }
    if (pressures.empty()) {
        return;
    }
    const auto middle = pressures.begin() + static_cast<std::ptrdiff_t>(pressures.size() / 2);
    std::nth_element(pressures.begin(), middle, pressures.end());
    if (*middle < 0.0) {
        throw InputError(fmt::format(
            "{}: the torque of the cuts is negative (median K_s {:.4g} N/mm²); expected a positive torque, against the "
            "rotation",
            file, *middle));
    }
    if (*middle < softest_N_per_mm2 || *middle > hardest_N_per_mm2) {
        throw InputError(
            fmt::format("{}: the torques mean a cutting pressure of {:.4g} N/mm² (median of {} cuts); "
                        "expected {:g} to {:g}; {}",
                        file, *middle, pressures.size(), softest_N_per_mm2, hardest_N_per_mm2, hint));
    }
}

void AngleUnit::look_at(const CsvReader& csv, CsvColumn column, double angle) {
    constexpr double end_of_turn_deg = 361.0;
    const bool begins_again =
        last_ > 0.75 * end_of_turn_deg && last_ < end_of_turn_deg && angle > -1.0 && angle < 0.5 * end_of_turn_deg;
    if (begins_again) {
        csv.fail(column, fmt::format("{:.6g} after {:.6g}; expected rad, which begin again at 6.283 or go on; is it in "
                                     "degrees?",
                                     angle, last_));
    }
    last_ = std::isfinite(angle) ? angle : last_;
}

}  // namespace millforce::host
