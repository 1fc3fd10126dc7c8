// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "control/feed_controller_data.hpp"
#include "control/way_ahead.hpp"
#include "estimation/number/fixed_point.hpp"

/// The feed by what lies ahead: from a map of the cut along the program's path.
///
/// The map is a row of stretches. For each it names, for the cutting law as the tool's file has it, the feed f_i at
/// which a tooth reaches its set point, the mean tangential force F_i at that feed, and per tangential force the
/// largest force τ_i of a mean tooth and the mean force along the feed χ_i = F_ax/F_at. Edge forces stay while the feed
/// falls: h_i is the share of F_i that falls with it, and e_i says by how much the feed must fall where the material is
/// harder:
///
///   F(f) = κ F_i [1 − h_i (1 − f/f_i)]
///   v_i  = max(f_i [1 − e_i (1 − 1/κ)] − (e − e_0) N n, f_i/N)
///
/// The set point is that of the tooth that stands out furthest. e_0 is the runout that the stretches were worked out
/// with, e the measured one (runout_meter.hpp): its tooth takes so much more of a chip. N teeth, n revolutions per
/// second; one tooth takes no more than the chips of all.
///
/// κ: how hard the material is, 1 as in the tool's file. Before the first cut assumed_hardness stands for it. For each
/// estimate in a cut the map gives the least and the most F at κ = 1 within its window and farthest_off_mm before and
/// behind it. Averaged over some ten estimates, with the noise σ of the averaged F_at:
///
///   F_at/F_most ≤ κ ≤ (F_at + σ)/F_least
///
/// κ changes only as far as these bounds ask; in a cut that stays the same they are σ apart. Where κ is below
/// lowest_hardness by 4 σ, the map is refuted. Where e exceeds the feed per tooth, teeth may miss the cut, and the
/// least F lacks their edge forces: f/(f + e N n) of the teeth cut at least, and one of them.
///
/// At every place the feed may then be v_i. What is asked for now acts a reaction time T later, and until then the tool
/// goes the pending way s. Its feed is u; p, the feed that it will have by then, follows what is asked for at the
/// machine's acceleration a:
///
///   ds/dt = p − u + [T (u + p)/2 − s]/T
///
/// (the last term leads back to a steady change of the feed where a CNC is slower than asked). The feed may be the
/// largest from which the machine then slows down to each v_i, d_i ahead:
///
///   v² = v_i² + 2 a (d_i − s)        v_i² where d_i is less than s        the lowest of all i
///
/// T is 1.4 times the reaction time that was told, so that it may be 0.7 to 1.2 times as long. Each stretch counts from
/// as far before its begin as the map may be off unseen until s/2, and no more than T u/2, has brought the tool as far
/// behind its end. That is farthest_off_mm, or, where the force comes late, half a millimetre more than the way of an
/// estimate's window: at 30 mm/s a load that is 0.2 s old shows no wall sooner than 6 mm behind it.
///
/// The map is used only after the forces have confirmed it. `known` becomes true once measured forces have agreed over
/// agreement_mm of cut: F_at within what the stretches around the tool may give, with κ between lowest_hardness
/// and highest_hardness, and within hardness_band of κ once that is measured; and F_ax within direction_band·F_at of
/// χ F_at, where it is measured: the direction of the force gives the arc, whatever the depth and the material. Both
/// with four standard deviations of the measurement beside. What disagrees over more than disagreement_mm, and in three
/// estimates in a row, refutes the map: `known` is false from then on, until restart(). So does contact, two estimates
/// in a row, where the map has air.
///
/// A stretch may be known to lie between least_share of its F_i and F_i: then the least and the most bound the force,
/// its direction is not asked for, and each millimetre counts as the share of the most that is sure. Where the tool
/// enters that is 0. Near a stretch that is not known at all `known` is false, and it is met at blind_feed_mm_s; it
/// neither confirms the map nor refutes it. What is known at most is met no slower than that, and so is every cut until
/// κ is measured: v_i is a guess there.
///
/// Use: restart() with each program, add() stretches in the order of the path while room() lasts, step() at each tick.
/// If the window runs empty, nothing is known of the path ahead: the feed has fallen to blind_feed_mm_s by then.
///
/// Units mm, mm/s, N. Positions along the path from the program's begin; for Fixed up to 2·10⁹. Anything not finite, or
/// a position that is not known, gives `known` false. Cost: some 10 operations for each stretch of the window and one
/// root. No heap. Not thread-safe.

