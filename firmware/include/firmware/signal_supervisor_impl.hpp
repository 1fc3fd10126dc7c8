// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of signal_supervisor.hpp. Only src/signal_supervisor.cpp includes them.

#include <algorithm>
#include <cmath>

#include "control/feed_controller_data.hpp"
#include "firmware/signal_supervisor.hpp"
#include "hal/finite.hpp"

namespace millforce::firmware {

/// Counts up while `is_so`, and forgets otherwise. True where it is the n-th time in a row.
inline bool is_so_in_a_row(std::uint8_t& count, bool is_so, std::uint8_t n) {
    const bool has_room = count < n;
    count = static_cast<std::uint8_t>(is_so ? (has_room ? count + 1 : count) : 0);
    return count == n;
}

/// A feed that differs by less than a tenth between two revolutions may hide an acceleration of 0.2 f n, and with it
/// the axis' inertia.
template <typename Scalar>
static std::array<Scalar, 2> hidden_inertia(const MachineParameters<Scalar>& machine) {
    constexpr Scalar share_m_per_mm = estimation::literal<Scalar>(0.0002L);
    const Scalar per_kg = share_m_per_mm * estimation::turns_per_rad<Scalar>;
    return {machine.axes[0].mass_kg * per_kg, machine.axes[1].mass_kg * per_kg};
}

template <typename Scalar>
SignalSupervisor<Scalar>::SignalSupervisor(const Parameters<Scalar>& p)
    : teeth_(Scalar(p.tool.teeth)),
      contact_force_N_(p.tool.control.contact_force_N),
      contact_significance_(p.tool.control.contact_significance),
      override_max_(p.machine.cnc.override_max),
      per_radius_(p.tool.diameter_mm > Scalar(0) ? Scalar(2) / p.tool.diameter_mm : Scalar(0)),
      reaction_s_(reaction_s(p.machine)),
      per_acceleration_(p.machine.cnc.acceleration_mm_s2 > Scalar(0) ? Scalar(1) / p.machine.cnc.acceleration_mm_s2
                                                                     : Scalar(0)),
      load_period_s_(p.machine.spindle_load_period_s),
      hidden_inertia_(hidden_inertia(p.machine)),
      counts_per_rev_(static_cast<std::int32_t>(p.machine.encoder_counts_per_rev)),
      feed_force_leap_(teeth_, per_radius_, std::max(hidden_inertia_[0], hidden_inertia_[1])) {}

template <typename Scalar>
void SignalSupervisor<Scalar>::restart() {
    tangential_ = {};
    axis_jumps_ = {};
    steady_suspicion_ = alike_suspicion_ = leap_suspicion_ = {};
    steady_periods_ = alike_periods_ = 0;
    periods_in_turn_ = 0;
    last_speed_rad_s_ = Scalar(0);
    last_speed_ratio_ = speed_ratio_before_ = Scalar(1);
    negative_turns_ = rapid_turns_ = contradicting_turns_ = air_turns_ = 0;
    feed_torque_ = {};
    too_fast_s_ = Scalar(0);
    commanded_speed_.restart();
    feed_force_leap_.restart();
}

template <typename Scalar>
void SignalSupervisor<Scalar>::reset() {
    fault_ = control::Fault::none;
    standing_samples_ = 0;
    wrong_indices_ = 0;
    for (std::array<StuckSignal, 2>* signals : {&spindle_, &axes_}) {
        for (StuckSignal& signal : *signals) {
            signal.pause();
        }
    }
    implausible_periods_ = 0;
    restart();
}

// Each sample

template <typename Scalar>
void SignalSupervisor<Scalar>::take(const hal::DriveSample& sample, Scalar dt_s, control::CutState state) {
    watch_clock(dt_s);
    watch_index(sample);
    watch_currents(sample, state);
}

template <typename Scalar>
void SignalSupervisor<Scalar>::watch_clock(Scalar dt_s) {
    constexpr std::uint8_t surely_stands = 32;
    if (is_so_in_a_row(standing_samples_, !(dt_s > Scalar(0)), surely_stands)) {
        find(control::Fault::stale_input);
    }
}

/// A spindle that turns back counts as well; where it turns round, one interval is of any length.
template <typename Scalar>
void SignalSupervisor<Scalar>::watch_index(const hal::DriveSample& sample) {
    constexpr std::uint8_t surely_wrong = 3;
    constexpr std::uint32_t tolerances_per_rev = 8;
    if ((sample.present & hal::mask(hal::Present::spindle_count)) == 0 ||
        sample.spindle_index_number == index_number_) {
        return;
    }
    const bool is_next =
        static_cast<std::uint8_t>(sample.spindle_index_number - index_number_) == 1 && index_number_ != 0;
    const std::uint32_t forwards = sample.spindle_index_count - index_count_;
    const std::uint32_t turned = std::min(forwards, 0U - forwards);  // either way round
    const auto per_rev = static_cast<std::uint32_t>(counts_per_rev_);
    const std::uint32_t tolerance = per_rev / tolerances_per_rev;
    const bool is_off = turned > per_rev + tolerance || turned < per_rev - tolerance;
    index_number_ = sample.spindle_index_number;
    index_count_ = sample.spindle_index_count;
    if (is_so_in_a_row(wrong_indices_, is_next && is_off, surely_wrong)) {
        find(control::Fault::encoder_mismatch);
    }
}

template <typename Scalar>
void SignalSupervisor<Scalar>::watch_currents(const hal::DriveSample& sample, control::CutState state) {
    constexpr std::uint8_t surely_stands = 20;
    const bool cuts = control::is_cutting(state);
    // A spindle that stands may show one current for ever: its drive is off.
    const bool stands = is_so_in_a_row(standing_counts_, sample.spindle_count == spindle_count_, surely_stands);
    spindle_count_ = sample.spindle_count;
    const bool has_turned = last_speed_rad_s_ > Scalar(0) && !stands;
    const bool has_spindle = (sample.present & hal::mask(hal::Present::spindle_current)) != 0 && has_turned;
    // Until the first cut has taught how the current varies in a cut, it must vary as it does in air.
    if (has_spindle && cuts && !spindle_[1].has_learnt()) {
        spindle_[0].watch(sample.spindle_current_A);
    } else {
        spindle_[0].follow(sample.spindle_current_A, has_spindle && !cuts);
    }
    spindle_[1].follow(sample.spindle_current_A, has_spindle && cuts);
    bool any_is_stuck = spindle_[0].is_stuck() || spindle_[1].is_stuck();
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        const bool moves = !hal::is_smaller(sample.axis_velocity_mm_s[k], moving_mm_s);
        axes_[k].follow(sample.axis_current_A[k], cuts && moves && (sample.present & hal::axis_mask(k)) != 0);
        any_is_stuck = any_is_stuck || axes_[k].is_stuck();
    }
    if (any_is_stuck) {
        find(control::Fault::signal_stuck);
    }
}

