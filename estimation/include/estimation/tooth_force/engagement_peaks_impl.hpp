// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/tooth_force/engagement_peaks.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar>
EngagementPeaks<Scalar>::EngagementPeaks(const CuttingLaw<Scalar>& law, const Settings& settings)
    : largest_depth_mm_(settings.largest_depth_mm),
      surge_(place_of(settings.surge_immersion)),
      turn_(place_of(settings.turn_immersion)),
      slot_(place_of(Scalar(2))),
      now_(place_of(settings.assumed_immersion)),
      side_(settings.peak.side) {
    const auto build = [&](ToothPeakTable<Scalar>& table, CutSide side) {
        PeakFactorSettings<Scalar> peak = settings.peak;
        peak.side = peak.side == CutSide::centred ? CutSide::centred : side;
        table.build(law, peak);
    };
    build(down_, CutSide::down);
    build(up_, CutSide::up);
}

template <typename Scalar>
typename EngagementPeaks<Scalar>::Place EngagementPeaks<Scalar>::place_of(Scalar radial_immersion) {
    using elementary::acos;
    return {acos(Scalar(1) - clamp(radial_immersion, Scalar(0), Scalar(2))), radial_immersion};
}

template <typename Scalar>
void EngagementPeaks<Scalar>::take(const EngagementEstimate<Scalar>& found, const EngagementSolver<Scalar>& solver,
                                   Scalar tangential_N, Scalar feed_per_tooth_mm) {
    take_place(found);
    const Table& table = solver.table(side_);
    feed_ = table.feed(feed_per_tooth_mm);
    here_node_ = table.between(now_.theta_rad);
    factors_.now = factor(now_, depth_mm_);
    factors_.slot = factor(slot_, depth_mm_);
    factors_.by_K_s = change_by_K_s(table);
    read_changes(table);
    places_left_ = 0;
    if (found.immersion_valid) {
        read_ends(found);
    } else {
        begin_search(found, table, tangential_N);
    }
}

template <typename Scalar>
void EngagementPeaks<Scalar>::take_place(const EngagementEstimate<Scalar>& found) {
    if (found.immersion_valid) {
        now_ = {found.engagement_rad, found.radial_immersion};
        side_ = found.side;
        last_depth_mm_ = found.depth_valid ? found.axial_depth_mm : last_depth_mm_;
    }
    // Use this depth even if uncertain: it was solved together with the immersion.
    const bool has_depth = found.immersion_valid && found.axial_depth_mm > Scalar(0);
    const Scalar usual_mm = last_depth_mm_ > Scalar(0) ? last_depth_mm_ : largest_depth_mm_;
    depth_mm_ = has_depth ? found.axial_depth_mm : usual_mm;
}

template <typename Scalar>
Scalar EngagementPeaks<Scalar>::factor(const Place& cut, Scalar depth_mm) const {
    const ToothPeakTable<Scalar>& table = side_ == CutSide::up ? up_ : down_;
    return table.at_angle(cut.theta_rad, cut.radial_immersion, depth_mm);
}

/// The engagements that may come.
template <typename Scalar>
void EngagementPeaks<Scalar>::read_changes(const Table& table) {
    if (surge_is_wider()) {
        surge_node_ = table.between(surge_.theta_rad);
        factors_.surge = factor(surge_, depth_mm_);
    }
    if (turn_is_wider()) {
        turn_node_ = table.between(turn_.theta_rad);
        factors_.turn = factor(turn_, depth_mm_);
    }
}

template <typename Scalar>
void EngagementPeaks<Scalar>::read_ends(const EngagementEstimate<Scalar>& found) {
    const bool has_depth = found.axial_depth_mm > Scalar(0);
    const Place low{found.engagement_low_rad, found.radial_immersion_low};
    const Place high{found.engagement_high_rad, found.radial_immersion_high};
    factors_.at_low = factor(low, has_depth ? found.depth_at_low_mm : depth_mm_);
    factors_.at_high = factor(high, has_depth ? found.depth_at_high_mm : depth_mm_);
}

/// Any immersion of the interval is possible, each with the depth that F_at asks for there, as far as the flutes reach.
/// The worst is neither the narrowest cut, whose long edge comes in bit by bit, nor the widest, whose teeth share the
/// load.
template <typename Scalar>
void EngagementPeaks<Scalar>::begin_search(const EngagementEstimate<Scalar>& found, const Table& table,
                                           Scalar tangential_N) {
    constexpr int places = 9;
    const bool has_low = found.solved && found.engagement_low_rad > Table::first_rad;
    const Scalar high_rad = found.solved ? found.engagement_high_rad : table.last_rad();
    place_rad_ = has_low ? found.engagement_low_rad : Table::first_rad;
    step_rad_ = (high_rad - place_rad_) / Scalar(places - 1);
    tangential_N_ = tangential_N;
    places_left_ = places;
    factors_.bound = factors_.slot;
}

template <typename Scalar>
void EngagementPeaks<Scalar>::search(const EngagementSolver<Scalar>& solver) {
    using elementary::cos;
    constexpr int places_at_once = 3;
    const Table& table = solver.table(side_);
    for (int k = 0; k < places_at_once && places_left_ > 0; ++k) {
        const Scalar depth_mm = tangential_N_ / table.at(place_rad_, feed_).tangential_N;
        if (depth_mm > Scalar(0) && depth_mm < largest_depth_mm_) {
            const Scalar here = factor({place_rad_, Scalar(1) - cos(place_rad_)}, depth_mm);
            factors_.bound = here > factors_.bound ? here : factors_.bound;
        }
        place_rad_ += step_rad_;
        --places_left_;
    }
}

/// An error in K_s is an error of the depth, and so of how much of the edge is taken to be in cut.
template <typename Scalar>
Scalar EngagementPeaks<Scalar>::change_by_K_s(const Table& table) const {
    using std::sqrt;
    if (!(feed_.G_N_per_mm > Scalar(0))) {
        return Scalar(0);
    }
    const Scalar variance = table.doubt_of_K_s().variance_at(Table::ln_t_in_references(here_node_, feed_));
    const Scalar shallower_mm = depth_mm_ * (Scalar(1) - sqrt(variance));
    return factor(now_, shallower_mm) - factors_.now;
}

}  // namespace millforce::estimation