namespace millforce::control {

/// A part of the path over which the cut stays much the same, to the next one's begin.
template <typename Scalar>
struct Stretch {
    Scalar begin_mm{0};
    Scalar feed_mm_s{0};             ///< f_i; in air the highest that makes sense
    Scalar tangential_N{0};          ///< F_i; 0: air
    Scalar tooth_per_tangential{0};  ///< τ_i
    Scalar feed_per_tangential{0};   ///< χ_i
    Scalar falling_share{1};         ///< h_i
    Scalar feed_per_softness{1};     ///< e_i; 1/(c q) for a force with the cutting share c and the exponent q
    Scalar least_share{1};           ///< of F_i that is surely there; 0: the tool may be in air
    bool is_known = true;            ///< false: nothing is known of this stretch

    /// The arc, and with it the direction of the force, is not known.
    [[nodiscard]] bool is_open() const { return !is_known || least_share < Scalar(1); }
};

template <typename Scalar>
struct FeedAheadSettings {
    Scalar acceleration_mm_s2{0};  ///< acceleration of the machine along the path; to be set, > 0
    Scalar reaction_s{0};          ///< time from an override to the first change of feed
    /// Of the path, each way: what a controller may tell wrongly of the tool's place. By how much the blank may lie off
    /// is for the map to say (preview).
    Scalar position_tolerance_mm = literal<Scalar>(0.3L);
    /// No map that is off by more goes on unrefuted: a light cut is seen some 1 mm behind its begin.
    Scalar farthest_off_mm{Scalar(1.5F)};
    Scalar assumed_hardness = literal<Scalar>(1.3L);
    /// Softer than that it is taken for a shallower cut, whose teeth carry more for the same mean force.
    Scalar lowest_hardness = literal<Scalar>(0.65L);
    Scalar highest_hardness{2};
    Scalar hardness_band{Scalar(1.25F)};  ///< ratio by which a force may differ from the map's with the measured κ
    Scalar direction_band = literal<Scalar>(0.2L);  ///< share of F_ax/F_at that the law's r_1 leaves open
    Scalar agreement_mm{1};
    Scalar disagreement_mm{Scalar(0.5F)};
};

/// What a tick knows.
template <typename Scalar>
struct FeedAheadStep {
    bool position_known = false;
    Scalar position_mm{0};         ///< along the path
    Scalar travel_mm{0};           ///< since the last step
    Scalar dt_s{0};                ///< since the last step
    Scalar feed_mm_s{0};           ///< u, the tool's along the path
    Scalar asked_feed_mm_s{0};     ///< what was asked for in the last step
    Scalar blind_feed_mm_s{0};     ///< feed that is safe where nothing is known
    Scalar tooth_share{1};         ///< 1/N
    Scalar runout_mm_s{0};         ///< e N n
    Scalar mapped_runout_mm_s{0};  ///< e_0 N n
    bool fresh = false;            ///< the rest is a new estimate
    Scalar tangential_N{0};        ///< F_at
    Scalar tangential_sd_N{0};
    Scalar mean_feed_mm_s{0};   ///< over the estimate's window
    Scalar window_mm{0};        ///< way gone in it, and since it where the force comes late
    Scalar contact_level_N{0};  ///< force from which on the tool counts as in contact
    bool feed_force_valid = false;
    Scalar feed_force_N{0};  ///< F_ax
    Scalar feed_force_sd_N{0};
};

/// The window of a chip that has a map over a bus.
inline constexpr std::size_t small_window = 64;

template <typename Scalar, std::size_t Capacity = 256>
class FeedAhead {
  public:
    using Step = FeedAheadStep<Scalar>;

    explicit FeedAhead(const FeedAheadSettings<Scalar>& settings);

    /// Another program, or the same from its begin: the window is empty, and nothing has agreed yet. κ is kept: the
    /// next part is of the same material.
    void restart();
    /// The window is empty, of the same map: what has agreed of it stays.
    void empty();

