// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "control/feed_ahead.hpp"
#include "firmware/tick.hpp"
#include "part_map/part_map.hpp"

namespace millforce::host {

/// Lets a tick see the part map: between its estimate and its answer, follow() tells it the way ahead. A path that goes
/// backwards is the program's begin again. Not thread-safe.
class MapFollower {
  public:
    MapFollower(const firmware::Parameters<float>& parameters, const PartMap& map);

    void follow(firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program);

    [[nodiscard]] const control::FeedAhead<float>& ahead() const { return ahead_; }

  private:
    void fill_window();

    firmware::Parameters<float> parameters_;
    std::vector<control::Stretch<float>> stretches_;
    std::size_t next_ = 0;  // that the window does not hold yet
    control::FeedAhead<float> ahead_;
    float path_mm_ = 0.0F;
};

}  // namespace millforce::host
