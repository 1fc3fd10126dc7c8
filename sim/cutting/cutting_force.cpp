// SPDX-License-Identifier: Apache-2.0
#include "cutting/cutting_force.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "cutting/angle_units.hpp"
#include "cutting/checked_value.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {
namespace {

std::size_t previous_bin(std::size_t index) {
    return index == 0 ? EngagementMap::bin_count - 1 : index - 1;
}

/// The same bits: two integer comparisons in the loop that walks along the edge, where three of floats would cost more.
bool equal(const EngagementMap::Bin& a, const EngagementMap::Bin& b) {
    struct Bits {
        std::array<std::uint32_t, 3> word;
    };
    const auto left = std::bit_cast<Bits>(a);
    const auto right = std::bit_cast<Bits>(b);
    return ((left.word[0] ^ right.word[0]) | (left.word[1] ^ right.word[1]) | (left.word[2] ^ right.word[2])) == 0;
}

double wrapped_turn(double angle_rad) {
    const double rest = std::fmod(angle_rad, turn);
    return rest < 0.0 ? rest + turn : rest;
}

/// Adds a small angle (at most half a slice's lag) to the angle whose sine and cosine are given.
void turn_by(double delta, double& sine, double& cosine) {
    const double sin_delta = delta * (1.0 - delta * delta / 6.0);
    const double cos_delta = 1.0 - 0.5 * delta * delta * (1.0 - delta * delta / 12.0);
    const double turned = sine * cos_delta + cosine * sin_delta;
    cosine = cosine * cos_delta - sine * sin_delta;
    sine = turned;
}

void require_finite(const char* name, double value) {
    if (!std::isfinite(value)) {
        throw host::InputError(fmt::format("{}: {}, expected a finite number", name, value));
    }
}

}  // namespace

CuttingForce::CuttingForce(const Cutter& cutter, const CuttingCoefficients& coefficients,
                           const CuttingForceOptions& options)
    : cutter_(cutter), options_(options) {
    validate(cutter_);
    set_coefficients(coefficients);
    if (options_.bottom_edge) {
        validate(*options_.bottom_edge, 0.5 * cutter_.diameter_mm);
    }
    const EdgeResolution& resolution = options_.resolution;
    check_range("resolution.axial_slices", static_cast<double>(resolution.axial_slices), 1.0, 500.0);
    check_range("resolution.largest_angle_per_slice_rad", resolution.largest_angle_per_slice_rad, 1e-3, 0.2);
    check_range("resolution.largest_turn_rad", resolution.largest_turn_rad, 1e-3, 0.2);
    lag_rad_per_mm_ = helix_lag_rad(cutter_, 1.0);
    mm_per_bin_ = lag_rad_per_mm_ > 0.0 ? EngagementMap::bin_rad / lag_rad_per_mm_ : 0.0;
    has_runout_ = cutter_.runout_mm > 0.0;
    build_slices();
    build_teeth();
}

void CuttingForce::set_coefficients(const CuttingCoefficients& coefficients) {
    validate(coefficients);
    coefficients_ = coefficients;
    const SizeEffect& size = coefficients_.size_effect;
    has_size_effect_ = size.tangential_exponent != 0.0 || size.radial_exponent != 0.0 || size.axial_exponent != 0.0;
}

