// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "control/feed_ahead.hpp"
#include "firmware/along_path.hpp"
#include "firmware/tick.hpp"
#include "firmware/way_source.hpp"
#include "part_map/part_map.hpp"
#include "part_map/path_position.hpp"

namespace millforce::host {

/// Gives a tick the part map. If the position on the path jumps back, the program has begun again. If the CNC reports a
/// line that the map does not have, nothing is known of the path ahead. Not thread-safe.
class MapFollower final : public firmware::WaySource<float> {
  public:
    MapFollower(const firmware::Parameters<float>& parameters, const PartMap& map);

    void look_ahead(firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) override;

    [[nodiscard]] bool is_refuted() const override { return ahead_.is_refuted(); }
    [[nodiscard]] const control::FeedAhead<float>& ahead() const { return ahead_; }

  private:
    void fill_window();

    PathPosition position_;
    std::vector<control::Stretch<float>> stretches_;
    std::size_t next_ = 0;  // that the window does not hold yet
    firmware::AlongPath<float> along_;
    control::FeedAhead<float> ahead_;
};

}  // namespace millforce::host
