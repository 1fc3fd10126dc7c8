// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimator.hpp"
#include "estimation/engagement/engagement_solver_impl.hpp"
#include "estimation/signal/synchronous_average_impl.hpp"
#include "estimation/tooth_force/engagement_peaks_impl.hpp"
#include "estimation/tooth_force/tooth_force_impl.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar>
CutEstimator<Scalar>::CutEstimator(const CutEstimatorSettings<Scalar>& settings,
                                   const SpindleDriveParameters<Scalar>& spindle,
                                   const std::array<FeedDriveParameters<Scalar>, 3>& axes,
                                   const CuttingLaw<Scalar>& law)
    : encoder_(settings.encoder_counts_per_rev),
      average_({static_cast<int>(settings.teeth), settings.min_samples}),
      harmonic_(settings.encoder_counts_per_rev),
      settings_(settings),
      per_Nm_(settings.cutter_radius_mm > Scalar(0) ? Scalar(1000) / settings.cutter_radius_mm : Scalar(0)),
      drives_(spindle, axes),
      peaks_(law, {peak_factor_settings(settings, settings.side), settings.largest_depth_mm, settings.assumed_immersion,
                   settings.surge_immersion, settings.turn_immersion}),
      tooth_force_(settings, law),
      runout_(settings.runout_mm, static_cast<int>(settings.teeth),
              !(axes[0].K_x4_N_per_A > Scalar(0) || axes[1].K_x4_N_per_A > Scalar(0))),
      law_(law),
      solver_(law,
              {.teeth = settings.teeth,
               .centre_offset_in_radii = settings.centre_offset_in_radii,
               .law_relative_sd = settings.law_relative_sd,
               .declared_depth_mm = settings.declared_depth_mm,
               .flute_length_mm = settings.largest_depth_mm},
              settings.side) {}

// One sample

template <typename Scalar>
void CutEstimator<Scalar>::add(Scalar dt_s, std::uint32_t count, std::uint32_t index_count, std::uint8_t index_number,
                               const DriveSignals<Scalar>& signals) {
    const EncoderReading<Scalar> reading = encoder_.update(count, index_count, index_number);
    since_period_s_ += dt_s;
    if (reading.is_break()) {
        average_.restart();
        harmonic_.restart();
        runout_.lose_angle();
        periods_ended_ = 0;
        return;
    }
    const int completed = average_.add(dt_s, reading.turned_rev, reading.angle_rev, signals.values, signals.present);
    follow_turning_force(dt_s, reading, signals);
    if (completed > 0) {
        since_prediction_s_ += since_period_s_;
        since_period_s_ = Scalar(0);
        periods_ended_ += completed;
    }
}

/// A load that is told seldom shows nothing of it.
template <typename Scalar>
void CutEstimator<Scalar>::follow_turning_force(Scalar dt_s, const EncoderReading<Scalar>& reading,
                                                const DriveSignals<Scalar>& signals) {
    const bool is_present = (signals.present & DriveSignals<Scalar>::spindle_present) != 0U;
    if (is_present && !settings_.load_is_held) {
        harmonic_.add(dt_s, reading.turned_rev, reading.angle_rev,
                      signals.values[DriveSignals<Scalar>::spindle_current]);
    } else {
        harmonic_.restart();
    }
}

template <typename Scalar>
bool CutEstimator<Scalar>::spindle_turns() const {
    // What the estimate takes, and a tooth period that is as long as the window.
    constexpr Scalar patience_s = literal<Scalar>(0.02L);
    constexpr Scalar windows{3};
    const Scalar window_s = estimate_.window_s;
    return window_s > Scalar(0) && since_period_s_ < windows * window_s + patience_s;
}

template <typename Scalar>
void CutEstimator<Scalar>::restart() {
    encoder_.reset();
    average_.restart();
    harmonic_.restart();
    runout_.lose_angle();
    periods_ended_ = 0;
    stage_ = Stage::idle;
    search_.cancel();
    depth_.forget();
    law_doubt_.forget();
    estimate_ = {};
}

