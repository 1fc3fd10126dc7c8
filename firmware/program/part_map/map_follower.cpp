// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_follower.hpp"

namespace millforce::host {

MapFollower::MapFollower(const firmware::Parameters<float>& parameters, const PartMap& map)
    : position_(map),
      stretches_(stretches_of(map, parameters)),
      along_(parameters),
      ahead_(firmware::feed_ahead_settings(parameters.machine)) {
    fill_window();
}

void MapFollower::look_ahead(firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) {
    const std::optional<double> found = position_.find(program.line, static_cast<double>(program.distance_to_go_mm));
    if (along_.go_to(found ? std::optional(static_cast<float>(*found)) : std::nullopt)) {
        ahead_.restart();
        next_ = 0;
    }
    fill_window();
    tick.set_way_ahead(ahead_.step(along_.step(tick)));
}

void MapFollower::fill_window() {
    while (next_ < stretches_.size() && ahead_.room() > 0) {
        ahead_.add(stretches_[next_]);
        ++next_;
    }
}

}  // namespace millforce::host
