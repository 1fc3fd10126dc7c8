// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "control/feed_ahead.hpp"
#include "estimation/number/circle.hpp"
#include "estimation/number/literal.hpp"
#include "firmware/parameters.hpp"

/// What whoever looks ahead in a map does with a tick, wherever the map comes from: a file or a bus.

namespace millforce::firmware {

template <typename Scalar>
[[nodiscard]] control::FeedAheadSettings<Scalar> feed_ahead_settings(const MachineParameters<Scalar>& machine) {
    // An estimate ends with a tooth period, an answer with a sample: a tick's share of the reaction.
    constexpr Scalar tick_share_s = estimation::literal<Scalar>(0.002L);
    control::FeedAheadSettings<Scalar> settings;
    settings.acceleration_mm_s2 = machine.cnc.acceleration_mm_s2;
    settings.reaction_s = machine.cnc.override_latency_s + tick_share_s;
    return settings;
}

/// A tool on its way along a program's path: joins its place and the tick's estimate to a step of FeedAhead.
///
///     if (along.go_to(position)) { ... }               // the program has begun again
///     tick.set_way_ahead(ahead.step(along.step(tick)));
///
/// Once for each sample, between the tick's estimate and its answer. Not thread-safe.
template <typename Scalar>
class AlongPath {
  public:
    explicit AlongPath(const Parameters<Scalar>& parameters)
        : teeth_(Scalar(parameters.tool.teeth)),
          tooth_share_(Scalar(1) / teeth_),
          stated_runout_mm_(parameters.tool.runout_um * estimation::literal<Scalar>(0.001L)),
          entry_feed_per_tooth_mm_(parameters.tool.control.entry_feed_per_tooth_mm),
          contact_force_N_(parameters.tool.control.contact_force_N),
          contact_significance_(parameters.tool.control.contact_significance),
          load_delay_s_(load_delay_s(parameters.machine)) {}

    /// Nothing: the place is not known. True if the program has begun again: the place has jumped back.
    bool go_to(std::optional<Scalar> position_mm) {
        // Going back by less than that is a corner that was blended.
        constexpr Scalar begun_again_mm{2};
        const Scalar path_mm = position_mm.value_or(path_mm_);
        is_known_ = position_mm.has_value();
        travel_mm_ = path_mm > path_mm_ ? path_mm - path_mm_ : Scalar(0);
        const bool has_begun_again = path_mm < path_mm_ - begun_again_mm;
        path_mm_ = path_mm;
        return has_begun_again;
    }

    /// At the path's begin, its place not known.
    void restart() {
        is_known_ = false;
        path_mm_ = Scalar(0);
        travel_mm_ = Scalar(0);
    }

    [[nodiscard]] bool is_known() const { return is_known_; }
    /// The last one that was known.
    [[nodiscard]] Scalar path_mm() const { return path_mm_; }

    /// `Tick`: a ForceControlTick.
    template <typename Tick>
    [[nodiscard]] control::FeedAheadStep<Scalar> step(const Tick& tick) const {
        using std::sqrt;
        const auto& estimate = tick.estimate();
        control::FeedAheadStep<Scalar> now;
        now.position_known = is_known_;
        now.position_mm = path_mm_;
        now.travel_mm = travel_mm_;
        now.dt_s = tick.step_s();
        now.feed_mm_s = tick.path_speed_mm_s();
        now.asked_feed_mm_s = tick.asked_feed_mm_s();
        const Scalar teeth_per_s = teeth_ * estimate.spindle_speed_rad_s * estimation::turns_per_rad<Scalar>;
        now.blind_feed_mm_s = entry_feed_per_tooth_mm_ * teeth_per_s;
        now.tooth_share = tooth_share_;
        now.runout_mm_s = estimate.runout_mm * teeth_per_s;
        now.mapped_runout_mm_s = stated_runout_mm_ * teeth_per_s;
        now.fresh = tick.has_new_estimate() && tick.feed_is_settled() && estimate.tangential_N.valid;
        now.tangential_N = estimate.tangential_N.value;
        now.tangential_sd_N = sqrt(estimate.tangential_N.variance);
        now.mean_feed_mm_s = estimate.feed_mm_s;
        now.window_mm = estimate.feed_mm_s * (estimate.window_s + load_delay_s_);
        now.contact_level_N = control::contact_level_N(contact_force_N_, contact_significance_, now.tangential_sd_N);
        now.feed_force_valid = estimate.feed_N.valid;
        now.feed_force_N = estimate.feed_N.value;
        now.feed_force_sd_N = sqrt(estimate.feed_N.variance);
        return now;
    }

  private:
    Scalar teeth_;
    Scalar tooth_share_;
    Scalar stated_runout_mm_;
    Scalar entry_feed_per_tooth_mm_;
    Scalar contact_force_N_;
    Scalar contact_significance_;
    Scalar load_delay_s_;
    bool is_known_ = false;
    Scalar path_mm_{0};
    Scalar travel_mm_{0};
};

}  // namespace millforce::firmware