// Each estimate

template <typename Scalar>
void SignalSupervisor<Scalar>::judge(const Estimate& e, const hal::ProgramStatus& program, control::CutState state,
                                     bool feed_is_settled) {
    judge_teeth(e, state, feed_is_settled);
    judge_feed(e, program);
    judge_speed(e, program);
    periods_in_turn_ += e.tooth_periods;
    if (Scalar(periods_in_turn_) >= teeth_) {
        periods_in_turn_ = 0;
        judge_revolution(e, program, state, feed_is_settled);
    }
}

template <typename Scalar>
void SignalSupervisor<Scalar>::judge_idle(bool is_implausible, int tooth_periods) {
    constexpr Scalar turns = Scalar(10);
    implausible_periods_ = is_implausible ? implausible_periods_ + tooth_periods : 0;
    if (Scalar(implausible_periods_) > turns * teeth_) {
        find(control::Fault::idle_torque);
    }
}

template <typename Scalar>
void SignalSupervisor<Scalar>::judge_load(bool is_dead) {
    if (is_dead) {
        find(control::Fault::signal_stuck);
    }
}

template <typename Scalar>
void SignalSupervisor<Scalar>::judge_teeth(const Estimate& e, control::CutState state, bool feed_is_settled) {
    using estimation::literal;
    using estimation::square;
    constexpr Scalar level_share = literal<Scalar>(0.05L);  // of the feed: a slower change of height is no ramp
    constexpr Scalar more_periods = Scalar(3);  // than a revolution: the filters have forgotten the last change
    constexpr Scalar spring_back_mm = literal<Scalar>(0.2L);
    const typename Estimate::ToothChange& change = e.tooth_change;
    const bool is_level = square(e.axial_speed_mm_s) < square(level_share * e.feed_mm_s);
    const bool is_known = feed_is_settled && is_level;
    steady_periods_ = change.feed_is_steady && is_known ? steady_periods_ + e.tooth_periods : 0;
    alike_periods_ = change.feed_is_alike && is_known ? alike_periods_ + e.tooth_periods : 0;
    const Scalar travel_mm = e.feed_per_tooth_mm * Scalar(e.tooth_periods);
    spring_back_left_mm_ = change.feed_is_new ? spring_back_mm : spring_back_left_mm_ - travel_mm;
    const SuddenChange sudden = sudden_change(e);
    const bool cuts = control::is_cutting(state);
    if (is_speed_impossible(e, cuts)) {
        find(control::Fault::encoder_mismatch);
    }
    const bool has_entered = cuts && state != control::CutState::entry;  // a cut may begin with a whole tooth
    const auto suspect = [&](Suspicion& suspicion, bool is_sudden, int periods) {
        const bool is_steady = Scalar(periods) > teeth_ + more_periods && !(spring_back_left_mm_ > Scalar(0));
        find(suspicion.follow(has_entered && is_sudden ? sudden.fault : control::Fault::none, periods, is_steady,
                              teeth_));
    };
    suspect(steady_suspicion_, true, steady_periods_);
    suspect(alike_suspicion_, sudden.exceeds_the_feeds, alike_periods_);
}