void CuttingForce::build_slices() {
    const double length_mm = cutter_.flute_length_mm;
    const double radius_mm = 0.5 * cutter_.diameter_mm;
    const bool ball = cutter_.type == CutterType::ball_end_mill;
    // A ball's slices divide its arc evenly, so that shallow cuts near the tip still meet several of them.
    const double sphere_mm = ball ? std::min(radius_mm, length_mm) : 0.0;
    const double arc_rad = ball ? std::acos(1.0 - sphere_mm / radius_mm) : 0.0;
    const double profile_mm = radius_mm * arc_rad + (length_mm - sphere_mm);
    const double step_mm = profile_mm / static_cast<double>(options_.resolution.axial_slices);
    const auto divide = [&](double part_mm, double angle_rad) {
        const double by_angle = std::ceil(angle_rad / options_.resolution.largest_angle_per_slice_rad - 1e-9);
        return static_cast<std::size_t>(std::max(std::ceil(part_mm / step_mm - 1e-9), by_angle));
    };
    const double lag_over_arc = lag_rad_per_mm_ * radius_mm;  // at the equator, where it is largest
    const std::size_t on_sphere = divide(radius_mm * arc_rad, arc_rad * std::max(1.0, lag_over_arc));
    const std::size_t above = divide(length_mm - sphere_mm, lag_rad_per_mm_ * (length_mm - sphere_mm));
    if (on_sphere + above > most_slices) {
        throw host::InputError(fmt::format("resolution: {} slices over the flute length, expected at most {}",
                                           on_sphere + above, most_slices));
    }
    slices_.reserve(on_sphere + above);
    for (std::size_t j = 0; j < on_sphere; ++j) {
        const double step_rad = arc_rad / static_cast<double>(on_sphere);
        const double low_rad = static_cast<double>(j) * step_rad;
        slices_.push_back(
            slice_between(radius_mm * (1.0 - std::cos(low_rad)), radius_mm * (1.0 - std::cos(low_rad + step_rad))));
    }
    for (std::size_t j = 0; j < above; ++j) {
        const double height_mm = (length_mm - sphere_mm) / static_cast<double>(above);
        const double low_mm = sphere_mm + static_cast<double>(j) * height_mm;
        slices_.push_back(slice_between(low_mm, low_mm + height_mm));
    }
}

CuttingForce::Slice CuttingForce::slice_between(double bottom_mm, double top_mm) const {
    Slice slice{};
    slice.bottom_mm = bottom_mm;
    slice.top_mm = top_mm;
    slice.middle_mm = 0.5 * (bottom_mm + top_mm);
    slice.sin_lag = std::sin(helix_lag_rad(cutter_, slice.middle_mm));
    slice.cos_lag = std::cos(helix_lag_rad(cutter_, slice.middle_mm));
    slice.radius_mm = local_radius_mm(cutter_, slice.middle_mm);
    const double kappa_rad = local_lead_angle_rad(cutter_, slice.middle_mm);
    const bool shoulder = kappa_rad >= 0.5 * std::numbers::pi;
    slice.sin_kappa = shoulder ? 1.0 : std::sin(kappa_rad);
    slice.cos_kappa = shoulder ? 0.0 : std::cos(kappa_rad);
    slice.edge_per_height = 1.0 / slice.sin_kappa;
    if (cutter_.type == CutterType::ball_end_mill && !shoulder) {
        const double arc_rad = local_lead_angle_rad(cutter_, top_mm) - local_lead_angle_rad(cutter_, bottom_mm);
        slice.edge_per_height = 0.5 * cutter_.diameter_mm * arc_rad / (top_mm - bottom_mm);
    }
    return slice;
}

void CuttingForce::build_teeth() {
    for (std::size_t k = 0; k < cutter_.teeth; ++k) {
        position_rad_[k] = tooth_position_rad(cutter_, k);
    }
    for (std::size_t k = 0; k < cutter_.teeth; ++k) {
        for (std::size_t m = 1; m <= cutter_.teeth; ++m) {
            const std::size_t ahead = (k + cutter_.teeth - m) % cutter_.teeth;
            const double gap_rad = position_rad_[k] - position_rad_[ahead];
            tooth_ahead_[k][m - 1] = ahead;
            gap_rad_[k][m - 1] = gap_rad > 0.0 ? gap_rad : gap_rad + turn;
        }
    }
    runout_mm_.assign(slices_.size() * Cutter::max_teeth, 0.0);
    for (std::size_t j = 0; has_runout_ && j < slices_.size(); ++j) {
        for (std::size_t k = 0; k < cutter_.teeth; ++k) {
            runout_mm_[j * Cutter::max_teeth + k] = runout_offset_mm(cutter_, k, slices_[j].middle_mm);
        }
    }
}