// The work beside the samples

template <typename Scalar>
bool CutEstimator<Scalar>::work(int solver_steps) {
    switch (stage_) {
        case Stage::idle:
            return periods_ended_ > 0 && begin_estimate();
        case Stage::engagement:
            if (solver_.advance(search_, solver_steps)) {
                stage_ = Stage::peaks;
            }
            return false;
        case Stage::peaks:
            peaks_.take(search_.estimate(), solver_, in_work_.tangential_N.value, in_work_.feed_per_tooth_mm);
            in_work_.engagement = search_.estimate();
            break;
        case Stage::bound:
            peaks_.search(solver_);
            break;
    }
    if (peaks_.search_due()) {
        stage_ = Stage::bound;
        return false;
    }
    tooth_force_.fill(in_work_, peaks_, solver_.table(peaks_.side()), runout_.largest_excess_mm());
    learn_runout();
    publish();
    return true;
}

/// Not while the speed changes: that looks like a tooth that takes more.
template <typename Scalar>
TurningForce<Scalar> CutEstimator<Scalar>::turning_force(const typename RevolutionHarmonic<Scalar>::Mean& seen,
                                                         const Window& window) const {
    constexpr Scalar steady_share = literal<Scalar>(0.005L);
    const Scalar change_rad_s = window.spindle_acceleration_rad_s2 * window.duration_s;
    const Scalar most_rad_s = steady_share * window.spindle_speed_rad_s;
    return change_rad_s < most_rad_s && -change_rad_s < most_rad_s
               ? drives_.spindle.turning_force_N(seen, window.spindle_speed_rad_s, per_Nm_)
               : TurningForce<Scalar>{};
}

template <typename Scalar>
void CutEstimator<Scalar>::learn_runout() {
    constexpr Scalar same_cut_revolutions{2};
    if (turning_.revolutions > 0 && memory_.revolutions() > same_cut_revolutions) {
        runout_.learn({.turning = turning_force(turning_, window_),
                       .feed_direction = {direction_x_, direction_y_},
                       .feed_per_tooth_mm = in_work_.feed_per_tooth_mm,
                       .cutting_N = in_work_.cutting_share * in_work_.tangential_N.value,
                       .engagement = in_work_.engagement});
    }
}

template <typename Scalar>
void CutEstimator<Scalar>::publish() {
    estimate_ = in_work_;
    stage_ = Stage::idle;
}

/// Returns true where the estimate is complete with that: there is no window yet.
template <typename Scalar>
bool CutEstimator<Scalar>::begin_estimate() {
    const Scalar passed_s = since_prediction_s_;
    since_prediction_s_ = Scalar(0);
    drives_.predict(passed_s);
    window_ = average_.window();
    turning_ = harmonic_.take();
    in_work_ = {};
    in_work_.tooth_periods = periods_ended_;
    periods_ended_ = 0;
    if (window_.revolutions == 0) {
        publish();
        return true;
    }
    estimate_forces();
    estimate_along_feed();
    estimate_tooth_change();
    begin_engagement(passed_s);
    stage_ = Stage::engagement;
    return false;
}

template <typename Scalar>
typename SpindleDrive<Scalar>::Average CutEstimator<Scalar>::spindle_average(const Window& window) const {
    // Of two speeds, each from three boundaries that weigh 1.5, −2 and 0.5, between two counts with an error of
    // variance 1/12.
    constexpr Scalar variance_counts2 = literal<Scalar>(13.0L / 12.0L);
    const Scalar count_rad = turn_rad<Scalar> / Scalar(static_cast<int>(settings_.encoder_counts_per_rev));
    const Scalar base_s2 = window.speed_span_s * window.duration_s;
    typename SpindleDrive<Scalar>::Average spindle;
    spindle.current_A = window.mean[DriveSignals<Scalar>::spindle_current];
    spindle.speed_rad_s = window.spindle_speed_rad_s;
    spindle.acceleration_rad_s2 = window.spindle_acceleration_rad_s2;
    spindle.acceleration_change_rad_s2 = window.spindle_acceleration_change_rad_s2;
    spindle.acceleration_variance = base_s2 > Scalar(0) ? square(count_rad / base_s2) * variance_counts2 : Scalar(0);
    spindle.samples = window.samples;
    spindle.present = (window.present & DriveSignals<Scalar>::spindle_present) != 0U;
    return spindle;
}