/// In two teeth on end: a sample with a wrong time makes one tooth alone seem short, and the next one long.
template <typename Scalar>
bool SignalSupervisor<Scalar>::is_speed_impossible(const Estimate& e, bool cuts) {
    constexpr Scalar fastest_change = estimation::literal<Scalar>(1.4L);
    const Scalar ratio = e.tooth_change.speed_ratio;
    const Scalar smaller = ratio < last_speed_ratio_ ? ratio : last_speed_ratio_;
    const Scalar larger = ratio < last_speed_ratio_ ? last_speed_ratio_ : ratio;
    const Scalar growth = smaller - (speed_ratio_before_ > Scalar(1) ? speed_ratio_before_ : Scalar(1));
    speed_ratio_before_ = last_speed_ratio_;
    last_speed_ratio_ = ratio;
    const bool is_sudden = smaller > fastest_change || larger * fastest_change < Scalar(1);
    return (cuts && is_sudden) || gains_more_than_any_spindle(e, growth, smaller);
}

/// By `growth` to `ratio` times an earlier speed within two teeth. Three times what the quickest tapping spindles do,
/// from rest to 10,000/min in 0.15 s.
template <typename Scalar>
bool SignalSupervisor<Scalar>::gains_more_than_any_spindle(const Estimate& e, Scalar growth, Scalar ratio) {
    constexpr Scalar most_rad_s2 = Scalar(20000);
    constexpr Scalar least_share = estimation::literal<Scalar>(0.2L);
    if (!(growth > least_share * ratio)) {
        return false;
    }
    const Scalar tooth_s = elapsed_s(e);
    return e.spindle_speed_rad_s * (growth / ratio) > most_rad_s2 * (tooth_s + tooth_s);
}

