// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"

#include <array>
#include <cmath>
#include <cstddef>

/// Forces over one revolution of the spindle, averaged over whole revolutions on a grid of angles.
///
/// Samples may come at the grid's own angles (an encoder that triggers them) or at any other rate: each grid point that
/// the spindle passes between two samples gets the value of the straight line between them. A reversal, a standstill of
/// the samples or a turn of more than `largest_step_rev` between two of them restarts the profile: nothing is made up.
///
/// Memory: 16 bytes per grid point in float. Cost per sample: 4 multiplications per grid point passed. Not thread-safe.

namespace millforce::estimation {

template <typename Scalar, int Bins = 512>
class RevolutionProfile {
    static_assert(Bins >= 64 && Bins <= 4096);

  public:
    static constexpr int bins = Bins;
    /// 18 degrees: over a longer way the force is no straight line.
    static constexpr Scalar largest_step_rev = literal<Scalar>(0.05L);

    explicit RevolutionProfile(int revolutions = 1) : revolutions_(revolutions > 0 ? revolutions : 1) {}

    void restart() {
        started_ = false;
        clear();
    }

    /// `angle_rev` 0…1. Returns true when the wanted number of revolutions is whole: read the profile, then clear().
    /// Samples that follow belong to the next revolutions.
    bool add(Scalar angle_rev, Scalar dt_s, Scalar fx_N, Scalar fy_N) {
        Scalar turned_rev = angle_rev - previous_rev_;
        turned_rev += turned_rev < -half_rev ? Scalar(1) : Scalar(0);
        if (!started_ || !(turned_rev >= Scalar(0)) || turned_rev > largest_step_rev || !(dt_s > Scalar(0))) {
            start(angle_rev, fx_N, fy_N);
            return false;
        }
        turned_rev_ += turned_rev;
        duration_s_ += dt_s;
        fill_passed(angle_rev, turned_rev, fx_N, fy_N);
        remember(angle_rev, fx_N, fy_N);
        return filled_ >= revolutions_ * Bins;
    }

    void clear() {
        x_.fill(Scalar(0));
        y_.fill(Scalar(0));
        filled_ = 0;
        turned_rev_ = Scalar(0);
        duration_s_ = Scalar(0);
    }

    /// Mean force at grid point `bin`, any whole number: the profile repeats.
    [[nodiscard]] Scalar x_N(int bin) const { return x_[wrapped(bin)] / Scalar(revolutions_); }
    [[nodiscard]] Scalar y_N(int bin) const { return y_[wrapped(bin)] / Scalar(revolutions_); }
    [[nodiscard]] Scalar seconds_per_bin() const {
        return turned_rev_ > Scalar(0) ? duration_s_ / (turned_rev_ * Scalar(Bins)) : Scalar(0);
    }
    [[nodiscard]] int revolutions() const { return revolutions_; }

  private:
    static constexpr Scalar half_rev = Scalar(0.5F);

    static std::size_t wrapped(int bin) {
        const int rest = bin % Bins;
        return static_cast<std::size_t>(rest < 0 ? rest + Bins : rest);
    }

    void start(Scalar angle_rev, Scalar fx_N, Scalar fy_N) {
        clear();
        started_ = true;
        next_bin_ = static_cast<int>(angle_rev * Scalar(Bins)) + 1;
        remember(angle_rev, fx_N, fy_N);
    }

    void remember(Scalar angle_rev, Scalar fx_N, Scalar fy_N) {
        previous_rev_ = angle_rev;
        previous_x_N_ = fx_N;
        previous_y_N_ = fy_N;
    }

    /// Grid points are counted on, so that rounding can neither lose one nor fill it twice.
    void fill_passed(Scalar angle_rev, Scalar turned_rev, Scalar fx_N, Scalar fy_N) {
        Scalar behind = angle_rev * Scalar(Bins) - Scalar(wrapped(next_bin_));  // how far the grid point lies behind
        behind += behind < -half_rev * Scalar(Bins) ? Scalar(Bins) : Scalar(0);
        behind -= behind > half_rev * Scalar(Bins) ? Scalar(Bins) : Scalar(0);
        const Scalar step = turned_rev * Scalar(Bins);
        for (; behind >= Scalar(0) && step > Scalar(0); behind -= Scalar(1), ++next_bin_) {
            const Scalar share = behind < step ? Scalar(1) - behind / step : Scalar(0);
            const std::size_t bin = wrapped(next_bin_);
            x_[bin] += previous_x_N_ + (fx_N - previous_x_N_) * share;
            y_[bin] += previous_y_N_ + (fy_N - previous_y_N_) * share;
            ++filled_;
        }
        next_bin_ = static_cast<int>(wrapped(next_bin_));
    }

    int revolutions_;
    std::array<Scalar, static_cast<std::size_t>(Bins)> x_{};
    std::array<Scalar, static_cast<std::size_t>(Bins)> y_{};
    Scalar turned_rev_{0};
    Scalar duration_s_{0};
    Scalar previous_rev_{0};
    Scalar previous_x_N_{0};
    Scalar previous_y_N_{0};
    int next_bin_ = 0;
    int filled_ = 0;
    bool started_ = false;
};

}  // namespace millforce::estimation