/// The last tooth period alone. The acceleration is that of the window, which says little of a single tooth.
template <typename Scalar>
typename SpindleDrive<Scalar>::Average CutEstimator<Scalar>::spindle_average_of_tooth(const Window& window) const {
    const typename Averager::Means& tooth = average_.tooth();
    typename SpindleDrive<Scalar>::Average spindle = spindle_average(window);
    spindle.current_A = tooth.mean[DriveSignals<Scalar>::spindle_current];
    spindle.speed_rad_s = average_.tooth_speed_rad_s();
    spindle.acceleration_variance += square(spindle.acceleration_rad_s2);
    spindle.samples = tooth.samples;
    spindle.present = (tooth.present & DriveSignals<Scalar>::spindle_present) != 0U;
    return spindle;
}

template <typename Scalar>
typename FeedDrive<Scalar>::Average CutEstimator<Scalar>::axis_average(const Window& window, std::size_t axis) {
    const auto current = DriveSignals<Scalar>::first_current + static_cast<int>(axis);
    const auto velocity = DriveSignals<Scalar>::first_velocity + static_cast<int>(axis);
    typename FeedDrive<Scalar>::Average average;
    average.current_A = window.mean[current];
    average.velocity_mm_s = window.mean[velocity];
    average.acceleration_mm_s2 = window.rate_per_s[static_cast<Eigen::Index>(axis)];
    average.duration_s = window.duration_s;
    average.samples = window.samples;
    average.present = (window.present & (DriveSignals<Scalar>::first_axis_present << axis)) != 0U;
    return average;
}

template <typename Scalar>
void CutEstimator<Scalar>::estimate_forces() {
    CutEstimate<Scalar>& e = in_work_;
    e.window_s = window_.duration_s;
    e.spindle_speed_rad_s = window_.spindle_speed_rad_s;
    if (per_Nm_ > Scalar(0)) {
        e.tangential_N = drives_.spindle.force_N(spindle_average(window_), per_Nm_);
        e.tooth_tangential_N = drives_.spindle.force_N(spindle_average_of_tooth(window_), per_Nm_);
        e.uncertain_idle_N = drives_.spindle.uncertain_drift_Nm() * per_Nm_;
    }
    e.tangential_gain_doubt = drives_.spindle.gain_doubt();
    e.x_N = drives_.axes[0].force_N(axis_average(window_, 0));
    e.y_N = drives_.axes[1].force_N(axis_average(window_, 1));
    e.z_N = drives_.axes[2].force_N(axis_average(window_, 2));
    e.axis_is_implausible = drives_.axes[0].is_implausible() || drives_.axes[1].is_implausible();
}

