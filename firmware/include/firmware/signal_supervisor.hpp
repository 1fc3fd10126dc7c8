// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "control/cut_state.hpp"
#include "estimation/cut_estimate.hpp"
#include "firmware/commanded_speed.hpp"
#include "firmware/feed_force_leap.hpp"
#include "firmware/parameters.hpp"
#include "firmware/stuck_signal.hpp"
#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"

/// Compares the machine's signals with each other and with physics. It knows nothing of the engagement and does not
/// trust the estimate of it. What it finds is a fault:
///
///   stale_input        the samples' time stands or runs backwards: 32 samples
///   encoder_mismatch   counts between two index pulses are not one revolution: three in a row;
///                      the spindle's speed changes by 40 % within one revolution of a cut, or grows anywhere by more
///                      than 20,000 rad/s²: its encoder, or the samples' clock, has failed. Two teeth on end. In a
///                      feed move: it turns evenly, and not at the commanded speed (commanded_speed.hpp)
///   signal_stuck       the current of a turning spindle, or in a cut of a moving axis, stands (stuck_signal.hpp);
///                      a load that comes seldom does not answer the feed (load_answer.hpp)
///   force_vanished     F_at falls within two teeth by more than a cut that ends can fall
///   force_jumped       F_x or F_y changes within two teeth by more than that, or the force along the feed from one
///                      revolution to the next but one while F_at stays (feed_force_leap.hpp)
///   forces_contradict  out of the cut the axes carry more than twice the F_at that the spindle's current leaves open:
///                      3 revolutions
///   idle_torque        re-zeroing in air found the idle torque beyond its stated deviation, for 10 revolutions on end.
///                      In a feed move only where it is too small: too large, it may be a light cut
///   negative_torque    F_at below zero by twice the contact level in a feed move, by the idle torque of the last rapid
///                      or rest: 3 revolutions, or in the mean of 16, whose noise is smaller
///   contact_in_rapid   F_at above twice the contact level in a rapid move: 3 revolutions, once a late load is of that
///                      move
///   feed_mismatch      the axes move at more than 1.5 times the programmed feed with the largest override, for longer
///                      than the CNC takes to react and 0.15 s. Whether it follows the override is not judged: a
///                      recording may have been made without one.
///
/// How fast a cut can end: a straight edge of the workpiece, met head-on, takes from a slot in s of travel the chord
/// 2√(2 R s), so of its width 2R the share
///
///     √(2 s/R)
///
/// A narrower cut, or an edge at an angle, ends more slowly. The bound is 1.5 times that share, and six standard
/// deviations of noise. A load that is told once in load_period_s shows at once what the cut changed by since the last
/// one: s then includes the travel in that time, and four deviations are enough: it has fewer noises to err by. Where
/// the feed changes in the revolution before or after, or before a late load was measured, or the tool moves along its
/// axis, the force may follow from that, and nothing is judged; but where the feed has changed by less than three
/// tenths from revolution to revolution, F_at cannot fall by much more than that: it is judged with the share 0.3
/// added. Nor is it in the 0.2 mm after a sharp turn or a fall to less than half the feed: tool and machine were bent
/// by the cut, and cut on while they spring back. Nor in state entry: a cut may begin with a whole tooth. A jump of an
/// axis must also exceed the inertia 0.2 m f n: an acceleration that a feed f which seems steady within a tenth may
/// hide in a revolution.
///
/// A slow change is not seen here. Where the axes' currents are known, the misfit of the cut's law keeps the feed from
/// rising (limit law_misfit).
///
/// Cost: some 30 instructions a sample, some 200 an estimate. No heap, no clock. One thread.

namespace millforce::firmware {

template <typename Scalar>
class SignalSupervisor {
  public:
    explicit SignalSupervisor(const Parameters<Scalar>& parameters);

    /// Each sample. `dt_s`: 0 where its time has not advanced.
    void take(const hal::DriveSample& sample, Scalar dt_s, control::CutState state);
    /// Each new estimate, with the program's status and the state of the last answer. `feed_is_settled`:
    /// settled_feed.hpp.
    void judge(const estimation::CutEstimate<Scalar>& e, const hal::ProgramStatus& program, control::CutState state,
               bool feed_is_settled);
    /// What re-zeroing in air says of the spindle, with each new estimate.
    void judge_idle(bool is_implausible, int tooth_periods);
    /// The spindle's load does not answer the feed (load_answer.hpp).
    void judge_load(bool is_dead);
    /// No average reaches over this moment.
    void restart();
    void reset();

    /// The first that was found since reset().
    [[nodiscard]] control::Fault fault() const { return fault_; }
    /// The fault may come from what was taken for air and was none: a rapid bit that is stuck calls a cut air.
    [[nodiscard]] bool doubts_idle() const {
        return fault_ == control::Fault::negative_torque || fault_ == control::Fault::contact_in_rapid ||
               fault_ == control::Fault::idle_torque;
    }

  private:
    using Estimate = estimation::CutEstimate<Scalar>;

