// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_follower.hpp"

#include <cmath>

#include "estimation/number/circle.hpp"

namespace millforce::host {

namespace {

/// An estimate ends with a tooth period, an answer with a sample: a tick's share of the reaction.
constexpr float tick_share_s = 0.002F;
/// Going back by less than that is a corner that was blended.
constexpr float begun_again_mm = 2.0F;

control::FeedAheadSettings<float> settings_of(const firmware::Parameters<float>& parameters) {
    control::FeedAheadSettings<float> settings;
    settings.acceleration_mm_s2 = parameters.machine.cnc.acceleration_mm_s2;
    settings.reaction_s = parameters.machine.cnc.override_latency_s + tick_share_s;
    settings.teeth = static_cast<float>(parameters.tool.teeth);
    return settings;
}

}  // namespace

MapFollower::MapFollower(const firmware::Parameters<float>& parameters, const PartMap& map)
    : parameters_(parameters),
      position_(map),
      stretches_(stretches_of(map, parameters)),
      ahead_(settings_of(parameters)) {
    fill_window();
}

void MapFollower::look_ahead(firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) {
    const std::optional<double> found = position_.find(program.line, static_cast<double>(program.distance_to_go_mm));
    const float path_mm = found ? static_cast<float>(*found) : path_mm_;
    if (path_mm < path_mm_ - begun_again_mm) {
        ahead_.restart();
        next_ = 0;
    }
    const estimation::CutEstimate<float>& estimate = tick.estimate();
    const control::FeedControllerParameters<float>& control = parameters_.tool.control;
    control::FeedAhead<float>::Step now;
    now.position_known = found.has_value();
    now.position_mm = path_mm;
    now.travel_mm = std::max(path_mm - path_mm_, 0.0F);
    const float teeth_per_s = static_cast<float>(parameters_.tool.teeth) * estimate.spindle_speed_rad_s *
                              estimation::turns_per_rad<float>;
    now.blind_feed_mm_s = control.entry_feed_per_tooth_mm * teeth_per_s;
    now.runout_mm_s = estimate.runout_mm * teeth_per_s;
    now.mapped_runout_mm_s = 0.001F * parameters_.tool.runout_um * teeth_per_s;
    now.fresh = tick.has_new_estimate() && tick.feed_is_settled() && estimate.tangential_N.valid;
    now.tangential_N = estimate.tangential_N.value;
    now.tangential_sd_N = std::sqrt(estimate.tangential_N.variance);
    now.mean_feed_mm_s = estimate.feed_mm_s;
    now.window_mm = estimate.feed_mm_s * (estimate.window_s + firmware::load_delay_s(parameters_.machine));
    now.contact_level_N = control::contact_level_N(control, now.tangential_sd_N);
    now.feed_force_valid = estimate.feed_N.valid;
    now.feed_force_N = estimate.feed_N.value;
    now.feed_force_sd_N = std::sqrt(estimate.feed_N.variance);
    path_mm_ = path_mm;
    fill_window();
    tick.set_way_ahead(ahead_.step(now));
}

void MapFollower::fill_window() {
    while (next_ < stretches_.size() && ahead_.room() > 0) {
        ahead_.add(stretches_[next_]);
        ++next_;
    }
}

}  // namespace millforce::host
