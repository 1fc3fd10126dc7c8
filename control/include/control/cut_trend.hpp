// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/fixed_point.hpp"

/// Whether the cut fades or grows: its section, width times depth, changes along the path by more than its noise
/// explains.
///
/// A cut that fades asks for more feed, down to no cut at all; and what follows at its end, a wall or a step over, then
/// meets a tool at the highest feed of all. So the feed is raised in a steady cut, and held in a fading one. In a cut
/// that grows into a wall the arc begins and ends anywhere, and the immersion that the forces show is too large: a
/// ceiling that was set before the wall is to stay until the section has stopped growing.
///
///   S̄ ← S̄ + (S − S̄) s/(s + L),   falling: S < S̄ (1 − 8 %) − 2 σ_S,   rising: S > S̄ (1 + 8 %) + 2 σ_S
///
/// s: travel since the last estimate, L = 1 mm the length of the memory: a change of some 8 % per mm is the slowest
/// that counts, and a ramp in depth is none. Fading lasts from a fall until L is travelled without another. A fall by
/// more than a fifth at once is a step, and the memory starts over at the new section. Growing starts with a rise after
/// at least L/4 without one, and ends after L/4 without a rise.
///
/// Section in any unit, > 0: others, and NaN, are left out. Travel in mm, ≥ 0. Cost: some 20 operations and a division
/// per estimate. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class CutTrend {
  public:
    void clear();
    /// As if the cut had been growing all along: it is not seen to grow before it has been calm.
    void forget_growth();
    void update(Scalar section, Scalar section_sd, Scalar travel_mm);

    [[nodiscard]] bool fading() const;
    [[nodiscard]] bool growing() const { return growing_; }

  private:
    static constexpr Scalar memory_mm = Scalar(1);

    Scalar mean_{0};
    Scalar since_fall_mm_{memory_mm};
    Scalar since_rise_mm_{0};
    bool growing_ = false;
};

extern template class CutTrend<float>;
extern template class CutTrend<estimation::Fixed>;

}  // namespace millforce::control
