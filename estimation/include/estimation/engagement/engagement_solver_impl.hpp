// SPDX-License-Identifier: Apache-2.0
#pragma once

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
EngagementSolver<Scalar, Nodes>::EngagementSolver(const CuttingLaw<Scalar>& law,
                                                  const EngagementSolverSettings<Scalar>& settings, CutSide side)
    : settings_(settings) {
    const bool is_centred = side == CutSide::centred;
    const Scalar offset = is_centred ? settings.centre_offset_in_radii : Scalar(0);
    const CutSide sides[] = {is_centred ? CutSide::centred : CutSide::down,
                             is_centred ? CutSide::centred : CutSide::up};
    for (std::size_t k = 0; k < tables_.size(); ++k) {
        tables_[k].build(law, settings.teeth, sides[k], offset, largest_angle_rad(sides[k]));
    }
    using std::sqrt;
    const Scalar K_s_sd = sqrt(tables_[0].doubt_of_K_s().variance_at(Scalar(0)));
    largest_depth_mm_ = settings.flute_length_mm * (Scalar(1) + Scalar(2) * K_s_sd);
}

template <typename Scalar, int Nodes>
Scalar EngagementSolver<Scalar, Nodes>::largest_angle_rad(CutSide side) const {
    using elementary::acos;
    Scalar limit = settings_.largest_immersion;
    if (side == CutSide::centred) {
        const Scalar offset = settings_.centre_offset_in_radii;
        const Scalar reach = Scalar(2) * (Scalar(1) - (offset < Scalar(0) ? -offset : offset));
        limit = limit < reach ? limit : reach;
    }
    return acos(Scalar(1) - limit);
}

// A solution

