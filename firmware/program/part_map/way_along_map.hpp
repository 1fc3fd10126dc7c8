// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "part_map/map_follower.hpp"
#include "part_map/map_learner.hpp"

namespace millforce::host {

/// A tick's way with part maps: it looks ahead in one, and new ones are learnt, each if it is there. With tools by
/// number the map is that of the tool in the spindle; without a map for it, or while no tool is known, nothing is known
/// of the way ahead. A tool that comes back goes on in its map: what the cut has refuted stays so until its program
/// begins again. All outlive this. Not thread-safe.
class WayAlongMap final : public firmware::WaySource<float> {
  public:
    /// In the map of the tool with this number; 0: of the one tool of a machine without numbers.
    struct Numbered {
        std::uint32_t number = 0;
        MapFollower* follower = nullptr;
    };

    WayAlongMap(MapFollower* follower, MapLearner* learner) : WayAlongMap({{0, follower}}, learner) {}
    WayAlongMap(std::vector<Numbered> followers, MapLearner* learner)
        : followers_(std::move(followers)), learner_(learner) {
        begin_again();
    }

    void set_tool(std::uint32_t number) override {
        const auto found = std::find_if(followers_.begin(), followers_.end(),
                                        [number](const Numbered& one) { return one.number == number; });
        follower_ = found != followers_.end() ? found->follower : nullptr;
        if (learner_ != nullptr) {
            learner_->set_tool(number);
        }
    }
    void begin_again() override { set_tool(0); }

    void look_ahead(firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) override {
        if (learner_ != nullptr) {
            learner_->take(tick, program);
        }
        if (follower_ != nullptr) {
            follower_->look_ahead(tick, program);
        }
    }

    [[nodiscard]] bool is_refuted() const override { return follower_ != nullptr && follower_->is_refuted(); }

  private:
    std::vector<Numbered> followers_;
    MapLearner* learner_;
    MapFollower* follower_ = nullptr;
};

}  // namespace millforce::host