    void find(control::Fault fault) { fault_ = fault_ == control::Fault::none ? fault : fault_; }
    void watch_clock(Scalar dt_s);
    void watch_index(const hal::DriveSample& sample);
    void watch_currents(const hal::DriveSample& sample, control::CutState state);
    void judge_teeth(const Estimate& e, control::CutState state, bool feed_is_settled);
    [[nodiscard]] bool is_speed_impossible(const Estimate& e, bool cuts);
    [[nodiscard]] bool gains_more_than_any_spindle(const Estimate& e, Scalar growth, Scalar ratio);
    struct SuddenChange {
        control::Fault fault = control::Fault::none;
        bool exceeds_the_feeds = false;  // a fall that a feed three tenths lower does not explain either
    };
    [[nodiscard]] SuddenChange sudden_change(const Estimate& e);
    void judge_revolution(const Estimate& e, const hal::ProgramStatus& program, control::CutState state,
                          bool feed_is_settled);
    [[nodiscard]] bool is_negative_in_the_mean(const estimation::Measurement<Scalar>& tangential_N, bool feeds);
    void judge_leap(const Estimate& e, control::CutState state);
    void judge_axes(const Estimate& e, bool rapid, control::CutState state);
    void judge_feed(const Estimate& e, const hal::ProgramStatus& program);
    void judge_speed(const Estimate& e, const hal::ProgramStatus& program);
    /// Since the estimate before.
    [[nodiscard]] Scalar elapsed_s(const Estimate& e) const;

    static constexpr Scalar significant = Scalar(6);  // standard deviations
    static constexpr Scalar significant_of_held_load = Scalar(4);
    static constexpr Scalar total_per_tangential =
        Scalar(2);                                   // the in-plane force is at most that much larger than F_at
    static constexpr std::uint8_t surely_turns = 3;  // revolutions in a row
    static constexpr float moving_mm_s = 1.0F;

    /// By how much a force changed within two estimates, beyond what it changes by in a revolution anyway; 0 where the
    /// two have different signs: the slower of both has the say.
    struct Jump {
        Scalar last{0};
        Scalar before{0};
        [[nodiscard]] Scalar follow(Scalar change) {
            const Scalar jump = change - before;
            before = last;
            last = change;
            const bool is_rise = change > Scalar(0) && jump > Scalar(0);
            const bool is_fall = change < Scalar(0) && jump < Scalar(0);
            const Scalar smaller = (jump < change) == is_rise ? jump : change;
            return is_rise || is_fall ? smaller : Scalar(0);
        }
    };

    Scalar teeth_;
    Scalar contact_force_N_;
    Scalar contact_significance_;
    Scalar override_max_;
    Scalar per_radius_;  // 1/R in 1/mm
    Scalar reaction_s_;
    Scalar per_acceleration_;
    Scalar load_period_s_;
    std::array<Scalar, 2> hidden_inertia_;  // N per mm/s of feed and rad/s of the spindle
    std::int32_t counts_per_rev_;

    control::Fault fault_ = control::Fault::none;
    std::uint8_t standing_samples_ = 0;
    std::uint8_t standing_counts_ = 0;
    std::uint32_t spindle_count_ = 0;
    std::uint32_t index_count_ = 0;
    std::uint8_t index_number_ = 0;
    std::uint8_t wrong_indices_ = 0;
    std::array<StuckSignal, 2> spindle_{};  // out of the cut, in the cut
    std::array<StuckSignal, 2> axes_{};     // x and y

    Jump tangential_{};
    std::array<Jump, 2> axis_jumps_{};
    int steady_periods_ = 0;         // tooth periods at an unchanged velocity
    int alike_periods_ = 0;          // at one that changes by less than three tenths
    Scalar spring_back_left_mm_{0};  // travel in which a bent tool may still cut where the path has turned

    /// A sudden change, until the velocity has stayed as it was for a revolution: a drive's current brakes before the
    /// axis slows down.
    class Suspicion {
      public:
        /// `periods`: at such a velocity. The fault that is certain now.
        [[nodiscard]] control::Fault follow(control::Fault sudden, int periods, bool is_steady, Scalar teeth) {
            if (fault_ == control::Fault::none) {
                fault_ = is_steady ? sudden : control::Fault::none;
                since_ = periods;
            } else if (!is_steady) {
                fault_ = control::Fault::none;
            } else if (Scalar(periods - since_) >= teeth) {
                return fault_;
            }
            return control::Fault::none;
        }

      private:
        control::Fault fault_ = control::Fault::none;
        int since_ = 0;
    };
    Suspicion steady_suspicion_{};
    Suspicion alike_suspicion_{};
    Suspicion leap_suspicion_{};
    int last_periods_ = 0;  // of the estimate before
    int periods_in_turn_ = 0;
    Scalar last_speed_rad_s_{0};
    Scalar last_speed_ratio_{1};  // of the tooth before
    Scalar speed_ratio_before_{1};
    int implausible_periods_ = 0;
    std::uint8_t negative_turns_ = 0;
    struct MeanOfFeed {
        Scalar mean_N{0};
        std::uint8_t turns = 0;
    };
    MeanOfFeed feed_torque_{};  // F_at of the revolutions in this feed move
    std::uint8_t rapid_turns_ = 0;
    std::uint8_t contradicting_turns_ = 0;
    std::uint8_t air_turns_ = 0;  // with a known feed force, at an unchanged velocity
    Scalar least_feed_force_N_{0};
    Scalar too_fast_s_{0};
    CommandedSpeed<Scalar> commanded_speed_{};
    FeedForceLeap<Scalar> feed_force_leap_;
};

}  // namespace millforce::firmware
