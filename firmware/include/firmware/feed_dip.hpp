// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "estimation/cut_estimate.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::firmware {

/// Whether the force along the feed F_ax answers a dip of the feed as the spindle's force F_at does.
///
/// Cutting forces follow the feed, what a current has drifted by does not. The feed falls to 0.7 of what it was and
/// rises again, and of means of 8 estimates before (1), within (2) and after (3) the dip
///
///   F = (F₁ + F₃)/2,    s = (F_at − F_at,2)/F_at,    d = F_ax − (F_ax − F_ax,2)/s
///
/// The mean of before and after leaves out what grows steadily meanwhile. d is the drift of the force along the feed,
/// as long as both forces follow the feed by the same power. Edge forces differ, so up to 0.15 F_at counts as none.
///
///   alike    |d| < 0.15 F_at, and the standard deviation of d is smaller, too
///   unlike   otherwise, or where no dip has succeeded within 120 estimates
///
/// A dip that changes F_at by less than 5 %, as where the cut changes meanwhile, is made again.
///
/// Cost: some 10 operations an estimate while it asks, two divisions and a root at its end. No heap. One thread.
template <typename Scalar>
class FeedDip {
  public:
    enum class Answer : std::uint8_t { none, alike, unlike };

    void stop() { *this = FeedDip(); }
    void ask(Scalar feed_mm_s) {
        stop();
        feed_mm_s_ = feed_mm_s;
    }
    [[nodiscard]] bool is_asking() const { return feed_mm_s_ > Scalar(0); }
    /// That the feed may have; 0: none.
    [[nodiscard]] Scalar bound_mm_s() const {
        return stage_ == Stage::within ? feed_mm_s_ * estimation::literal<Scalar>(0.7L) : feed_mm_s_;
    }

    /// A new estimate in the cut, while it asks. Without one of the forces the question ends without an answer.
    Answer follow(const estimation::CutEstimate<Scalar>& e) {
        if (!e.tangential_N.valid || !e.feed_N.valid) {
            stop();
            return Answer::none;
        }
        if (++estimates_ > patience) {
            stop();
            return Answer::unlike;
        }
        if (is_waiting(e) || !add(e)) {
            return Answer::none;
        }
        waited_ = steady_ = counted_ = 0;
        if (stage_ != Stage::after) {
            stage_ = stage_ == Stage::before ? Stage::within : Stage::after;
            return Answer::none;
        }
        return end(e);
    }

  private:
    enum class Stage : std::uint8_t { before, within, after };
    struct Forces {
        Scalar spindle_N{0};
        Scalar axes_N{0};
    };

    static constexpr std::uint8_t patience = 120;
    static constexpr std::uint8_t latency = 6;  // estimates, of CNC and axes
    static constexpr std::uint8_t settled = 3;
    static constexpr std::uint8_t block = 8;

    /// For the feed to have changed, and to be steady again. After the dip it may not rise, where the force is at its
    /// set point: no longer than `latency`.
    [[nodiscard]] bool is_waiting(const estimation::CutEstimate<Scalar>& e) {
        constexpr Scalar steady_share = estimation::literal<Scalar>(0.03L);
        constexpr Scalar dipped_share = estimation::literal<Scalar>(0.9L);
        constexpr Scalar risen_share = estimation::literal<Scalar>(0.8L);
        if (stage_ == Stage::before || counted_ > 0) {
            return false;
        }
        const Scalar rise_mm_s = e.feed_mm_s - last_feed_mm_s_;
        last_feed_mm_s_ = e.feed_mm_s;
        const Scalar little_mm_s = steady_share * e.feed_mm_s;
        waited_ = static_cast<std::uint8_t>(waited_ + 1);
        const bool has_changed = stage_ == Stage::within ? e.feed_mm_s < dipped_share * feed_mm_s_
                                                         : e.feed_mm_s > risen_share * feed_mm_s_ || waited_ > latency;
        const bool is_steady = rise_mm_s < little_mm_s && -rise_mm_s < little_mm_s;
        steady_ = static_cast<std::uint8_t>(has_changed && is_steady ? steady_ + 1 : 0);
        return steady_ < settled;
    }

    /// Whether the block is whole.
    [[nodiscard]] bool add(const estimation::CutEstimate<Scalar>& e) {
        const bool is_within = stage_ == Stage::within;
        Forces& mean = is_within ? within_ : around_;
        const Scalar share(is_within ? 1.0F / block : 0.5F / block);
        mean.spindle_N += e.tangential_N.value * share;
        mean.axes_N += e.feed_N.value * share;
        return ++counted_ == block;
    }

    [[nodiscard]] Answer end(const estimation::CutEstimate<Scalar>& e) {
        using std::sqrt;
        constexpr Scalar least_answer = estimation::literal<Scalar>(0.05L);
        constexpr Scalar tolerated_share = estimation::literal<Scalar>(0.15L);
        constexpr Scalar noise_of_means = estimation::literal<Scalar>(0.43L);  // √(3/2 / block)
        const Scalar s = (around_.spindle_N - within_.spindle_N) / around_.spindle_N;
        if (!(s > least_answer)) {
            const std::uint8_t so_far = estimates_;
            ask(e.feed_mm_s);
            estimates_ = so_far;
            return Answer::none;
        }
        const Scalar off_N = around_.axes_N - within_.axes_N - s * around_.axes_N;
        const Scalar tolerated_N = tolerated_share * s * around_.spindle_N;
        const Scalar axes_noise_N2 = e.x_N.noise > e.y_N.noise ? e.x_N.noise : e.y_N.noise;
        const bool is_clear = noise_of_means * sqrt(axes_noise_N2) < tolerated_N;
        stop();
        return is_clear && off_N < tolerated_N && -off_N < tolerated_N ? Answer::alike : Answer::unlike;
    }

    Stage stage_ = Stage::before;
    std::uint8_t estimates_ = 0;  // since the question
    std::uint8_t waited_ = 0;     // since the bound changed
    std::uint8_t steady_ = 0;     // of these
    std::uint8_t counted_ = 0;    // in the present block
    Scalar feed_mm_s_{0};         // before the dip; 0: does not ask
    Scalar last_feed_mm_s_{0};
    Forces around_{};
    Forces within_{};
};

}  // namespace millforce::firmware
