// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "part_map/map_follower.hpp"
#include "part_map/map_learner.hpp"

namespace millforce::host {

/// A tick's way with a part map: it looks ahead in one, and a new one is learnt, each if it is there. Both outlive
/// this. Not thread-safe.
class WayAlongMap final : public firmware::WaySource<float> {
  public:
    WayAlongMap(MapFollower* follower, MapLearner* learner) : follower_(follower), learner_(learner) {}

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
    MapFollower* follower_;
    MapLearner* learner_;
};

}  // namespace millforce::host