template <typename Scalar>
void CutEstimator<Scalar>::estimate_along_feed() {
    using std::sqrt;
    CutEstimate<Scalar>& e = in_work_;
    const Scalar x_mm_s = window_.mean[DriveSignals<Scalar>::first_velocity];
    const Scalar y_mm_s = window_.mean[DriveSignals<Scalar>::first_velocity + 1];
    e.axial_speed_mm_s = window_.mean[DriveSignals<Scalar>::first_velocity + 2];
    e.feed_mm_s = sqrt(square(x_mm_s) + square(y_mm_s));
    const Scalar teeth_per_s = settings_.teeth * turns_per_rad<Scalar> * window_.spindle_speed_rad_s;
    e.feed_per_tooth_mm = teeth_per_s > Scalar(0) ? e.feed_mm_s / teeth_per_s : Scalar(0);
    if (!(e.feed_mm_s > Scalar(0))) {
        return;
    }
    direction_x_ = x_mm_s / e.feed_mm_s;
    direction_y_ = y_mm_s / e.feed_mm_s;
    const auto is_known_or_across = [](const Measurement<Scalar>& force_N, Scalar share) {
        constexpr Scalar across = literal<Scalar>(0.001L);  // of the force's square: 1.8 degrees from square
        return force_N.valid || square(share) < across;
    };
    if (is_known_or_across(e.x_N, direction_x_) && is_known_or_across(e.y_N, direction_y_)) {
        e.feed_N.valid = true;
        e.feed_N.value = (e.x_N.valid ? direction_x_ * e.x_N.value : Scalar(0)) +
                         (e.y_N.valid ? direction_y_ * e.y_N.value : Scalar(0));
        e.feed_N.variance = square(direction_x_) * e.x_N.variance + square(direction_y_) * e.y_N.variance;
    }
}

template <typename Scalar>
void CutEstimator<Scalar>::estimate_tooth_change() {
    using Signals = DriveSignals<Scalar>;
    if (!average_.has_turn_before()) {
        return;
    }
    const typename Averager::Means& now = average_.tooth();
    const typename Averager::Means& before = average_.tooth_one_turn_before();
    const typename Averager::Signals change = now.mean - before.mean;
    const std::uint32_t present = now.present & before.present;
    typename CutEstimate<Scalar>::ToothChange& c = in_work_.tooth_change;
    c.speed_ratio = before.duration_s / now.duration_s;
    if ((present & Signals::spindle_present) != 0U) {
        c.tangential_N = drives_.spindle.change_N(change[Signals::spindle_current], average_.tooth_speed_rad_s(),
                                                  now.samples, per_Nm_);
    }
    for (std::size_t axis = 0; axis < c.axis_N.size(); ++axis) {
        if ((present & (Signals::first_axis_present << axis)) != 0U) {
            c.axis_N[axis] =
                drives_.axes[axis].change_N(change[Signals::first_current + static_cast<int>(axis)], now.samples);
        }
    }
    constexpr Scalar steady_share2 = literal<Scalar>(0.01L);
    constexpr Scalar alike_share2 = literal<Scalar>(0.09L);
    constexpr int velocities = Signals::velocities;
    const Scalar changed2 = change.template tail<velocities>().squaredNorm();
    const Scalar now2 = now.mean.template tail<velocities>().squaredNorm();
    const Scalar risen2 = now2 - before.mean.template tail<velocities>().squaredNorm();
    c.feed_is_steady = changed2 < steady_share2 * now2;
    c.feed_is_alike = changed2 < alike_share2 * now2;
    c.feed_is_new = changed2 > now2;
    c.feed_growth = risen2 > Scalar(0) ? halved(risen2 / now2) : Scalar(0);
}

template <typename Scalar>
void CutEstimator<Scalar>::begin_engagement(Scalar passed_s) {
    AverageForceMeasurement<Scalar> forces;
    forces.tangential_N = in_work_.tangential_N;
    forces.x_N = in_work_.x_N;
    forces.y_N = in_work_.y_N;
    forces.resting.is_x = square(direction_x_) < square(direction_y_);
    const std::size_t across = forces.resting.is_x ? 0 : 1;
    forces.resting.least_N = drives_.axes[across].least_force_at_rest_N(axis_average(window_, across));
    forces.feed_direction_x = direction_x_;
    forces.feed_direction_y = direction_y_;
    periods_since_memory_ += in_work_.tooth_periods;
    const bool is_new_revolution = periods_since_memory_ >= window_.tooth_periods;
    periods_since_memory_ = is_new_revolution ? 0 : periods_since_memory_;
    memory_.blend(forces, in_work_.feed_mm_s, tooth_force_.force_exponent(), is_new_revolution);
    in_work_.steady_tangential_N = settings_.load_is_held ? in_work_.tangential_N : forces.tangential_N;
    forces.tangential_N.variance += square(in_work_.tangential_gain_doubt * forces.tangential_N.value);
    forces.radial_immersion = other_;
    depth_.follow(in_work_.feed_mm_s * passed_s, in_work_.axial_speed_mm_s * passed_s);
    solver_.begin(search_, forces, in_work_.feed_per_tooth_mm, settings_.side, depth_.depth(), law_doubt_.is_open());
}