template <typename Scalar, int Nodes>
bool EngagementSolver<Scalar, Nodes>::is_solvable(const AverageForceMeasurement<Scalar>& forces,
                                                  Scalar feed_per_tooth_mm) const {
    const Measurement<Scalar>& F_at = forces.tangential_N;
    return F_at.valid && feed_per_tooth_mm > Scalar(0) && F_at.value > Scalar(0) &&
           square(F_at.value) > square(settings_.least_significance) * F_at.variance &&
           (forces.x_N.valid || forces.y_N.valid || forces.radial_immersion.valid);
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::begin(Search& search, const AverageForceMeasurement<Scalar>& forces,
                                            Scalar feed_per_tooth_mm, CutSide side,
                                            const KnownDepth<Scalar>& remembered) const {
    search.asked_ = side;
    search.remembered_ = remembered;
    search.is_with_memory_ = false;
    begin_side(search, first_side(side));
    if (is_solvable(forces, feed_per_tooth_mm)) {
        search.profile_ =
            Profile(tables_[0], forces, feed_per_tooth_mm, settings_.law_relative_sd,
                    {settings_.declared_depth_mm, settings_.declared_depth_relative_sd}, largest_depth_mm_);
    } else {
        search.phase_ = Search::Phase::done;
    }
}

template <typename Scalar, int Nodes>
bool EngagementSolver<Scalar, Nodes>::advance(Search& search, int steps) const {
    for (; steps > 0 && !search.done(); --steps) {
        step(search);
    }
    return search.done();
}

template <typename Scalar, int Nodes>
EngagementEstimate<Scalar> EngagementSolver<Scalar, Nodes>::solve(const AverageForceMeasurement<Scalar>& forces,
                                                                  Scalar feed_per_tooth_mm, CutSide side,
                                                                  const KnownDepth<Scalar>& remembered) const {
    Search search;
    begin(search, forces, feed_per_tooth_mm, side, remembered);
    while (!advance(search, Nodes)) {
    }
    return search.estimate();
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::begin_side(Search& s, CutSide side) const {
    s.side_ = side;
    s.estimate_ = {};
    s.estimate_.side = side;
    s.J_.fill(detail::J_not_known<Scalar>);
    s.node_ = 0;
    s.phase_ = Search::Phase::scan;
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::end_side(Search& s) const {
    if (s.is_with_memory_) {
        end_with_memory(s);
        return;
    }
    const CutSide first = first_side(s.asked_);
    const bool is_first = s.side_ == first;
    const bool other_may_fit =
        s.asked_ == CutSide::unknown || (s.asked_ != CutSide::centred && may_be_the_other_side(s.estimate_));
    if (is_first && other_may_fit) {
        s.first_ = s.estimate_;
        begin_side(s, first == CutSide::down ? CutSide::up : CutSide::down);
        return;
    }
    if (!is_first) {
        s.estimate_ = s.asked_ == CutSide::unknown ? better_of_sides(s.first_, s.estimate_)
                                                   : told_or_other_side(s.first_, s.estimate_);
    }
    end_sides(s);
}

/// The forces alone have said what they can.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::end_sides(Search& s) const {
    const EngagementEstimate<Scalar>& e = s.estimate_;
    if (is_refuted(e)) {
        withdraw(s);
    } else if (e.side != CutSide::unknown && s.memory_knows_more()) {
        s.first_ = e;
        s.is_with_memory_ = true;
        s.profile_.set_known_depth(s.remembered_);
        begin_side(s, s.first_.side);
        return;
    }
    s.phase_ = Search::Phase::done;
}

/// The remembered depth has less than half the standard deviation of the one that the forces alone give.
template <typename Scalar, int Nodes>
bool EngagementSolver<Scalar, Nodes>::Search::memory_knows_more() const {
    const Scalar remembered_sd_mm = remembered_.relative_sd * remembered_.depth_mm;
    const bool forces_tell_it =
        estimate_.immersion_valid && halved(estimate_.axial_depth_force_sd_mm) < remembered_sd_mm;
    return remembered_.depth_mm > Scalar(0) && !forces_tell_it;
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::end_with_memory(Search& s) const {
    const bool fits = s.estimate_.misfit - s.first_.misfit < misfit_of_another_depth<Scalar>;
    if (s.estimate_.immersion_valid && fits) {
        s.estimate_.depth_is_remembered = true;
    } else {
        s.estimate_ = s.first_;
    }
    s.phase_ = Search::Phase::done;
}

/// No law of a straight cut gives these forces: any immersion is possible at which the flutes are long enough for
/// F_at, and none is an estimate.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::withdraw(Search& s) const {
    using elementary::cos;
    const Table& forces = table(s.estimate_.side);
    const auto needs_longer_flutes = [&](std::size_t node) {
        return largest_depth_mm_ > Scalar(0) && s.profile_.depth_by_tangential_mm(forces, node) > largest_depth_mm_;
    };
    std::size_t narrowest = 0;
    while (narrowest + 1 < nodes && needs_longer_flutes(narrowest)) {
        ++narrowest;
    }
    EngagementEstimate<Scalar>& e = s.estimate_;
    e.immersion_valid = false;
    e.depth_valid = false;
    e.engagement_low_rad = forces.angle_rad(Scalar(static_cast<int>(narrowest)));
    e.radial_immersion_low = Scalar(1) - cos(e.engagement_low_rad);
    e.engagement_high_rad = pi<Scalar>;
    e.radial_immersion_high = Scalar(2);
    e.radial_immersion_sd = (e.radial_immersion_high - e.radial_immersion_low) / width_of_95_percent<Scalar>;
    e.depth_at_low_mm = s.profile_.depth_by_tangential_mm(forces, narrowest);
    e.depth_at_high_mm = s.profile_.depth_by_tangential_mm(forces, nodes - 1);
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::step(Search& s) const {
    switch (s.phase_) {
        case Search::Phase::scan:
            scan(s);
            break;
        case Search::Phase::valleys:
            look_beside_valley(s);
            break;
        case Search::Phase::probe:
            probe(s);
            break;
        case Search::Phase::candidate:
            try_candidate(s);
            s.phase_ = Search::Phase::interval;
            break;
        case Search::Phase::interval:
            find_interval(s);
            s.phase_ = Search::Phase::depth;
            break;
        case Search::Phase::depth:
            find_depth(s);
            end_side(s);
            break;
        case Search::Phase::done:
            break;
    }
}

// Scan and refinement

/// Every second node.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::scan(Search& s) const {
    const std::size_t node = s.node_;
    look_at_node(s, node);
    if (node == 0 || s.J_[node] < s.best_.misfit) {
        s.best_node_ = node;
        s.best_.misfit = s.J_[node];
    }
    s.node_ += 2;
    if (s.node_ >= nodes) {
        s.node_ = s.end_of_descent(0);
        s.phase_ = Search::Phase::valleys;
    }
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::look_at_node(Search& s, std::size_t node) const {
    s.J_[node] = s.profile_.at_node(table(s.side_), node).misfit;
}

/// The last node from here on, of those scanned, up to which J falls.
template <typename Scalar, int Nodes>
std::size_t EngagementSolver<Scalar, Nodes>::Search::end_of_descent(std::size_t node) const {
    while (node + 2 < nodes && J_[node + 2] < J_[node]) {
        node += 2;
    }
    return node;
}
/// The last node from here on, of those scanned, up to which J does not fall.
template <typename Scalar, int Nodes>
std::size_t EngagementSolver<Scalar, Nodes>::Search::end_of_ascent(std::size_t node) const {
    while (node + 2 < nodes && !(J_[node + 2] < J_[node])) {
        node += 2;
    }
    return node;
}

/// The nodes on both sides of a valley that the scan saw.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::look_beside_valley(Search& s) const {
    const auto look_at = [&](std::size_t node) {
        look_at_node(s, node);
        if (s.J_[node] < s.best_.misfit) {
            s.best_.misfit = s.J_[node];
            s.best_node_ = node;
        }
    };
    if (s.node_ > 0) {
        look_at(s.node_ - 1);
    }
    if (s.node_ + 1 < nodes) {
        look_at(s.node_ + 1);
    }
    const std::size_t top = s.end_of_ascent(s.node_);
    if (top + 1 < nodes) {
        s.node_ = s.end_of_descent(top);
    } else {
        begin_refinement(s);
    }
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::begin_refinement(Search& s) const {
    if (!(s.best_.misfit >= Scalar(0))) {  // a force is NaN
        end_side(s);
        return;
    }
    const Table& forces = table(s.side_);
    s.best_ = s.profile_.at_node(forces, s.best_node_);
    s.centre_rad_ = forces.angle_rad(Scalar(static_cast<int>(s.best_node_)));
    s.phase_ = Search::Phase::probe;
}

/// J around the best node, in units of the nodes' step: J = J_0 + b u + a u² (+ k u (u² − 1)).
template <typename Scalar, int Nodes>
struct EngagementSolver<Scalar, Nodes>::Parabola {
    std::size_t node;
    Scalar a;
    Scalar b;

    /// Its vertex lies no farther than two steps from the middle: the minimum is not beyond an end of the range.
    [[nodiscard]] bool has_near_vertex() const { return Scalar(4) * a > b && Scalar(4) * a > -b; }
};

template <typename Scalar, int Nodes>
typename EngagementSolver<Scalar, Nodes>::Parabola EngagementSolver<Scalar, Nodes>::Search::parabola() const {
    const std::size_t k = best_node_ < 1 ? 1 : (best_node_ > nodes - 2 ? nodes - 2 : best_node_);
    return {k, halved(J_[k - 1] + J_[k + 1]) - J_[k], halved(J_[k + 1] - J_[k - 1])};
}

/// A point towards the parabola's vertex, and so far from all three nodes that it shows what is no parabola.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::probe(Search& s) const {
    constexpr Scalar nearest = literal<Scalar>(0.35L);
    constexpr Scalar farthest = literal<Scalar>(0.65L);
    const Parabola p = s.parabola();
    s.curvature_ = p.a > Scalar(0) ? Scalar(2) * p.a / square(table(s.side_).step_rad()) : Scalar(0);
    if (!p.has_near_vertex()) {
        s.phase_ = Search::Phase::interval;
        return;
    }
    const Scalar vertex = -halved(p.b / p.a);
    s.probe_in_steps_ = vertex < Scalar(0) ? -clamp(-vertex, nearest, farthest) : clamp(vertex, nearest, farthest);
    s.probe_J_ = keep_if_better(s, p, s.probe_in_steps_);
    s.phase_ = Search::Phase::candidate;
}

/// The minimum of the cubic through the three nodes and the probe.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::try_candidate(Search& s) const {
    using std::sqrt;
    const Parabola p = s.parabola();
    const Scalar u = s.probe_in_steps_;
    const Scalar rest = s.probe_J_ - s.J_[p.node] - u * (p.b + p.a * u);
    const Scalar slope = p.b / p.a;
    const Scalar cubic = rest / (p.a * u * (u * u - Scalar(1)));
    const Scalar discriminant = Scalar(1) - Scalar(3) * cubic * (slope - cubic);
    if (discriminant > Scalar(0)) {
        const Scalar root = sqrt(discriminant);
        s.curvature_ *= root;
        keep_if_better(s, p, clamp((cubic - slope) / (Scalar(1) + root), Scalar(-1), Scalar(1)));
    }
}

/// Returns J there.
template <typename Scalar, int Nodes>
Scalar EngagementSolver<Scalar, Nodes>::keep_if_better(Search& s, const Parabola& p, Scalar steps) const {
    const Table& forces = table(s.side_);
    const Scalar theta_rad = forces.angle_rad(Scalar(static_cast<int>(p.node))) + steps * forces.step_rad();
    const typename Profile::Value value = s.profile_.at(forces, theta_rad);
    if (value.misfit <= s.best_.misfit) {
        s.best_ = value;
        s.centre_rad_ = theta_rad;
    }
    return value.misfit;
}

// Interval and depth

template <typename Scalar, int Nodes>
bool EngagementSolver<Scalar, Nodes>::Search::is_inside(std::size_t node) const {
    return J_[node] <= best_.misfit + threshold_of_95_percent<Scalar>;
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
    const Scalar threshold = s.best_.misfit + threshold_of_95_percent<Scalar>;
    const auto crossing_rad = [&](std::size_t inside, std::size_t outside) {
        const Scalar rise = J[outside] - J[inside];
        const Scalar share = rise > Scalar(0) ? clamp((threshold - J[inside]) / rise, Scalar(0), Scalar(1)) : Scalar(0);
        const Scalar inside_rad = forces.angle_rad(Scalar(static_cast<int>(inside)));
        return inside_rad + (forces.angle_rad(Scalar(static_cast<int>(outside))) - inside_rad) * share;
    };
    const Scalar half_by_curvature = s.curvature_ > Scalar(0)
                                         ? deviations_of_95_percent<Scalar> * sqrt(Scalar(2) / s.curvature_)
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

/// Depth at the estimate and at the interval's ends; its deviation adds the uncertainty of immersion and K_s.
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
    const Scalar by_forces = square(spread_mm) + Scalar(1) / best.information;
    e.axial_depth_force_sd_mm = sqrt(by_forces);
    e.axial_depth_sd_mm = sqrt(by_forces + by_K_s);
    e.depth_valid = e.immersion_valid && e.axial_depth_sd_mm < e.axial_depth_mm;
}

}  // namespace millforce::estimation
