#pragma once

/// Whether the cut is fading: its section, width times depth, falls along the path by more than its noise explains.
///
/// A cut that fades asks for more feed, down to no cut at all; and what follows at its end, a wall or a step over, then
/// meets a tool at the highest feed of all. So the feed is raised in a steady cut, and held in a fading one.
///
///   S̄ ← S̄ + (S − S̄) s/(s + L),   falling: S < S̄ (1 − 8 %) − 2 σ_S
///
/// s: way since the last estimate, L = 1 mm the length of the memory: a fall of some 8 % per mm is the slowest that
/// counts, and a ramp in depth is no fade. The cut is fading from a fall until a way of L has been without. A fall by
/// more than a fifth at once is a step: the memory starts anew behind it. S in any unit, s in mm. Not thread-safe.

namespace millforce::control {

template <typename Scalar>
class CutTrend {
  public:
    void clear() {
        mean_ = Scalar(0);
        steady_mm_ = memory_mm;
    }

    void update(Scalar section, Scalar noise, Scalar way_mm) {
        if (!(section > Scalar(0)) || !(way_mm >= Scalar(0))) {
            return;
        }
        if (!(mean_ > Scalar(0))) {
            mean_ = section;
        }
        const bool falls = section < mean_ * (Scalar(1) - least_fall) - Scalar(2) * noise;
        const bool is_step = falls && section < mean_ * (Scalar(1) - step_fall);
        steady_mm_ = falls ? Scalar(0) : steady_mm_ + way_mm;
        mean_ += (section - mean_) * (is_step ? Scalar(1) : way_mm / (way_mm + memory_mm));
    }

    [[nodiscard]] bool fading() const { return steady_mm_ < memory_mm; }

  private:
    static constexpr Scalar memory_mm = Scalar(1);
    static constexpr Scalar least_fall = static_cast<Scalar>(0.08L);
    static constexpr Scalar step_fall = static_cast<Scalar>(0.2L);

    Scalar mean_{0};
    Scalar steady_mm_{memory_mm};
};

}  // namespace millforce::control