template <typename Scalar>
void CutEstimator<Scalar>::learn_in_cut() {
    law_doubt_.follow(is_refuted(estimate_.engagement), estimate_.tooth_periods, window_.tooth_periods);
    if (!estimate_.engagement.depth_is_remembered) {
        depth_.learn(estimate_.engagement);
    }
}

// Learning in air

template <typename Scalar>
bool CutEstimator<Scalar>::rezero(bool may_cut) {
    if (window_.revolutions == 0) {
        return false;
    }
    learn_air_of_runout();
    air_periods_ = air_periods_ + estimate_.tooth_periods;
    if (air_periods_ < window_.tooth_periods) {
        return false;
    }
    air_periods_ = 0;
    const bool has_window = air_window_.revolutions > 0;
    if (has_window) {
        rezero_drives(may_cut);
    }
    learn_noise();
    air_window_ = window_;
    return has_window && !drives_.spindle.is_implausible();
}

template <typename Scalar>
void CutEstimator<Scalar>::learn_air_of_runout() {
    if (turning_.revolutions > 0) {
        runout_.learn_air(air_turning_);
        air_turning_ = turning_force(turning_, window_);
    }
}

/// A spindle that shows no idle torque does not say that this is air: the axes may carry a cut.
template <typename Scalar>
void CutEstimator<Scalar>::rezero_drives(bool may_cut) {
    drives_.spindle.rezero(spindle_average(air_window_), may_cut);
    for (std::size_t k = 0; k < drives_.axes.size() && !drives_.spindle.is_implausible(); ++k) {
        drives_.axes[k].rezero(axis_average(air_window_, k));
    }
}

template <typename Scalar>
void CutEstimator<Scalar>::learn_noise() {
    constexpr Scalar steady_share = literal<Scalar>(0.01L);
    const typename CutEstimate<Scalar>::ToothChange& change = estimate_.tooth_change;
    const Scalar speed_change = change.speed_ratio - Scalar(1);
    if (!change.feed_is_steady || speed_change > steady_share || -speed_change > steady_share) {
        return;
    }
    if (!settings_.load_is_held) {
        drives_.spindle.learn_noise(change.tangential_N);
    }
    for (std::size_t k = 0; k < change.axis_N.size(); ++k) {
        drives_.axes[k].learn_noise(change.axis_N[k]);
    }
}

template <typename Scalar>
MachineDrives<Scalar> CutEstimator<Scalar>::drives() const {
    MachineDrives<Scalar> drives = drives_;
    drives.predict(since_prediction_s_ + since_period_s_);
    return drives;
}

template <typename Scalar>
void CutEstimator<Scalar>::leave_air() {
    air_window_ = {};
    air_turning_ = {};
    air_periods_ = 0;
}

template <typename Scalar>
bool CutEstimator<Scalar>::axes_are_slower_than(Scalar mm_s) const {
    bool all_are = window_.revolutions > 0;
    for (int k = DriveSignals<Scalar>::first_velocity; k < DriveSignals<Scalar>::channels; ++k) {
        all_are = all_are && window_.mean[k] < mm_s && -window_.mean[k] < mm_s;
    }
    return all_are;
}

}  // namespace millforce::estimation
