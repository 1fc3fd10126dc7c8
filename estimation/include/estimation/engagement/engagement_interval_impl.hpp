// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of engagement_solver.hpp: how far J lets the engagement move, and what that leaves open of the depth.

#include "estimation/engagement/engagement_solver.hpp"
#include "estimation/engagement/immersion_profile_impl.hpp"
#include "estimation/engagement/side_choice.hpp"

#include <cmath>

namespace millforce::estimation {

namespace detail {

/// A node that the scan had no reason to look at: no interval reaches so high.
template <typename Scalar>
inline constexpr Scalar J_not_known = literal<Scalar>(1e9L);

}  // namespace detail

template <typename Scalar, int Nodes>
bool EngagementSolver<Scalar, Nodes>::Search::is_inside(std::size_t node) const {
    return J_[node] <= best_.misfit + rise_of_interval(best_.misfit);
}

/// The outermost node below the estimate that lies within the interval, or the nearest one.
template <typename Scalar, int Nodes>
std::size_t EngagementSolver<Scalar, Nodes>::low_end(Search& s) const {
    const Table& forces = table(s.side_);
    // The estimate is less than two nodes from the best one.
    std::size_t below = s.best_node_ + 1 < nodes ? s.best_node_ + 1 : nodes - 1;
    while (below > 0 && !(forces.angle_rad(Scalar(static_cast<int>(below))) < s.centre_rad_)) {
        --below;
    }
    std::size_t low = 0;
    while (low < below && !s.is_inside(low)) {
        ++low;
    }
    return low > 0 ? last_inside(s, low, low - 1) : low;
}
/// The outermost node above the estimate that lies within the interval, or the nearest one.
template <typename Scalar, int Nodes>
std::size_t EngagementSolver<Scalar, Nodes>::high_end(Search& s) const {
    const Table& forces = table(s.side_);
    std::size_t above = s.best_node_ > 0 ? s.best_node_ - 1 : 0;
    while (above < nodes - 1 && !(forces.angle_rad(Scalar(static_cast<int>(above))) > s.centre_rad_)) {
        ++above;
    }
    std::size_t high = nodes - 1;
    while (high > above && !s.is_inside(high)) {
        --high;
    }
    return high + 1 < nodes ? last_inside(s, high, high + 1) : high;
}

/// Returns the next node outwards if the scan skipped it and it lies inside the interval, else this node.
template <typename Scalar, int Nodes>
std::size_t EngagementSolver<Scalar, Nodes>::last_inside(Search& s, std::size_t node, std::size_t next) const {
    if (!s.is_inside(node) || s.J_[next] != detail::J_not_known<Scalar>) {
        return node;
    }
    look_at_node(s, next);
    return s.is_inside(next) ? next : node;
}

/// Standard deviation from a 95 % interval that may be asymmetric: from its longer side. At R_r = 2 there is only one
/// side.
template <typename Scalar>
Scalar sd_of_interval(Scalar low, Scalar value, Scalar high) {
    const Scalar below = value - low;
    const Scalar above = high - value;
    return (below > above ? below : above) / deviations_of_95_percent<Scalar>;
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::find_interval(Search& s) const {
    using elementary::cos;
    using std::sqrt;
    const Table& forces = table(s.side_);
    const auto& J = s.J_;
    const std::size_t low = low_end(s);
    const std::size_t high = high_end(s);
    const Scalar threshold = s.best_.misfit + rise_of_interval(s.best_.misfit);
    const auto crossing_rad = [&](std::size_t inside, std::size_t outside) {
        const Scalar rise = J[outside] - J[inside];
        const Scalar share = rise > Scalar(0) ? clamp((threshold - J[inside]) / rise, Scalar(0), Scalar(1)) : Scalar(0);
        const Scalar inside_rad = forces.angle_rad(Scalar(static_cast<int>(inside)));
        return inside_rad + (forces.angle_rad(Scalar(static_cast<int>(outside))) - inside_rad) * share;
    };
    const Scalar half_by_curvature = s.curvature_ > Scalar(0)
                                         ? sqrt(Scalar(2) * rise_of_interval(s.best_.misfit) / s.curvature_)
                                         : forces.step_rad();
    Scalar theta_low = s.centre_rad_ - half_by_curvature;
    Scalar theta_high = s.centre_rad_ + half_by_curvature;
    if (s.is_inside(low)) {
        const Scalar scanned = low > 0 ? crossing_rad(low, low - 1) : Table::first_rad;
        theta_low = scanned < theta_low ? scanned : theta_low;
    }
    if (s.is_inside(high)) {
        const Scalar scanned = high + 1 < nodes ? crossing_rad(high, high + 1) : forces.last_rad();
        theta_high = scanned > theta_high ? scanned : theta_high;
    }
    EngagementEstimate<Scalar>& e = s.estimate_;
    e.engagement_rad = s.centre_rad_;
    e.engagement_low_rad = theta_low < Scalar(0) ? Scalar(0) : theta_low;
    e.engagement_high_rad = theta_high > pi<Scalar> ? pi<Scalar> : theta_high;
    e.radial_immersion = Scalar(1) - cos(e.engagement_rad);
    e.radial_immersion_low = Scalar(1) - cos(e.engagement_low_rad);
    e.radial_immersion_high = Scalar(1) - cos(e.engagement_high_rad);
    const Scalar width = e.radial_immersion_high - e.radial_immersion_low;
    e.radial_immersion_sd = sd_of_interval(e.radial_immersion_low, e.radial_immersion, e.radial_immersion_high);
    e.misfit = s.best_.misfit;
    e.solved = true;
    e.immersion_valid = width <= settings_.widest_interval;
}

/// Depth at the estimate and at the interval's ends; its deviation adds the uncertainty of immersion and K_s. All of
/// F_at is taken to scale with K_s, the edge force too: it grows with the hardness of the steel.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::find_depth(Search& s) const {
    using std::sqrt;
    EngagementEstimate<Scalar>& e = s.estimate_;
    const typename Profile::Value& best = s.best_;
    if (!(best.information > Scalar(0)) || !(best.depth_mm > Scalar(0))) {
        return;
    }
    e.depth_at_low_mm = s.profile_.at(table(s.side_), e.engagement_low_rad).depth_mm;
    e.depth_at_high_mm = s.profile_.at(table(s.side_), e.engagement_high_rad).depth_mm;
    const Scalar spread_mm = sd_of_interval(e.depth_at_high_mm, best.depth_mm, e.depth_at_low_mm);
    const Scalar by_K_s = square(best.depth_mm) * s.profile_.doubt_of_K_s().variance_at(best.ln_t_in_references);
    const Scalar flute_mm = settings_.flute_length_mm;
    e.axial_depth_mm = flute_mm > Scalar(0) && best.depth_mm > flute_mm ? flute_mm : best.depth_mm;
    const Scalar by_forces = square(spread_mm) + variance_per_stated(best.misfit) / best.information;
    e.axial_depth_force_sd_mm = sqrt(by_forces);
    e.axial_depth_sd_mm = sqrt(by_forces + by_K_s);
    e.depth_valid = e.immersion_valid && e.axial_depth_sd_mm < e.axial_depth_mm;
}

}  // namespace millforce::estimation
