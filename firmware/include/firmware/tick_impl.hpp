// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "estimation/engagement/side_choice.hpp"
#include "firmware/carried_immersion_impl.hpp"
#include "firmware/drift_doubt_impl.hpp"
#include "firmware/surface_monitor_impl.hpp"
#include "firmware/tick.hpp"
#include "firmware/usable_signals.hpp"

namespace millforce::firmware {

/// The spindle's torque that counts as contact: the idle one, and contact_force_N at the cutter's radius.
template <typename Scalar>
static Scalar contact_torque_Nm(const Parameters<Scalar>& p) {
    constexpr Scalar m_per_mm = estimation::literal<Scalar>(0.001L);
    const Scalar radius_m = estimation::halved(p.tool.diameter_mm) * m_per_mm;
    return p.tool.control.contact_force_N * radius_m - p.machine.spindle.K_t2_Nm;
}

template <typename Scalar, typename WideBand>
ForceControlTick<Scalar, WideBand>::ForceControlTick(const Parameters<Scalar>& parameters)
    : estimator_(estimator_settings(parameters), spindle_parameters(parameters.machine), parameters.machine.axes,
                 estimator_law(parameters.tool)),
      wide_band_(parameters),
      drift_doubt_(parameters),
      load_answer_(parameters),
      surface_(parameters.tool),
      supervisor_(parameters),
      controller_(controller_parameters(parameters)),
      reaction_s_(reaction_s(parameters.machine)),
      K_t1_Nm_per_A_(parameters.machine.spindle.K_t1_Nm_per_A),
      contact_torque_Nm_(contact_torque_Nm(parameters)),
      settled_feed_(load_delay_s(parameters.machine)) {}

/// Over the window, or over the last tooth period alone where that is larger. One that is not valid is 0, and so is its
/// variance.
template <typename Scalar>
static const estimation::Measurement<Scalar>& newest_tangential(const estimation::CutEstimate<Scalar>& e) {
    return e.tooth_tangential_N.value > e.tangential_N.value ? e.tooth_tangential_N : e.tangential_N;
}

/// The sign of a cut: the newest force, or that of the last revolutions where it lies more of its standard deviations
/// above zero.
template <typename Scalar>
static const estimation::Measurement<Scalar>& clearest_tangential(const estimation::CutEstimate<Scalar>& e) {
    using std::sqrt;
    const estimation::Measurement<Scalar>& newest = newest_tangential(e);
    const estimation::Measurement<Scalar>& steady = e.steady_tangential_N;
    const bool steady_is_clearer = steady.value * sqrt(newest.variance) > newest.value * sqrt(steady.variance);
    return steady_is_clearer ? steady : newest;
}

// Each sample

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::take(const hal::DriveSample& sample) {
    const Scalar dt_s = elapsed_s(sample.time_us);
    const estimation::DriveSignals<Scalar> signals = usable_signals_of<Scalar>(sample);
    follow_wide_band(dt_s, sample);
    supervisor_.take(sample, dt_s, control_.state);
    if ((sample.present & hal::mask(hal::Present::spindle_count)) != 0) {
        estimator_.add(dt_s, sample.spindle_count, sample.spindle_index_count, sample.spindle_index_number, signals);
    } else {
        forget_estimate();
    }
    load_answer_.take(signals.values[Signals::spindle_current]);
    set_motion(signals.velocity());
    input_.motion_is_unseen = false;
    input_.height_is_known = hal::knows_velocity(sample, 2);
    input_.dt_s = dt_s;
    settled_feed_.wait(dt_s);
    watch_sample(sample, signals, dt_s);
}

/// Without encoder or spindle current there is no force, and with a velocity that no axis has the feed is not known:
/// such a sample is discarded. The tick waits for the first complete one.
template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::watch_sample(const hal::DriveSample& sample, const Signals& signals,
                                                      Scalar dt_s) {
    const bool has_count = (sample.present & hal::mask(hal::Present::spindle_count)) != 0;
    const bool has_current = (signals.present & Signals::spindle_present) != 0 || !(K_t1_Nm_per_A_ > Scalar(0));
    const bool is_whole = has_count && has_current && !has_impossible_velocity(sample);
    has_begun_ = has_begun_ || is_whole;
    since_whole_sample_s_ = is_whole || !has_begun_ ? Scalar(0) : since_whole_sample_s_ + dt_s;
    input_.time_since_sample_s = is_whole ? dt_s : since_whole_sample_s_;
    if (is_whole) {
        watch_encoder(sample.spindle_count, signals.values[Signals::spindle_current], dt_s);
    }
}

/// A spindle that stands carries no cut. One that runs up turns at once.
template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::watch_encoder(std::uint32_t count, Scalar spindle_current_A, Scalar dt_s) {
    constexpr Scalar surely_stands_s = estimation::literal<Scalar>(0.02L);
    const auto turned = static_cast<std::int32_t>(count - last_count_);
    encoder_stands_s_ = turned == 0 ? encoder_stands_s_ + dt_s : Scalar(0);
    not_forwards_s_ = turned > 0 ? Scalar(0) : not_forwards_s_ + dt_s;
    last_count_ = count;
    input_.cut.spindle_does_not_mill = not_forwards_s_ > surely_stands_s;
    input_.cut.spindle_loaded_at_rest =
        encoder_stands_s_ > surely_stands_s && K_t1_Nm_per_A_ * spindle_current_A > contact_torque_Nm_;
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::take_silence(float silent_s, float dt_s) {
    forget_estimate();  // no average reaches over the gap
    input_.surface.valid = false;
    has_time_ = false;
    set_motion({});
    input_.motion_is_unseen = true;
    input_.dt_s = Scalar(dt_s);
    input_.time_since_sample_s = Scalar(silent_s);
}

template <typename Scalar, typename WideBand>
hal::FeedOverride ForceControlTick<Scalar, WideBand>::answer(const hal::ProgramStatus& program) {
    run_law(program);
    return output();
}

template <typename Scalar, typename WideBand>
hal::FeedOverride ForceControlTick<Scalar, WideBand>::step(const hal::DriveSample& sample,
                                                           const hal::ProgramStatus& program) {
    take(sample);
    return answer(program);
}

template <typename Scalar, typename WideBand>
hal::FeedOverride ForceControlTick<Scalar, WideBand>::step_without_sample(float silent_s, float dt_s,
                                                                          const hal::ProgramStatus& program) {
    take_silence(silent_s, dt_s);
    return answer(program);
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::reset_fault() {
    if (supervisor_.doubts_idle()) {
        estimator_.forget_air();
        was_rezeroed_ = false;
    }
    supervisor_.reset();
    controller_.reset();
}

template <typename Scalar, typename WideBand>
bool ForceControlTick<Scalar, WideBand>::axes_rest() const {
    const Scalar slowest_mm_s = controller_.parameters().override_min * Scalar(program_.programmed_feed_mm_s);
    const Scalar half_mm_s = estimation::halved(slowest_mm_s);
    const auto at_rest_mm_s = Scalar(hal::at_rest_mm_s);
    const Scalar still_mm_s = half_mm_s > at_rest_mm_s ? half_mm_s : at_rest_mm_s;
    return estimator_.spindle_turns() && estimator_.axes_are_slower_than(still_mm_s);
}

/// Since the last sample; 0 for the first one and where the clock went backwards.
template <typename Scalar, typename WideBand>
Scalar ForceControlTick<Scalar, WideBand>::elapsed_s(std::uint32_t time_us) {
    constexpr Scalar s_per_us = estimation::literal<Scalar>(1e-6L);
    const auto elapsed_us = static_cast<std::int32_t>(time_us - last_time_us_);
    const bool is_known = has_time_ && elapsed_us > 0;
    last_time_us_ = time_us;
    has_time_ = true;
    return is_known ? static_cast<Scalar>(elapsed_us) * s_per_us : Scalar(0);
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::follow_wide_band(Scalar dt_s, const hal::DriveSample& sample) {
    // Without a tangential force (no spindle current: a force sensor alone) air and cut cannot be distinguished.
    const bool may_be_in_cut = !estimator_.estimate().tangential_N.valid || is_in_cut();
    if (!wide_band_.add(dt_s, sample, may_be_in_cut)) {
        drops_.forget_sections();
    }
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::set_motion(Velocity velocity) {
    using estimation::square;
    using std::sqrt;
    constexpr Scalar plunging_mm_s{0.5F};
    const Scalar plane2 = square(velocity.x_mm_s) + square(velocity.y_mm_s);
    const Scalar axial2 = square(velocity.z_mm_s);
    input_.velocity_x_mm_s = velocity.x_mm_s;
    input_.velocity_y_mm_s = velocity.y_mm_s;
    input_.velocity_z_mm_s = velocity.z_mm_s;
    input_.path_speed_mm_s = sqrt(plane2 + axial2);
    input_.plunging = axial2 > plane2 && axial2 > square(plunging_mm_s);
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::run_law(const hal::ProgramStatus& program) {
    input_.programmed_feed_mm_s = Scalar(program.programmed_feed_mm_s);
    input_.operator_override = Scalar(program.operator_override);
    input_.rapid = program.rapid;
    input_.feed_hold = program.feed_hold;
    input_.cut.fresh = has_new_estimate_ && belongs_to_this_feed();
    input_.cut.spindle_turning = estimator_.spindle_turns();
    input_.cut.force_valid = estimator_.estimate().tangential_N.valid && input_.cut.spindle_turning;
    use_tooth_force_of_map();
    has_new_estimate_ = false;
    program_ = program;
    input_.implausible = supervisor_.fault();
    control_ = controller_.step(input_);
}

/// In the cut a force that comes late says nothing of a feed that has changed since.
template <typename Scalar, typename WideBand>
bool ForceControlTick<Scalar, WideBand>::belongs_to_this_feed() const {
    return feed_is_settled() || control_.state != control::CutState::in_cut;
}

/// In a mapped cut the map stands for the caution. What the forces determine by themselves counts half: their depth
/// trusts the tool's K_s, the map's the blank, and one is off where the other need not be. Elsewhere the map knows the
/// arc, and with it the tooth's share of F_at.
template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::use_tooth_force_of_map() {
    using estimation::square;
    using std::sqrt;
    control::CutEstimateForControl<Scalar>& cut = input_.cut;
    if (!input_.way.known || !(input_.way.tooth_per_tangential > Scalar(0)) || !has_new_estimate_) {
        return;
    }
    const estimation::CutEstimate<Scalar>& e = estimator_.estimate();
    cut.tooth_force_valid = true;
    const Scalar by_map_per_N = input_.way.tooth_per_tangential * e.runout_factor;
    const Scalar now_N = e.newest_tangential_N;
    const Scalar sd_N = sqrt(e.tangential_N.variance);
    // The map's force stands on some ten estimates whose windows overlap: its noise is half of one's.
    const Scalar smooth_N = input_.way.tangential_N > Scalar(0)
                                ? estimation::clamp(input_.way.tangential_N, now_N - sd_N, now_N + sd_N)
                                : now_N;
    if (e.tooth_force_N.valid && !cut.tooth_force_is_bound) {
        cut.tooth_force_N = estimation::halved(e.tooth_force_N.value + by_map_per_N * smooth_N);
        return;
    }
    const Scalar caution_N =
        controller_.parameters().caution_sd * sqrt(e.tangential_N.variance + square(e.tangential_gain_doubt * now_N));
    const Scalar tangential_N =
        smooth_N + (input_.way.tangential_N > Scalar(0) ? estimation::halved(caution_N) : caution_N);
    const Scalar by_map_N = by_map_per_N * tangential_N;
    cut.tooth_force_is_bound = cut.tooth_force_is_bound || !(by_map_N < cut.least_tooth_force_N);
    cut.tooth_force_N = by_map_N > cut.least_tooth_force_N ? by_map_N : cut.least_tooth_force_N;
    cut.certain_tooth_force_N = cut.tooth_force_N;
}

template <typename Scalar, typename WideBand>
hal::FeedOverride ForceControlTick<Scalar, WideBand>::output() {
    hal::FeedOverride output;
    output.ratio = static_cast<float>(control_.ratio);
    output.hold = control_.hold;
    output.state = static_cast<std::uint8_t>(control_.state);
    output.fault = static_cast<std::uint8_t>(control_.fault);
    output.heartbeat = ++heartbeat_;
    return output;
}

// Work beside the samples

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::work() {
    if (estimator_.work_due()) {
        estimator_.set_immersion_of_other_method(
            drops_.carry(wide_band_.estimate().force_drop_immersion, estimator_.estimate().section_mm2));
        if (estimator_.work()) {
            take_estimate();
        }
    } else {
        work_on_wide_band();
    }
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::take_estimate() {
    settled_feed_.take(estimator_.estimate().feed_per_tooth_mm);
    rezero_in_air();
    if (is_in_cut()) {
        estimator_.learn_in_cut();
    } else if (control_.state == control::CutState::air) {
        estimator_.end_cut();
    }
    drops_.follow_section(estimator_.estimate().section_mm2);
    surface_.update(estimator_.estimate());
    supervisor_.judge(estimator_.estimate(), program_, control_.state, feed_is_settled());
    supervisor_.judge_idle(estimator_.spindle_is_implausible(), estimator_.estimate().tooth_periods);
    ask_load();
    set_cut();
    has_new_estimate_ = true;
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::ask_load() {
    const estimation::CutEstimate<Scalar>& e = estimator_.estimate();
    if (control_.state == control::CutState::in_cut && e.tangential_N.valid) {
        load_answer_.follow(e, control::tooth_period_s(controller_.parameters().teeth, e.spindle_speed_rad_s),
                            feed_is_settled());
    } else {
        load_answer_.restart();
    }
    input_.cut.answered_feed_mm_s = load_answer_.bound_mm_s();
    supervisor_.judge_load(load_answer_.is_dead());
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::forget_estimate() {
    estimator_.restart();
    settled_feed_.take(Scalar(0));
    supervisor_.restart();
    set_cut();
    has_new_estimate_ = false;
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::work_on_wide_band() {
    const WideBandEstimate<Scalar> before = wide_band_.estimate();
    wide_band_.work();
    if (wide_band_.estimate().force_drops != before.force_drops) {
        drops_.take(wide_band_.estimate().force_drop_immersion, before.force_drop_immersion);
    }
}

/// Within half the contact level of nothing, above it or below: a choice of one side would be learnt as drift. Further
/// below where a light cut has been.
template <typename Scalar, typename WideBand>
bool ForceControlTick<Scalar, WideBand>::is_idle(const estimation::CutEstimate<Scalar>& e) const {
    using std::sqrt;
    const Scalar level_N = control::contact_level_N(controller_.parameters(), sqrt(e.steady_tangential_N.variance));
    const Scalar half_N = estimation::halved(level_N);
    const Scalar force_N = e.steady_tangential_N.value;
    return e.tangential_N.valid && force_N < half_N && force_N + e.uncertain_idle_N > -half_N;
}

template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::rezero_in_air() {
    const auto& estimate = estimator_.estimate();
    const bool axes_rest = estimator_.axes_rest();
    const auto looks_idle = [&] {
        return axes_rest || (was_rezeroed_ && is_idle(estimate) && !drift_doubt_.may_still_cut(estimate));
    };
    const bool is_air = controller_.state() == control::CutState::air && !input_.way.may_cut && looks_idle();
    // A rapid is the program's word for air, even where drift has grown to what looks like a cut.
    air_periods_ = program_.rapid || is_air ? air_periods_ + estimate.tooth_periods : 0;
    // The first windows after a change hold a mixture of air and cut.
    const int enough = 2 * static_cast<int>(controller_.parameters().teeth) + 1;
    if (air_periods_ >= enough) {
        const bool may_cut = !program_.rapid && !axes_rest;
        was_rezeroed_ = estimator_.rezero(may_cut) || was_rezeroed_;
        if (may_cut && estimator_.find_hidden_cut()) {
            was_rezeroed_ = false;  // nothing is learnt in a feed move until a rapid or a rest has shown what is air
        }
        drift_doubt_.clear();
        air_periods_ = enough;
    } else {
        estimator_.leave_air();
    }
}

/// What a new estimate says to the controller.
template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::set_cut() {
    using std::sqrt;
    const estimation::CutEstimate<Scalar>& e = estimator_.estimate();
    control::CutEstimateForControl<Scalar>& cut = input_.cut;
    const estimation::Measurement<Scalar>& F_at =
        estimator_.axes_rest() ? newest_tangential(e) : clearest_tangential(e);
    cut.tangential_N = F_at.value;
    cut.tangential_sd_N = sqrt(F_at.variance);
    const estimation::Measurement<Scalar>& tooth = e.tooth_force_N;
    const Scalar tooth_sd_N = sqrt(tooth.variance);
    cut.tooth_force_valid = tooth.valid;
    cut.tooth_force_is_bound = e.tooth_force_is_bound;
    cut.least_tooth_force_N = e.least_tooth_force_N;
    cut.certain_tooth_force_N = e.certain_tooth_force_N;
    cut.law_is_refuted =
        estimation::is_refuted(e.engagement) || e.engagement.law_is_in_doubt || e.engagement.declared_depth_is_refuted;
    cut.tooth_force_N =
        tooth.valid ? tooth.value + controller_.parameters().caution_sd * tooth_sd_N : e.worst_tooth_force_N;
    allow_for_drift();
    // What the force will be once the CNC acts on this override: it grows meanwhile as it grew in the last window.
    if (e.newest_tangential_N > Scalar(0)) {
        const Scalar lead_s = reaction_s_ + estimation::halved(e.window_s);
        cut.tooth_force_N *= Scalar(1) + e.tangential_growth_N_per_s * lead_s / e.newest_tangential_N;
    }
    cut.tooth_periods = Scalar(e.tooth_periods);
    // Of the tooth that stands out: what runout adds to its chip does not fall with the feed.
    cut.cutting_share = e.cutting_share / e.runout_factor;
    cut.surge_ratio = e.surge.ratio;
    cut.surge_cutting_share = e.surge.cutting_share;
    cut.turn_ratio = e.turn.ratio;
    cut.turn_cutting_share = e.turn.cutting_share;
    cut.section_mm2 = e.section_mm2;
    cut.section_noise_mm2 = e.section_noise_mm2;
    cut.feed_exponent = e.feed_exponent;
    cut.feed_mm_s = e.feed_mm_s;
    cut.spindle_speed_rad_s = e.spindle_speed_rad_s;
    input_.surface = surface_.for_control();
}

/// Of currents, within the cut.
template <typename Scalar, typename WideBand>
void ForceControlTick<Scalar, WideBand>::allow_for_drift() {
    const estimation::CutEstimate<Scalar>& e = estimator_.estimate();
    control::CutEstimateForControl<Scalar>& cut = input_.cut;
    const DoubtStage stage{is_in_cut(), control::is_cutting(control_.state), input_.way.known,
                           wide_band_.estimate().force_drop_immersion.valid};
    const Scalar period_s = control::tooth_period_s(controller_.parameters().teeth, e.spindle_speed_rad_s);
    const PossibleForce<Scalar> possible = drift_doubt_.follow(e, cut.tooth_force_N, period_s, stage);
    cut.tooth_force_is_bound = cut.tooth_force_is_bound || possible.is_bound;
    cut.tooth_force_N = possible.tooth_N;
    cut.doubted_feed_mm_s = drift_doubt_.bound_mm_s();
}

// What is shown

template <typename Scalar, typename WideBand>
bool ForceControlTick<Scalar, WideBand>::is_in_cut() const {
    const bool is_cutting = control_.state == control::CutState::in_cut || control_.state == control::CutState::hold;
    return is_cutting && !control_.fading;
}

template <typename Scalar, typename WideBand>
estimation::EngagementEstimate<Scalar> ForceControlTick<Scalar, WideBand>::engagement() const {
    estimation::EngagementEstimate<Scalar> shown = estimator_.estimate().engagement;
    const bool arc_is_known = is_in_cut();
    shown.immersion_valid = shown.immersion_valid && arc_is_known;
    shown.depth_valid = shown.depth_valid && arc_is_known;
    return shown;
}

}  // namespace millforce::firmware
