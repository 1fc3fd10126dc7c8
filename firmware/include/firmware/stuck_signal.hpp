// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "hal/finite.hpp"

namespace millforce::firmware {

/// Notices a signal that shows the same value for far longer than it ever did: a drive that hangs, an amplifier or a
/// converter at its end.
///
/// The first 256 changes teach how often the signal changes. A signal whose steps are all of one size is never judged:
/// its noise is below its resolution, and it may rightly stand still. Neither is one whose source is so slow that it
/// has not changed so often. Else it is stuck after 32 equal values, and 8 times the longest run seen before. A signal
/// that is cut off at a level for part of each tooth counts by its runs at that level.
///
/// add() with each sample while the signal has a reason to vary, pause() otherwise. Cost: a comparison of bits.
class StuckSignal {
  public:
    void add(float value) { take(value, true); }
    /// As add(), but where the signal varies differently: that teaches nothing.
    void watch(float value) { take(value, false); }
    void pause() {
        has_last_ = false;
        run_ = 0;
    }

    /// add() or pause(), whether the signal has a reason to vary or not.
    void follow(float value, bool may_vary) {
        if (may_vary) {
            add(value);
        } else {
            pause();
        }
    }

    [[nodiscard]] bool has_learnt() const { return changes_ == enough_changes; }
    [[nodiscard]] bool is_stuck() const {
        constexpr std::uint16_t least_run = 32;
        constexpr std::uint32_t longest_runs = 8;
        return has_learnt() && run_ >= least_run && run_ > longest_runs * longest_run_ && has_noise();
    }

  private:
    static constexpr std::uint16_t longest_count = 0xFFFF;
    static constexpr std::uint16_t enough_changes = 256;
    // Steps are learnt in whole numbers: without a floating-point unit they cost a third.
    static constexpr float units_per_one = 4096.0F;
    static constexpr float largest_value = 1e5F;

    [[nodiscard]] bool has_noise() const {
        constexpr std::int32_t steps = 3;  // of the resolution
        return largest_step_ > steps * smallest_step_ + smallest_step_ / 2;
    }
    void take(float value, bool learns) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        if (has_last_ && bits == last_bits_) {
            run_ = run_ < longest_count ? static_cast<std::uint16_t>(run_ + 1) : run_;
            return;
        }
        if (learns && changes_ < enough_changes && hal::is_smaller(value, largest_value)) {
            learn(static_cast<std::int32_t>(value * units_per_one));
        }
        has_last_ = true;
        last_bits_ = bits;
        run_ = 0;
    }
    void learn(std::int32_t now) {
        const std::int32_t size = now < learnt_ ? learnt_ - now : now - learnt_;
        learnt_ = now;
        if (!has_last_) {
            return;
        }
        smallest_step_ = changes_ == 0 || size < smallest_step_ ? size : smallest_step_;
        largest_step_ = size > largest_step_ ? size : largest_step_;
        longest_run_ = run_ > longest_run_ ? run_ : longest_run_;
        ++changes_;
    }

    std::uint32_t last_bits_ = 0;
    std::int32_t learnt_ = 0;  // the value before
    std::int32_t smallest_step_ = 0;
    std::int32_t largest_step_ = 0;
    std::uint16_t run_ = 0;
    std::uint16_t longest_run_ = 0;
    std::uint16_t changes_ = 0;
    bool has_last_ = false;
};

}  // namespace millforce::firmware
