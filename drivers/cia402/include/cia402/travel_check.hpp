// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cia402/magnitude.hpp"

namespace millforce::cia402 {

/// Whether an axis goes as far by its velocity object as by its position object. A factor of 60 (rpm for rev/s), 10 or
/// 1000 in one of the units is otherwise a plausible number. Judged over windows of 0.1 s in which the axis moved
/// 0.2 mm by either; the two may differ by a quarter: acceleration, filters in the drive and rounding explain no more.
/// The judgement holds until the next such window.
class TravelCheck {
  public:
    static constexpr float window_s = 0.1F;
    static constexpr float least_way_mm = 0.2F;
    static constexpr float largest_difference_share = 0.25F;

    void add(float velocity_mm_s, float way_mm, float elapsed_s) {
        by_velocity_mm_ += velocity_mm_s * elapsed_s;
        by_position_mm_ += way_mm;
        elapsed_s_ += elapsed_s;
        if (elapsed_s_ < window_s) {
            return;
        }
        const float larger_mm = magnitude(by_velocity_mm_) > magnitude(by_position_mm_) ? magnitude(by_velocity_mm_)
                                                                                        : magnitude(by_position_mm_);
        if (larger_mm > least_way_mm) {
            disagrees_ = magnitude(by_velocity_mm_ - by_position_mm_) > largest_difference_share * larger_mm;
        }
        restart_window();
    }
    void restart_window() { by_velocity_mm_ = by_position_mm_ = elapsed_s_ = 0.0F; }
    [[nodiscard]] bool disagrees() const { return disagrees_; }

  private:
    float by_velocity_mm_ = 0.0F;
    float by_position_mm_ = 0.0F;
    float elapsed_s_ = 0.0F;
    bool disagrees_ = false;
};

}  // namespace millforce::cia402
