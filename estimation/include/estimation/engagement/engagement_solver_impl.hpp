// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of engagement_solver.hpp: the order of a search, side by side and with the memory of the depth.

#include "estimation/engagement/engagement_interval_impl.hpp"
#include "estimation/engagement/engagement_refinement_impl.hpp"
#include "estimation/engagement/engagement_solver.hpp"
#include "estimation/engagement/immersion_profile_impl.hpp"
#include "estimation/engagement/side_choice.hpp"

#include <cmath>

namespace millforce::estimation {

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
                                            const KnownDepth<Scalar>& remembered, bool law_is_in_doubt) const {
    search.asked_ = side;
    search.remembered_ = remembered;
    search.law_is_in_doubt_ = law_is_in_doubt;
    search.with_ = Search::With::declared_depth;
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
    if (s.with_ == Search::With::remembered_depth) {
        end_with_memory(s);
        return;
    }
    if (s.with_ == Search::With::forces_alone) {
        end_without_declared_depth(s);
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
                                                   : declared_or_other_side(s.first_, s.estimate_);
    }
    if (settings_.declared_depth_mm > Scalar(0) && s.estimate_.side != CutSide::unknown &&
        s.estimate_.misfit > misfit_of_another_depth<Scalar>) {
        s.with_ = Search::With::forces_alone;
        search_again(s, {});
        return;
    }
    end_sides(s);
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::search_again(Search& s, const KnownDepth<Scalar>& depth) const {
    s.first_ = s.estimate_;
    s.profile_.set_known_depth(depth);
    begin_side(s, s.first_.side);
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::end_without_declared_depth(Search& s) const {
    if (s.first_.misfit - s.estimate_.misfit > misfit_of_another_depth<Scalar>) {
        s.estimate_.declared_depth_is_refuted = true;
    } else {
        s.estimate_ = s.first_;
    }
    end_sides(s);
}

/// The forces, with the declared depth if there is one, have said what they can.
template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::end_sides(Search& s) const {
    const EngagementEstimate<Scalar>& e = s.estimate_;
    if (is_refuted(e) || s.law_is_in_doubt_) {
        withdraw(s);
    } else if (e.side != CutSide::unknown && s.memory_knows_more()) {
        s.with_ = Search::With::remembered_depth;
        search_again(s, s.remembered_);
        return;
    }
    s.phase_ = Search::Phase::done;
}

/// The remembered depth has less than half the standard deviation of the one that the forces alone give.
template <typename Scalar, int Nodes>
bool EngagementSolver<Scalar, Nodes>::Search::memory_knows_more() const {
    const Scalar remembered_sd_mm = remembered_.relative_sd * remembered_.depth_mm;
    const bool forces_give_it =
        estimate_.immersion_valid && halved(estimate_.axial_depth_force_sd_mm) < remembered_sd_mm;
    return remembered_.depth_mm > Scalar(0) && !forces_give_it;
}

template <typename Scalar, int Nodes>
void EngagementSolver<Scalar, Nodes>::end_with_memory(Search& s) const {
    const bool fits = s.estimate_.misfit - s.first_.misfit < misfit_of_another_depth<Scalar>;
    if (s.estimate_.immersion_valid && fits) {
        s.estimate_.depth_is_remembered = true;
        s.estimate_.declared_depth_is_refuted = s.first_.declared_depth_is_refuted;
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
    e.law_is_in_doubt = s.law_is_in_doubt_;
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

}  // namespace millforce::estimation