/// Follows the edge from the tip upwards, which is backwards through the bins. Runs of equal full bins are one part.
void CuttingForce::find_parts_in_cut(double tip_bins, const EngagementMap& map, const EngagementBounds& bounds,
                                     InCut& in_cut) const {
    in_cut.first = 0;
    in_cut.end = 0;
    const double reach_mm = std::min(cutter_.flute_length_mm, bounds.top_mm);
    // A tip angle a rounding below 2π may come out as bin_count.
    std::size_t k = std::min(static_cast<std::size_t>(tip_bins), EngagementMap::bin_count - 1);
    const double in_bin = tip_bins - static_cast<double>(k);
    const bool straight = mm_per_bin_ == 0.0;
    double low_mm = 0.0;
    double high_mm = straight ? reach_mm : in_bin * mm_per_bin_;  // where the edge passes from bin k to bin k − 1
    const std::size_t bins_to_material = bounds.bins_back_from(k);
    if (bins_to_material > 0) {
        low_mm = high_mm + static_cast<double>(bins_to_material - 1) * mm_per_bin_;
        high_mm = low_mm + mm_per_bin_;
        k = bounds.end - 1;
    }
    while (low_mm < reach_mm) {
        const EngagementMap::Bin& bin = map.bins[k];
        const bool full = bin.covered >= 1.0F;
        const bool material = holds_material(bin);
        while (full && material && high_mm < reach_mm && equal(map.bins[previous_bin(k)], bin)) {
            k = previous_bin(k);
            high_mm += mm_per_bin_;
        }
        while (!material && high_mm < reach_mm && !holds_material(map.bins[previous_bin(k)])) {
            k = previous_bin(k);
            high_mm += mm_per_bin_;
        }
        if (material) {
            const double bottom_mm = std::max(low_mm, static_cast<double>(bin.bottom_mm));
            const double top_mm = std::min({high_mm, reach_mm, static_cast<double>(bin.top_mm)});
            const CoveredPart part = full ? CoveredPart{} : covered_part(map, k);
            if (full) {
                add_part(bottom_mm, top_mm, 1.0, in_cut);
            } else if (!straight) {
                add_part(std::max(bottom_mm, high_mm - part.high * mm_per_bin_),
                         std::min(top_mm, high_mm - part.low * mm_per_bin_), part.weight, in_cut);
            } else if (in_bin >= part.low && in_bin < part.high) {
                add_part(bottom_mm, top_mm, part.weight, in_cut);
            }
        }
        low_mm = high_mm;
        high_mm += mm_per_bin_;
        k = previous_bin(k);
    }
}

/// Parts come in rising order, so that the search for the slice goes on where the last part ended.
void CuttingForce::add_part(double low_mm, double high_mm, double weight, InCut& in_cut) const {
    if (!(high_mm > low_mm)) {
        return;
    }
    std::size_t j = in_cut.end > 0 ? in_cut.end - 1 : 0;
    while (j < slices_.size() && slices_[j].top_mm <= low_mm) {
        ++j;
    }
    if (in_cut.end == 0) {
        in_cut.first = j;
        in_cut.end = j;
    }
    for (; j < slices_.size() && slices_[j].bottom_mm < high_mm; ++j) {
        for (; in_cut.end <= j; ++in_cut.end) {
            in_cut.width_mm[in_cut.end] = 0.0;
            in_cut.moment_mm2[in_cut.end] = 0.0;
        }
        const double from_mm = std::max(low_mm, slices_[j].bottom_mm);
        const double to_mm = std::min(high_mm, slices_[j].top_mm);
        const double width_mm = (to_mm - from_mm) * weight;
        in_cut.width_mm[j] += width_mm;
        in_cut.moment_mm2[j] += width_mm * (0.5 * (from_mm + to_mm) - slices_[j].middle_mm);
    }
}

