// SPDX-License-Identifier: Apache-2.0
#include "cutting/revolution_load.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cutting/angle_units.hpp"
#include "cutting/checked_value.hpp"

namespace millforce::sim {
namespace {

/// An angle at which material begins or ends, and the height of the material there.
struct MaterialEdge {
    double angle_rad;
    double top_mm;
};

std::vector<MaterialEdge> material_edges(const EngagementMap& map) {
    constexpr std::size_t count = EngagementMap::bin_count;
    std::vector<MaterialEdge> edges;
    for (std::size_t k = 0; k < count; ++k) {
        const EngagementMap::Bin& bin = map.bins[k];
        if (!holds_material(bin)) {
            continue;
        }
        const CoveredPart part = covered_part(map, k);
        const double start_rad = static_cast<double>(k) * EngagementMap::bin_rad;
        const double top_mm = static_cast<double>(bin.top_mm);
        if (!holds_material(map.bins[(k + count - 1) % count]) || part.low > 0.0) {
            edges.push_back({start_rad + part.low * EngagementMap::bin_rad, top_mm});
        }
        if (!holds_material(map.bins[(k + 1) % count]) || part.high < 1.0) {
            edges.push_back({start_rad + part.high * EngagementMap::bin_rad, top_mm});
        }
    }
    return edges;
}

/// Spindle angles in [0, range) at which a tooth's lower or upper end crosses an edge of the material; 0 and range too.
std::vector<double> crossings(const Cutter& cutter, const std::vector<MaterialEdge>& edges, double range_rad) {
    std::vector<double> angles{0.0, range_rad};
    const auto add = [&](double angle_rad) {
        const double rest = std::fmod(angle_rad, turn);
        const double wrapped = rest < 0.0 ? rest + turn : rest;
        if (wrapped < range_rad) {
            angles.push_back(wrapped);
        }
    };
    for (const MaterialEdge& edge : edges) {
        const double top_mm = std::clamp(edge.top_mm, 0.0, cutter.flute_length_mm);
        for (std::size_t k = 0; k < cutter.teeth; ++k) {
            add(edge.angle_rad + tooth_position_rad(cutter, k));
            add(edge.angle_rad + tooth_position_rad(cutter, k) + helix_lag_rad(cutter, top_mm));
        }
    }
    std::sort(angles.begin(), angles.end());
    return angles;
}

void take_peaks(const CuttingLoad& load, RevolutionLoad& result) {
    result.peak_total_N = std::max(result.peak_total_N, std::hypot(load.fx_N, load.fy_N));
    result.peak_torque_Nm = std::max(result.peak_torque_Nm, load.spindle_torque_Nm);
    for (std::size_t k = 0; k < load.tooth_force_N.size(); ++k) {
        result.tooth_peak_N[k] = std::max(result.tooth_peak_N[k], load.tooth_force_N[k]);
        result.peak_tooth_N = std::max(result.peak_tooth_N, load.tooth_force_N[k]);
    }
}

void add_mean(const CuttingLoad& load, double share, RevolutionLoad& result) {
    result.mean_fx_N += share * load.fx_N;
    result.mean_fy_N += share * load.fy_N;
    result.mean_fz_N += share * load.fz_N;
    result.mean_torque_Nm += share * load.spindle_torque_Nm;
}

}  // namespace

RevolutionLoad revolution_load(const CuttingForce& force, double feed_per_tooth_mm, const EngagementMap& map,
                               double step_rad) {
    check_range("step_rad", step_rad, 1e-4, 0.1);
    const Cutter& cutter = force.cutter();
    const bool equal_teeth = has_equal_pitch(cutter) && cutter.runout_mm == 0.0;
    const double range_rad = equal_teeth ? turn / static_cast<double>(cutter.teeth) : turn;
    const std::vector<double> parts = crossings(cutter, material_edges(map), range_rad);
    const EngagementBounds bounds = bounds_of(map);
    const auto load_at = [&](double angle_rad) { return force.load(angle_rad, feed_per_tooth_mm, map, bounds); };
    constexpr double inside_rad = 1e-8;  // distance from a crossing, on either side of a jump
    RevolutionLoad result;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        const double length_rad = parts[i + 1] - parts[i];
        if (length_rad < 4.0 * inside_rad) {
            continue;
        }
        take_peaks(load_at(parts[i] + inside_rad), result);
        take_peaks(load_at(parts[i + 1] - inside_rad), result);
        const int steps = std::max(4, static_cast<int>(std::ceil(length_rad / step_rad)));
        const double width_rad = length_rad / steps;
        for (int step = 0; step < steps; ++step) {
            const CuttingLoad load = load_at(parts[i] + (step + 0.5) * width_rad);
            take_peaks(load, result);
            add_mean(load, width_rad / range_rad, result);
        }
    }
    if (equal_teeth) {
        std::fill_n(result.tooth_peak_N.begin(), cutter.teeth, result.peak_tooth_N);
    }
    return result;
}

}  // namespace millforce::sim
