// SPDX-License-Identifier: Apache-2.0
#include "cutting/cutter.hpp"

#include <cmath>

#include "cutting/angle_units.hpp"
#include "cutting/checked_value.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {
namespace {

void validate_pitch(const Cutter& cutter) {
    if (has_equal_pitch(cutter)) {
        return;
    }
    double sum_rad = 0.0;
    for (std::size_t k = 0; k < cutter.teeth; ++k) {
        check_range("cutter.tooth_pitch_rad", cutter.tooth_pitch_rad[k], 0.01, turn);
        sum_rad += cutter.tooth_pitch_rad[k];
    }
    constexpr double tolerance_rad = 1e-6;
    if (std::abs(sum_rad - turn) > tolerance_rad) {
        throw host::InputError(fmt::format("cutter.tooth_pitch_rad: the sum is {}, expected 2 pi", sum_rad));
    }
}

}  // namespace

void validate(const Cutter& cutter) {
    if (cutter.teeth < 1 || cutter.teeth > Cutter::max_teeth) {
        throw host::InputError(fmt::format("cutter.teeth: {}, expected 1 to {}", cutter.teeth, Cutter::max_teeth));
    }
    check_range("cutter.diameter_mm", cutter.diameter_mm, 0.1, 1000.0);
    check_range("cutter.flute_length_mm", cutter.flute_length_mm, 0.01, 500.0);
    check_range("cutter.helix_rad", cutter.helix_rad, 0.0, 70.0 * degree);
    check_range("cutter.rake_rad", cutter.rake_rad, -60.0 * degree, 60.0 * degree);
    const double lowest_lead_rad = cutter.type == CutterType::face_mill ? 10.0 * degree : 90.0 * degree;
    constexpr double rounding = 1e-9;
    check_range("cutter.lead_angle_rad", cutter.lead_angle_rad, lowest_lead_rad - rounding, 90.0 * degree + rounding);
    check_range("cutter.runout_mm", cutter.runout_mm, 0.0, 0.25 * cutter.diameter_mm);
    check_range("cutter.runout_angle_rad", cutter.runout_angle_rad, -turn, turn);
    validate_pitch(cutter);
}

bool has_equal_pitch(const Cutter& cutter) {
    for (const double pitch_rad : cutter.tooth_pitch_rad) {
        if (pitch_rad != 0.0) {
            return false;
        }
    }
    return true;
}

double tooth_position_rad(const Cutter& cutter, std::size_t tooth) {
    if (has_equal_pitch(cutter)) {
        return turn * static_cast<double>(tooth) / static_cast<double>(cutter.teeth);
    }
    double position_rad = 0.0;
    for (std::size_t k = 0; k < tooth; ++k) {
        position_rad += cutter.tooth_pitch_rad[k];
    }
    return position_rad;
}

double helix_lag_rad(const Cutter& cutter, double height_mm) {
    return height_mm * std::tan(cutter.helix_rad) / (0.5 * cutter.diameter_mm);
}

double local_radius_mm(const Cutter& cutter, double height_mm) {
    const double radius_mm = 0.5 * cutter.diameter_mm;
    switch (cutter.type) {
        case CutterType::face_mill:
            return radius_mm + height_mm * std::cos(cutter.lead_angle_rad) / std::sin(cutter.lead_angle_rad);
        case CutterType::ball_end_mill:
            return height_mm < radius_mm ? std::sqrt(height_mm * (2.0 * radius_mm - height_mm)) : radius_mm;
        case CutterType::end_mill:
            break;
    }
    return radius_mm;
}

double local_lead_angle_rad(const Cutter& cutter, double height_mm) {
    const double radius_mm = 0.5 * cutter.diameter_mm;
    if (cutter.type == CutterType::ball_end_mill && height_mm < radius_mm) {
        return std::acos(1.0 - height_mm / radius_mm);
    }
    return cutter.lead_angle_rad;
}

double runout_offset_mm(const Cutter& cutter, std::size_t tooth, double height_mm) {
    return cutter.runout_mm *
           std::cos(cutter.runout_angle_rad - tooth_position_rad(cutter, tooth) - helix_lag_rad(cutter, height_mm));
}

}  // namespace millforce::sim