double CuttingForce::chip_in_plane_mm(std::size_t tooth, std::size_t slice, double sin_phi, double cos_phi,
                                      double feed_per_radian_mm) const {
    const double nominal_mm = slices_[slice].radius_mm;
    const double radius_mm = nominal_mm + runout_mm(tooth, slice);
    const auto pass_of = [&](std::size_t m) {
        const std::size_t ahead = tooth_ahead_[tooth][m - 1];
        const double gap_rad = gap_rad_[tooth][m - 1];
        return EdgePass{.radius_mm = radius_mm,
                        .earlier_radius_mm = nominal_mm + runout_mm(ahead, slice),
                        .advance_per_radian_mm = feed_per_radian_mm,
                        .gap_rad = gap_rad};
    };
    double chip_mm = chip_thickness_mm(options_.chip_model, pass_of(1), sin_phi, cos_phi);
    // Equal radii: every tooth cuts less behind the last one than behind those before it.
    for (std::size_t m = 2; has_runout_ && m <= cutter_.teeth && chip_mm > 0.0; ++m) {
        const EdgePass pass = pass_of(m);
        // The circle is a lower bound of the offset circle, and of the trochoid but for ρ v sin φ with v ≈ f/r'.
        const double slack_mm = 2.0 * feed_per_radian_mm * pass.advance_mm() / nominal_mm;
        if (circular_chip_mm(pass, sin_phi) - slack_mm < chip_mm) {
            chip_mm = std::min(chip_mm, chip_thickness_mm(options_.chip_model, pass, sin_phi, cos_phi));
        }
    }
    return chip_mm;
}

CuttingForce::ElementForce CuttingForce::element_force(double chip_mm, double section_mm2, double edge_mm) const {
    const CuttingCoefficients& K = coefficients_;
    double tangential = 1.0;
    double radial = 1.0;
    double axial = 1.0;
    if (has_size_effect_) {
        const SizeEffect& size = K.size_effect;
        const double logarithm = std::log(std::max(chip_mm, size.floor_mm) / size.reference_mm);
        tangential = std::exp(size.tangential_exponent * logarithm);
        radial =
            size.radial_exponent == size.tangential_exponent ? tangential : std::exp(size.radial_exponent * logarithm);
        axial =
            size.axial_exponent == size.tangential_exponent ? tangential : std::exp(size.axial_exponent * logarithm);
    }
    return {.tangential_N = K.K_tc_N_mm2 * tangential * section_mm2 + K.K_te_N_mm * edge_mm,
            .radial_N = K.K_rc_N_mm2 * radial * section_mm2 + K.K_re_N_mm * edge_mm,
            .axial_N = K.K_ac_N_mm2 * axial * section_mm2 + K.K_ae_N_mm * edge_mm};
}

CuttingForce::ToothLoad CuttingForce::flank_load(std::size_t tooth, const ToothAngle& tip, double feed_per_radian_mm,
                                                 const InCut& in_cut) const {
    ToothLoad total;
    for (std::size_t j = in_cut.first; j < in_cut.end; ++j) {
        const Slice& slice = slices_[j];
        const double width_mm = in_cut.width_mm[j];
        if (width_mm <= 0.0) {
            continue;
        }
        double sin_phi = tip.sine * slice.cos_lag - tip.cosine * slice.sin_lag;
        double cos_phi = tip.cosine * slice.cos_lag + tip.sine * slice.sin_lag;
        if (in_cut.moment_mm2[j] != 0.0) {
            turn_by(-in_cut.moment_mm2[j] / width_mm * lag_rad_per_mm_, sin_phi, cos_phi);
        }
        const double in_plane_mm = chip_in_plane_mm(tooth, j, sin_phi, cos_phi, feed_per_radian_mm);
        if (in_plane_mm <= 0.0) {
            continue;
        }
        const ElementForce force =
            element_force(in_plane_mm * slice.sin_kappa, in_plane_mm * width_mm, width_mm * slice.edge_per_height);
        const double outward_N = force.radial_N * slice.sin_kappa + force.axial_N * slice.cos_kappa;
        total.fx_N += force.tangential_N * cos_phi + outward_N * sin_phi;
        total.fy_N += -force.tangential_N * sin_phi + outward_N * cos_phi;
        total.fz_N += force.axial_N * slice.sin_kappa - force.radial_N * slice.cos_kappa;
        total.torque_Nmm += force.tangential_N * (slice.radius_mm + runout_mm(tooth, j));
    }
    return total;
}