/// A change that no cut makes from one tooth to the next but one; none where that cannot be judged.
template <typename Scalar>
typename SignalSupervisor<Scalar>::SuddenChange SignalSupervisor<Scalar>::sudden_change(const Estimate& e) {
    using estimation::square;
    using std::sqrt;
    constexpr Scalar bound = Scalar(1.5F);
    constexpr Scalar feeds_share = estimation::literal<Scalar>(0.3L);
    const typename Estimate::ToothChange& change = e.tooth_change;
    const Scalar tangential_N = tangential_.follow(change.tangential_N.value);
    const std::array<Scalar, 2> axis_N{axis_jumps_[0].follow(change.axis_N[0].value),
                                       axis_jumps_[1].follow(change.axis_N[1].value)};
    const Scalar travel_mm =
        e.feed_per_tooth_mm * Scalar(e.tooth_periods + last_periods_ + 1) + e.feed_mm_s * load_period_s_;
    last_periods_ = e.tooth_periods;
    const Scalar share = bound * sqrt(Scalar(2) * travel_mm * per_radius_);
    const Scalar now_N = e.tooth_tangential_N.value;
    const Scalar before_N = now_N - change.tangential_N.value;
    if (!change.tangential_N.valid || !(share < Scalar(1)) || !(before_N > Scalar(0))) {
        return {};
    }
    const auto is_beyond_noise = [](Scalar excess_N, Scalar variances, const estimation::Measurement<Scalar>& m) {
        return excess_N > Scalar(0) && square(excess_N) > variances * m.variance;
    };
    constexpr Scalar by_jump = Scalar(2) * square(significant);  // the difference of two changes
    // A load that is held does not change at all before it does, and has one noise in load_period_s.
    const Scalar by_fall = load_period_s_ > Scalar(0) ? square(significant_of_held_load) : by_jump;
    const Scalar vanished_N = -tangential_N - share * before_N;
    if (is_beyond_noise(vanished_N, by_fall, change.tangential_N)) {
        return {control::Fault::force_vanished,
                is_beyond_noise(vanished_N - feeds_share * before_N, by_fall, change.tangential_N)};
    }
    const Scalar larger_N = now_N > before_N ? now_N : before_N;  // a cut begins as fast as it ends
    const Scalar most_N = share * total_per_tangential * larger_N;
    for (std::size_t k = 0; k < axis_N.size(); ++k) {
        const Scalar jump_N = axis_N[k] < Scalar(0) ? -axis_N[k] : axis_N[k];
        const Scalar hidden_N = hidden_inertia_[k] * e.feed_mm_s * e.spindle_speed_rad_s;
        if (change.axis_N[k].valid && is_beyond_noise(jump_N - most_N - hidden_N, by_jump, change.axis_N[k])) {
            return {control::Fault::force_jumped, false};
        }
    }
    return {};
}

template <typename Scalar>
void SignalSupervisor<Scalar>::judge_revolution(const Estimate& e, const hal::ProgramStatus& program,
                                                control::CutState state, bool feed_is_settled) {
    using std::sqrt;
    constexpr Scalar steady_share = estimation::literal<Scalar>(0.003L);
    const Scalar change = e.spindle_speed_rad_s - last_speed_rad_s_;
    const Scalar most = steady_share * e.spindle_speed_rad_s;
    const bool turns_evenly = change < most && -change < most;
    last_speed_rad_s_ = e.spindle_speed_rad_s;
    if (!e.tangential_N.valid || !turns_evenly || !feed_is_settled) {
        negative_turns_ = rapid_turns_ = 0;
        feed_torque_ = {};
    } else {
        const Scalar level_N = Scalar(2) * control::contact_level_N(contact_force_N_, contact_significance_,
                                                                    sqrt(e.tangential_N.variance));
        // After a move the spindle may be switched off: its drive brakes, or its current falls before its speed does.
        const bool feeds = e.feed_mm_s > Scalar(moving_mm_s) && !program.rapid;
        // Below zero by what a light cut has taught of the idle torque: air, and no wrong signal.
        estimation::Measurement<Scalar> by_certain_idle_N = e.tangential_N;
        by_certain_idle_N.value += e.uncertain_idle_N;
        if (is_so_in_a_row(negative_turns_, feeds && -by_certain_idle_N.value > level_N, surely_turns) ||
            is_negative_in_the_mean(by_certain_idle_N, feeds)) {
            find(control::Fault::negative_torque);
        }
        if (is_so_in_a_row(rapid_turns_, program.rapid && e.tangential_N.value > level_N, surely_turns)) {
            find(control::Fault::contact_in_rapid);
        }
    }
    judge_leap(e, state);
    judge_axes(e, program.rapid, state);
}

/// A load that is late belongs to an earlier revolution.
template <typename Scalar>
void SignalSupervisor<Scalar>::judge_leap(const Estimate& e, control::CutState state) {
    const bool is_steady = Scalar(steady_periods_) > teeth_;
    if (!is_steady || load_period_s_ > Scalar(0)) {
        feed_force_leap_.restart();
    }
    const bool leaps = feed_force_leap_.follow(e) && control::is_cutting(state);
    find(leap_suspicion_.follow(leaps ? control::Fault::force_jumped : control::Fault::none, steady_periods_, is_steady,
                                teeth_));
}

