// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether the cut fades or grows: its section, width times depth, changes along the path by more than its noise
/// explains.
///
/// A cut that fades asks for more feed, down to no cut at all; and what follows at its end, a wall or a step over, then
/// meets a tool at the highest feed of all. So the feed is raised in a steady cut, and held in a fading one. In a cut
/// that grows into a wall the arc begins and ends anywhere, and the immersion that the forces tell is too large: what
/// was set up against the wall is not to be taken back before the section has stopped growing.
///
///   S̄ ← S̄ + (S − S̄) s/(s + L),   falling: S < S̄ (1 − 8 %) − 2 σ_S,   rising: S > S̄ (1 + 8 %) + 2 σ_S
///
/// s: way since the last estimate, L = 1 mm the length of the memory: a change of some 8 % per mm is the slowest that
/// counts, and a ramp in depth is none. The cut is fading from a fall until a way of L has been without. A fall by
/// more than a fifth at once is a step: the memory starts anew behind it. The cut is growing from a rise that follows
/// on a calm way of L/4 until the next such way. S in any unit, s in mm. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class CutTrend {
  public:
    void clear() {
        mean_ = Scalar(0);
        steady_mm_ = memory_mm;
        forget_growth();
    }

    /// As if the cut had been growing all along: it is not seen to grow before it has been calm.
    void forget_growth() {
        calm_mm_ = Scalar(0);
        growing_ = false;
    }

    void update(Scalar section, Scalar noise, Scalar way_mm) {
        if (!(section > Scalar(0)) || !(way_mm >= Scalar(0))) {
            return;
        }
        if (!(mean_ > Scalar(0))) {
            mean_ = section;
        }
        const Scalar by_chance = Scalar(2) * noise;
        const bool rises = section > mean_ * (Scalar(1) + least_change) + by_chance;
        const bool falls = section < mean_ * (Scalar(1) - least_change) - by_chance;
        const bool is_step = falls && section < mean_ * (Scalar(1) - step_fall);
        const bool was_calm = calm_mm_ >= calm_way_mm;
        growing_ = rises ? growing_ || was_calm : growing_ && !was_calm;
        calm_mm_ = rises ? Scalar(0) : calm_mm_ + way_mm;
        steady_mm_ = falls ? Scalar(0) : steady_mm_ + way_mm;
        mean_ += (section - mean_) * (is_step ? Scalar(1) : way_mm / (way_mm + memory_mm));
    }

    [[nodiscard]] bool fading() const { return steady_mm_ < memory_mm; }
    [[nodiscard]] bool growing() const { return growing_; }

  private:
    static constexpr Scalar memory_mm = Scalar(1);
    static constexpr Scalar calm_way_mm = static_cast<Scalar>(0.25L);
    static constexpr Scalar least_change = static_cast<Scalar>(0.08L);
    static constexpr Scalar step_fall = static_cast<Scalar>(0.2L);

    Scalar mean_{0};
    Scalar steady_mm_{memory_mm};
    Scalar calm_mm_{0};
    bool growing_ = false;
};

}  // namespace millforce::control