    [[nodiscard]] std::size_t room() const { return Capacity - count_; }
    /// False, and nothing is added, where there is no room or the stretch does not begin behind the last one.
    bool add(const Stretch<Scalar>& stretch);

    [[nodiscard]] WayAhead<Scalar> step(const Step& now);

    /// κ; 0 until a cut has told it to a tenth.
    [[nodiscard]] Scalar hardness() const { return is_hardness_measured_ ? hardness_ : Scalar(0); }
    [[nodiscard]] bool is_refuted() const { return is_refuted_; }

  private:
    struct Range {
        Scalar low{0};
        Scalar high{0};
        bool is_empty = true;

        void include(Scalar value) {
            low = is_empty || value < low ? value : low;
            high = is_empty || value > high ? value : high;
            is_empty = false;
        }
    };
    /// Of all stretches that an estimate's window, and a tolerance before and behind it, touch.
    struct Expected {
        Range tangential_N;  // at κ = 1
        Range direction;     // χ, of those that cut
        bool has_unknown = false;
        bool has_open = false;  // the arc, and with it the direction, is not known
    };
    /// Of the stretches within the window alone.
    struct Mapped {
        Scalar tooth_per_tangential{0};
        Scalar tangential_N{0};  // mean, at κ = 1
    };

    static constexpr Scalar significance{4};        // standard deviations
    static constexpr int enough_disagreements = 3;  // in a rapid one window is longer than disagreement_mm
    static constexpr int enough_estimates = 20;     // for the averages to have their noise, and no more

    [[nodiscard]] const Stretch<Scalar>& at(std::size_t i) const { return window_[(first_ + i) % Capacity]; }
    [[nodiscard]] Scalar end_mm(std::size_t i) const { return at(i + 1).begin_mm; }
    [[nodiscard]] static bool is_sound(const Step& now);
    void follow_feed(const Step& now);
    void drop_passed(Scalar behind_mm);
    void compare(const Step& now);
    [[nodiscard]] bool force_agrees(const Step& now, const Expected& expected) const;
    [[nodiscard]] bool direction_agrees(const Step& now, const Expected& expected) const;
    void measure_hardness(const Step& now, const Range& expected_N);
    [[nodiscard]] Expected expected_within(const Step& now, Scalar tolerance_mm) const;
    [[nodiscard]] Mapped mapped_within(const Step& now) const;
    template <typename Visit>
    void for_each_within(Scalar from_mm, Scalar to_mm, const Visit& visit) const;
    [[nodiscard]] bool is_near_unknown(Scalar position_mm) const;
    [[nodiscard]] Scalar feed_at(std::size_t i, const Step& now) const;
    [[nodiscard]] static Scalar cutting_teeth_share(const Step& now);
    [[nodiscard]] Scalar force_at(std::size_t i, Scalar feed_mm_s) const;
    [[nodiscard]] Scalar fastest_for(const Step& now) const;

    FeedAheadSettings<Scalar> settings_;
    std::array<Stretch<Scalar>, Capacity> window_{};
    std::size_t first_ = 0;
    std::size_t count_ = 0;
    Scalar latest_s_;                    // T
    Scalar coming_feed_mm_s_{0};         // p
    Scalar pending_mm_{0};               // s
    Scalar hardness_;                    // κ
    Scalar hardening_;                   // 1 − 1/κ
    bool is_hardness_measured_ = false;  // κ is known to a tenth
    Scalar measured_N_{0};               // averages of F_at,
    Scalar lowest_N_{0};                 // of the least at κ = 1 that the map may mean,
    Scalar highest_N_{0};                // and of the most
    int estimates_ = 0;                  // of this program in the averages
    Scalar agreed_mm_{0};
    Scalar disagreed_mm_{0};
    int disagreements_ = 0;  // estimates in a row
    Scalar since_estimate_mm_{0};
    Scalar off_unseen_mm_;  // by how much the map may be off before an estimate shows it
    Mapped mapped_;
    bool may_cut_ = false;
    bool touched_in_air_ = false;
    bool is_refuted_ = false;
};

extern template class FeedAhead<float>;
extern template class FeedAhead<estimation::Fixed>;
extern template class FeedAhead<float, small_window>;
extern template class FeedAhead<estimation::Fixed, small_window>;

}  // namespace millforce::control