/// The mean of many revolutions has less noise than each of them.
template <typename Scalar>
bool SignalSupervisor<Scalar>::is_negative_in_the_mean(const estimation::Measurement<Scalar>& tangential_N,
                                                       bool feeds) {
    using estimation::square;
    constexpr std::uint8_t block = 16;
    constexpr Scalar share = Scalar(1.0F / block);
    if (!feeds) {
        feed_torque_ = {};
        return false;
    }
    feed_torque_.mean_N += share * tangential_N.value;
    if (++feed_torque_.turns < block) {
        return false;
    }
    const Scalar below_zero_N = -feed_torque_.mean_N;
    feed_torque_ = {};
    const Scalar variance_N2 = tangential_N.variance - tangential_N.noise + share * tangential_N.noise;
    return below_zero_N > Scalar(2) * contact_force_N_ &&
           square(below_zero_N) > square(Scalar(2) * contact_significance_) * variance_N2;
}

/// In air the least feed force of this straight move is what its friction leaves.
template <typename Scalar>
void SignalSupervisor<Scalar>::judge_axes(const Estimate& e, bool rapid, control::CutState state) {
    using estimation::halved;
    using std::sqrt;
    constexpr std::uint8_t enough_turns = 4;
    const bool is_steady = Scalar(steady_periods_) > teeth_ && e.tangential_N.valid;
    if (rapid || !is_steady || !control::is_out_of_cut(state)) {
        contradicting_turns_ = air_turns_ = 0;
        return;
    }
    const Scalar force_N = e.feed_N.value < Scalar(0) ? -e.feed_N.value : e.feed_N.value;
    const Scalar by_spindle_N = e.tangential_N.value + halved(significant) * sqrt(e.tangential_N.variance);
    const Scalar explained_N = by_spindle_N > Scalar(0) ? total_per_tangential * by_spindle_N : Scalar(0);
    const Scalar level_N = significant * sqrt(e.feed_N.variance) + explained_N;
    const bool has_base = air_turns_ >= enough_turns;
    bool contradicts = false;
    if (e.feed_N.valid) {
        least_feed_force_N_ = air_turns_ == 0 || force_N < least_feed_force_N_ ? force_N : least_feed_force_N_;
        air_turns_ = has_base ? air_turns_ : static_cast<std::uint8_t>(air_turns_ + 1);
        const Scalar base_N = state == control::CutState::exit ? Scalar(0) : least_feed_force_N_;
        contradicts = force_N - base_N > level_N;
    } else {
        contradicts = has_base && e.axis_is_implausible;  // its friction was plausible in this very move
    }
    if (is_so_in_a_row(contradicting_turns_, contradicts, surely_turns)) {
        find(control::Fault::forces_contradict);
    }
}

template <typename Scalar>
void SignalSupervisor<Scalar>::judge_feed(const Estimate& e, const hal::ProgramStatus& program) {
    constexpr Scalar patience_s = estimation::literal<Scalar>(0.15L);
    constexpr Scalar largest_ratio = Scalar(1.5F);
    const Scalar F_mm_s = Scalar(program.programmed_feed_mm_s);
    const bool is_known = F_mm_s > Scalar(0) && !program.rapid;
    const bool is_too_fast =
        is_known && control::is_faster_than_programmed(e.feed_mm_s, F_mm_s, override_max_, largest_ratio);
    if (!is_too_fast) {
        too_fast_s_ = Scalar(0);
        return;
    }
    too_fast_s_ += elapsed_s(e);
    if (too_fast_s_ > reaction_s_ + patience_s + e.feed_mm_s * per_acceleration_) {
        find(control::Fault::feed_mismatch);
    }
}

template <typename Scalar>
void SignalSupervisor<Scalar>::judge_speed(const Estimate& e, const hal::ProgramStatus& program) {
    const Scalar commanded_rad_s = Scalar(program.commanded_speed_rad_s);
    if (!(commanded_rad_s > Scalar(0))) {
        commanded_speed_.restart();
        return;
    }
    const bool is_missed = commanded_speed_.is_missed(commanded_rad_s, e.spindle_speed_rad_s, elapsed_s(e));
    if (is_missed && e.feed_mm_s > Scalar(moving_mm_s) && !program.rapid) {
        find(control::Fault::encoder_mismatch);
    }
}

template <typename Scalar>
Scalar SignalSupervisor<Scalar>::elapsed_s(const Estimate& e) const {
    return control::tooth_period_s(teeth_, e.spindle_speed_rad_s) * Scalar(e.tooth_periods);
}

}  // namespace millforce::firmware
