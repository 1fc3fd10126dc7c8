// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"

namespace millforce::firmware {

/// Whether a force that is known late belongs to the present feed per tooth: that has stayed within 5 % for as long as
/// the force is late. Late by 0 s: always.
///
/// take() with each estimate, wait() with each sample. Cost: two comparisons an estimate. One thread.
template <typename Scalar>
class SettledFeed {
  public:
    explicit SettledFeed(Scalar late_s) : late_s_(late_s), settled_s_(late_s) {}

    void take(Scalar feed_per_tooth_mm) {
        constexpr Scalar tolerated_share = estimation::literal<Scalar>(0.05L);
        const Scalar change = feed_per_tooth_mm - feed_per_tooth_mm_;
        const Scalar tolerated = tolerated_share * feed_per_tooth_mm_;
        if (!(change <= tolerated && -change <= tolerated)) {
            feed_per_tooth_mm_ = feed_per_tooth_mm;
            settled_s_ = Scalar(0);
        }
    }
    void wait(Scalar dt_s) { settled_s_ += dt_s; }
    [[nodiscard]] bool is_settled() const { return settled_s_ >= late_s_; }

  private:
    Scalar late_s_;
    Scalar settled_s_;
    Scalar feed_per_tooth_mm_{0};
};

}  // namespace millforce::firmware
