// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/feed_ahead.hpp"

#include <CppUTest/TestHarness.h>

#include <vector>

/// A map of air with a wall in it, and estimates along the way.

namespace millforce::control::bench {

using Ahead = FeedAhead<float>;

inline constexpr float air_feed_mm_s = 60.0F;
inline constexpr float wall_feed_mm_s = 10.0F;
inline constexpr float wall_mm = 40.0F;
inline constexpr float end_mm = 100.0F;
inline constexpr float step_mm = 0.1F;

constexpr Stretch<float> air_from(float begin_mm) {
    Stretch<float> stretch;
    stretch.begin_mm = begin_mm;
    stretch.feed_mm_s = air_feed_mm_s;
    return stretch;
}

constexpr Stretch<float> cut_from(float begin_mm, float feed_mm_s = wall_feed_mm_s, float tangential_N = 300.0F) {
    Stretch<float> stretch;
    stretch.begin_mm = begin_mm;
    stretch.feed_mm_s = feed_mm_s;
    stretch.tangential_N = tangential_N;
    stretch.tooth_per_tangential = 2.0F;
    stretch.feed_per_tangential = 0.5F;
    return stretch;
}

inline const std::vector<Stretch<float>> wall = {air_from(0.0F), cut_from(wall_mm), air_from(end_mm)};

/// A material as in the tool's file, and a position to the point, so that the answers are known.
inline FeedAheadSettings<float> exact(float reaction_s = 0.05F) {
    FeedAheadSettings<float> settings;
    settings.acceleration_mm_s2 = 500.0F;
    settings.reaction_s = reaction_s;
    settings.position_tolerance_mm = 0.0F;
    settings.farthest_off_mm = 0.0F;
    settings.assumed_hardness = 1.0F;
    return settings;
}

inline Ahead with(const std::vector<Stretch<float>>& stretches, const FeedAheadSettings<float>& settings = exact()) {
    Ahead ahead(settings);
    for (const Stretch<float>& stretch : stretches) {
        CHECK_TRUE(ahead.add(stretch));
    }
    return ahead;
}

inline Ahead::Step at(float position_mm) {
    Ahead::Step now;
    now.position_known = true;
    now.position_mm = position_mm;
    now.blind_feed_mm_s = 5.0F;
    return now;
}

/// A new estimate one step further along the path, over the last half millimetre.
inline Ahead::Step estimate_at(float position_mm, float tangential_N, float feed_mm_s = wall_feed_mm_s) {
    Ahead::Step now = at(position_mm);
    now.travel_mm = step_mm;
    now.fresh = true;
    now.tangential_N = tangential_N;
    now.tangential_sd_N = 5.0F;
    now.mean_feed_mm_s = feed_mm_s;
    now.window_mm = 0.5F;
    now.contact_level_N = 20.0F;
    now.feed_force_valid = true;
    now.feed_force_N = 0.5F * tangential_N;
    now.feed_force_sd_N = 5.0F;
    return now;
}

/// Estimates of one force along a way; the last answer.
inline WayAhead<float> cut(Ahead& ahead, float from_mm, float to_mm, float tangential_N) {
    WayAhead<float> way;
    for (float s_mm = from_mm; s_mm <= to_mm; s_mm += step_mm) {
        way = ahead.step(estimate_at(s_mm, tangential_N));
    }
    return way;
}

}  // namespace millforce::control::bench
