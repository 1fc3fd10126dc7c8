// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"

namespace millforce::firmware {

/// Whether the spindle turns at the speed that the CNC commands.
///
/// A spindle may take seconds to run up, so it is judged only where its speed and the command have stood within 3 % for
/// a second. Then it may differ from the command by a fifth: a converter's slip and a belt are within that. An encoder
/// whose counts are taken twice or four times, encoder_counts_per_rev for another resolution, a gear that the CNC does
/// not know of, and a spindle that a cut has slowed down are not.
///
/// Valid for commands above 0. Cost: some 20 instructions an estimate.
/// No heap, no clock. One thread.
template <typename Scalar>
class CommandedSpeed {
  public:
    static constexpr Scalar settled_s = Scalar(1);
    static constexpr Scalar largest_share = estimation::literal<Scalar>(0.2L);

    void restart() { *this = CommandedSpeed(); }

    /// Each estimate. `elapsed_s`: since the last one. True: the spindle turns evenly, and at another speed.
    [[nodiscard]] bool is_missed(Scalar commanded_rad_s, Scalar speed_rad_s, Scalar elapsed_s) {
        const bool goes_on =
            is_near(commanded_rad_s, commanded_rad_s_, even_share) && is_near(speed_rad_s, speed_rad_s_, even_share);
        if (!goes_on) {
            commanded_rad_s_ = commanded_rad_s;
            speed_rad_s_ = speed_rad_s;
            even_s_ = Scalar(0);
            return false;
        }
        even_s_ += elapsed_s;
        return even_s_ > settled_s && !is_near(speed_rad_s, commanded_rad_s, largest_share);
    }

  private:
    static constexpr Scalar even_share = estimation::literal<Scalar>(0.03L);

    [[nodiscard]] static bool is_near(Scalar a, Scalar b, Scalar share) {
        const Scalar most = share * b;
        return a - b <= most && b - a <= most;
    }

    Scalar commanded_rad_s_{0};  // of the stretch that is as even as even_share
    Scalar speed_rad_s_{0};
    Scalar even_s_{0};
};

}  // namespace millforce::firmware
