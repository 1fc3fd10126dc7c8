// SPDX-License-Identifier: Apache-2.0
#include "judging/true_cut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millforce::judging {

namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;
constexpr int slices = 24;

double wrapped(double angle_rad) {
    return angle_rad - full_turn * std::floor(angle_rad / full_turn);
}

double tooth_radius_mm(const TrueCut& cut, int tooth) {
    return cut.radius_mm + cut.eccentricity_mm * std::cos(full_turn * tooth / cut.teeth);
}

bool is_inside_workpiece(const TrueCut& cut, double phi_rad, double ahead_mm) {
    const double arc_rad = std::acos(std::clamp(1.0 - cut.radial_immersion, -1.0, 1.0));
    const bool is_in_arc = cut.is_up ? phi_rad < arc_rad : phi_rad > std::numbers::pi - arc_rad;
    return phi_rad < std::numbers::pi && is_in_arc && cut.radius_mm * std::sin(phi_rad) > ahead_mm;
}

struct InPlane {
    double tangential_N = 0.0;
    double feed_N = 0.0;
    double left_N = 0.0;
};

/// Of a slice of edge with the length `db_mm` along the axis.
InPlane slice_force(const TrueCut& cut, double phi_rad, double radius_step_mm, double db_mm) {
    const double chip_mm = cut.feed_per_tooth_mm * std::sin(phi_rad) + radius_step_mm;
    if (chip_mm <= 0.0) {
        return {};
    }
    const double chip_in_references = chip_mm / cut.law.reference_chip_mm;
    const double K_s = cut.law.K_s_N_per_mm2 * std::pow(chip_in_references, cut.law.K_s_exponent);
    const double r_1 = cut.law.r_1 * std::pow(chip_in_references, cut.law.r_1_exponent);
    const double F_t = (K_s * chip_mm + cut.law.K_te_N_per_mm) * db_mm;
    const double F_r = (r_1 * K_s * chip_mm + cut.law.K_re_N_per_mm) * db_mm;
    const double sine = std::sin(phi_rad);
    const double cosine = std::cos(phi_rad);
    return {F_t, F_t * cosine + F_r * sine, -F_t * sine + F_r * cosine};
}

InPlane tooth_force(const TrueCut& cut, int tooth, double tool_angle_rad, double ahead_mm) {
    const double db_mm = cut.axial_depth_mm / slices;
    const double before = tooth_radius_mm(cut, (tooth + cut.teeth - 1) % cut.teeth);
    const double radius_step_mm = tooth_radius_mm(cut, tooth) - before;
    const double leading_rad = tool_angle_rad - full_turn * tooth / cut.teeth;
    InPlane sum;
    for (int slice = 0; slice < slices; ++slice) {
        const double lag_rad = (slice + 0.5) * db_mm * std::tan(cut.helix_rad) / cut.radius_mm;
        const double phi_rad = wrapped(leading_rad - lag_rad);
        if (is_inside_workpiece(cut, phi_rad, ahead_mm)) {
            const InPlane part = slice_force(cut, phi_rad, radius_step_mm, db_mm);
            sum.tangential_N += part.tangential_N;
            sum.feed_N += part.feed_N;
            sum.left_N += part.left_N;
        }
    }
    return sum;
}

}  // namespace

MomentaryForce momentary_force(const TrueCut& cut, double tool_angle_rad, double ahead_mm) {
    MomentaryForce result;
    for (int tooth = 0; tooth < cut.teeth; ++tooth) {
        const InPlane force = tooth_force(cut, tooth, tool_angle_rad, ahead_mm);
        result.torque_Nm += force.tangential_N * cut.radius_mm / 1000.0;
        result.feed_N += force.feed_N;
        result.left_N += force.left_N;
        result.largest_tooth_N = std::max(result.largest_tooth_N, std::hypot(force.feed_N, force.left_N));
    }
    return result;
}

double peak_tooth_force_N(const TrueCut& cut) {
    constexpr int angles = 360;
    constexpr double all_inside_mm = -1e9;
    double peak_N = 0.0;
    for (int i = 0; i < angles; ++i) {
        peak_N = std::max(peak_N, momentary_force(cut, full_turn * i / angles, all_inside_mm).largest_tooth_N);
    }
    return peak_N;
}

double feed_per_tooth_at_limit_mm(TrueCut cut, double limit_N, double most_mm) {
    double low_mm = 0.0;
    double high_mm = most_mm;
    for (int i = 0; i < 20; ++i) {
        cut.feed_per_tooth_mm = 0.5 * (low_mm + high_mm);
        (peak_tooth_force_N(cut) < limit_N ? low_mm : high_mm) = cut.feed_per_tooth_mm;
    }
    return 0.5 * (low_mm + high_mm);
}

}  // namespace millforce::judging