void CuttingForce::add_bottom_edge(std::size_t tooth, const ToothAngle& tip, double feed_per_radian_mm,
                                   const EngagementMap& map, ToothLoad& total) const {
    const std::size_t index = std::min(static_cast<std::size_t>(tip.bins), EngagementMap::bin_count - 1);
    const EngagementMap::Bin& bin = map.bins[index];
    if (!holds_material(bin) || bin.bottom_mm > 0.0F) {
        return;
    }
    const CoveredPart part = covered_part(map, index);
    const double in_bin = tip.bins - static_cast<double>(index);
    if (in_bin < part.low || in_bin >= part.high) {
        return;
    }
    const double chip_mm = chip_in_plane_mm(tooth, 0, tip.sine, tip.cosine, feed_per_radian_mm);
    if (chip_mm <= 0.0) {
        return;
    }
    const BottomEdge& edge = *options_.bottom_edge;
    const double section_mm2 = chip_mm * edge.width_mm * part.weight;
    const BottomEdgeForce force = orthogonal_components(edge, orthogonal_resultant_N(edge, section_mm2));
    total.fx_N += force.cutting_N * tip.cosine;
    total.fy_N -= force.cutting_N * tip.sine;
    total.fz_N -= force.thrust_N;
    total.torque_Nmm += force.cutting_N * (0.5 * cutter_.diameter_mm - 0.5 * edge.width_mm);
}

CuttingLoad CuttingForce::load(double spindle_angle_rad, double feed_per_tooth_mm, const EngagementMap& map) const {
    return load(spindle_angle_rad, feed_per_tooth_mm, map, bounds_of(map));
}

CuttingLoad CuttingForce::load(double spindle_angle_rad, double feed_per_tooth_mm, const EngagementMap& map,
                               const EngagementBounds& bounds) const {
    require_finite("spindle_angle_rad", spindle_angle_rad);
    require_finite("feed_per_tooth_mm", feed_per_tooth_mm);
    CuttingLoad load;
    if (feed_per_tooth_mm <= 0.0 || bounds.end == 0) {
        return load;
    }
    const double feed_per_radian_mm = feed_per_tooth_mm * static_cast<double>(cutter_.teeth) / turn;
    InCut in_cut;
    const double spindle_rad = wrapped_turn(spindle_angle_rad);
    for (std::size_t k = 0; k < cutter_.teeth; ++k) {
        const double behind_rad = spindle_rad - position_rad_[k];
        const double phi = behind_rad < 0.0 ? behind_rad + turn : behind_rad;
        const ToothAngle tip{.bins = phi / EngagementMap::bin_rad, .sine = std::sin(phi), .cosine = std::cos(phi)};
        find_parts_in_cut(tip.bins, map, bounds, in_cut);
        ToothLoad tooth = flank_load(k, tip, feed_per_radian_mm, in_cut);
        if (options_.bottom_edge) {
            add_bottom_edge(k, tip, feed_per_radian_mm, map, tooth);
        }
        load.fx_N += tooth.fx_N;
        load.fy_N += tooth.fy_N;
        load.fz_N += tooth.fz_N;
        load.spindle_torque_Nm += 1e-3 * tooth.torque_Nmm;
        load.tooth_force_N[k] = std::sqrt(tooth.fx_N * tooth.fx_N + tooth.fy_N * tooth.fy_N);
    }
    return load;
}

}  // namespace millforce::sim
