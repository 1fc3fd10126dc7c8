// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/cutting/engagement_peaks.hpp"
#include "estimation/cutting/tooth_force.hpp"
#include "estimation/cutting/total_force.hpp"
#include "estimation/drives/feed_drive.hpp"
#include "estimation/drives/spindle_drive.hpp"
#include "estimation/engagement/engagement_solver.hpp"
#include "estimation/signal/encoder_angle.hpp"
#include "estimation/signal/force_memory.hpp"
#include "estimation/signal/synchronous_average.hpp"
#include "estimation/signal/tooth_repetition.hpp"

/// From drive signals to forces, engagement and peak force: the chain that the tick runs.
///
///   encoder → averages over tooth and revolution → F_at, F_x, F_y → R_r, a_p → peak of one tooth, total, threshold
///
/// One call of add() per drive sample; work is done when a tooth period ends, the rest is accumulation.
/// No heap, no clock; about 12 KiB with its tables in float. Not thread-safe.

namespace millforce::estimation {

/// What the caller of add() says of the present moment. It matters with solver_values_per_step alone.
struct Moment {
    bool is_busy = false;  ///< with the law for instance: what has just ended and the solver wait for the next call
    bool is_steady =
        false;  ///< nothing rises and nothing fades: teeth that repeat themselves may wait for longest_wait_s
};

template <typename Scalar>
class CutEstimator {
  public:
    CutEstimator() = default;
    [[gnu::cold]] CutEstimator(const CutEstimatorSettings<Scalar>& settings,
                               const SpindleDriveParameters<Scalar>& spindle,
                               const std::array<FeedDriveParameters<Scalar>, 3>& axes, const CuttingLaw<Scalar>& law)
        : per_Nm_(settings.cutter_radius_mm > Scalar(0) ? Scalar(1000) / settings.cutter_radius_mm : Scalar(0)),
          count_rad_(Scalar(2) * pi<Scalar> / static_cast<Scalar>(settings.encoder_counts_per_rev)),
          encoder_(settings.encoder_counts_per_rev),
          repetition_(static_cast<int>(settings.teeth)),
          spindle_(spindle),
          average_({static_cast<int>(settings.teeth), settings.min_samples}),
          settings_(settings),
          axes_{FeedDrive<Scalar>(axes[0]), FeedDrive<Scalar>(axes[1]), FeedDrive<Scalar>(axes[2])},
          peaks_(law, {peak_settings(settings.side), settings.largest_depth_mm, settings.assumed_immersion,
                       settings.surge_immersion, settings.turn_immersion}),
          tooth_force_(settings, law),
          law_(law),
          solver_(law, solver_settings(settings), settings.side) {
        read_whole_engagement();
    }

    /// Adds one sample. Returns true when estimate() is new: with each tooth period, or as below.
    ///
    /// With solver_values_per_step each call does one piece of work at most, so that none is long: at the end of a
    /// tooth period the tangential force; the axes' forces where they are due (FeedForces); the peaks with the
    /// engagement that is known; then the estimate is new. Teeth that load the spindle as they did a revolution before
    /// (ToothRepetition) wait for the revolution's end, and in a steady moment for longest_wait_s. One call in between,
    /// and what calls are left over, work at the solver. It is taken up where the forces ask something new, once a
    /// revolution or as soon as they have left those of the revolutions before; when it is done its tables are read,
    /// and the peaks worked out anew. Tooth periods that end while another one is in work are in the averages of the
    /// next.
    [[gnu::always_inline]] bool add(Scalar dt_s, std::uint32_t count, std::uint32_t index_count,
                                    std::uint8_t index_number, const DriveSignals<Scalar>& signals,
                                    Moment moment = {}) {
        const EncoderReading<Scalar> reading = encoder_.advance(count, index_count, index_number);
        since_period_s_ += dt_s;
        if (reading.is_break()) {
            average_.restart();
            periods_ended_ = 0;
            return false;
        }
        const auto angle_rev = [this] { return encoder_.angle_rev(); };
        const int completed = average_.add(dt_s, reading.turned_rev, angle_rev, signals.values, signals.present);
        if (completed > 0) {
            since_prediction_s_ += since_period_s_;
            since_period_s_ = Scalar(0);
            periods_ended_ += completed;
        }
        if (in_portions()) {
            if (completed > 0) {
                follow_teeth();
            }
            if (completed == 0 && is_resting_) {
                has_closed_ = false;
                return false;
            }
            // Closing a period is work as well; where every call closes one, it can be no reason to wait.
            const bool closes_one = completed > 0 && !has_closed_;
            has_closed_ = completed > 0;
            is_resting_ = false;
            if (closes_one && (moment.is_busy || stage_ != Stage::idle)) {
                return false;
            }
            return work_on(closes_one, moment);
        }
        if (completed > 0) {
            work_at_once();
        }
        return completed > 0;
    }

    /// An immersion that another method tells of the present cut, for the estimates to come; not valid: none.
    void tell_immersion(const Measurement<Scalar>& radial_immersion) { told_immersion_ = radial_immersion; }

    /// The encoder failed or the samples stopped: start anew, keep what was learnt in air.
    [[gnu::cold, gnu::noinline]] void restart() {
        encoder_.reset();
        average_.restart();
        estimates_[shown_] = {};
        period_timeout_s_ = Scalar(0);
        periods_ended_ = 0;
        stage_ = Stage::idle;
        engagement_ = {};
        search_.cancel();
        search_due_ = false;
        asked_ = {};
        unread_parts_ = parts_of_engagement;
        is_resting_ = false;
    }

    /// The tool has been in air up to now: re-zero the spindle's idle torque and the moving axes' friction. It is done
    /// with the window one revolution ago: the first contact must not be taken for drift before it is known as contact.
    /// Call once per new estimate while in air; leave_air() when that ends. Returns whether it was done.
    [[gnu::cold]] bool rezero() {
        if (window_.revolutions == 0) {
            return false;
        }
        air_periods_ = air_periods_ + estimate().tooth_periods;
        if (air_periods_ < window_.tooth_periods) {
            return false;
        }
        air_periods_ = 0;
        const bool has_window = air_window_.revolutions > 0;
        if (has_window) {
            spindle_.rezero(spindle_average(air_window_));
            for (std::size_t k = 0; k < axes_.size(); ++k) {
                axes_[k].rezero(axis_average(air_window_, k));
            }
        }
        air_window_ = window_;
        return has_window;
    }
    void leave_air() {
        air_window_ = {};
        air_periods_ = 0;
    }
    /// In the mean of the window no axis moved by more than 0.1 mm/s: nothing can be cut.
    [[nodiscard]] bool axes_rest() const {
        constexpr Scalar rest_mm_s = static_cast<Scalar>(0.1L);
        const auto rests = [&](Scalar v_mm_s) { return v_mm_s < rest_mm_s && -v_mm_s < rest_mm_s; };
        return window_.revolutions > 0 && rests(window_.mean[first_velocity]) &&
               rests(window_.mean[first_velocity + 1]) && rests(window_.mean[first_velocity + 2]);
    }

    [[nodiscard]] const CutEstimate<Scalar>& estimate() const { return estimates_[shown_]; }
    [[nodiscard]] Scalar since_period_s() const { return since_period_s_; }
    /// Tooth periods still end: the last one is no longer ago than three windows.
    [[nodiscard]] bool spindle_turns() const { return since_period_s_ < period_timeout_s_; }
    [[nodiscard]] Scalar spindle_drift_Nm() const { return spindle_.drift_Nm(); }
    [[nodiscard]] Scalar friction_scale(std::size_t axis, bool positive) const {
        return axes_[axis].friction_scale(positive);
    }
    /// What the total force of estimate() is worked out of, by whoever shows it: TotalForce.
    [[nodiscard]] TotalForceInput<Scalar> total_force_input() const {
        return {estimate().worst_tooth_force_N, peaks_.now().radial_immersion, peaks_.depth_mm(), peaks_.side()};
    }

  private:
    static constexpr int first_current = DriveSignals<Scalar>::first_current;
    static constexpr int first_velocity = DriveSignals<Scalar>::first_velocity;
    using Averager = SynchronousAverage<Scalar, DriveSignals<Scalar>::channels, first_velocity>;

    [[nodiscard]] bool in_portions() const { return settings_.solver_values_per_step > 0; }

    void predict_drifts() {
        spindle_.predict(since_prediction_s_);
        for (FeedDrive<Scalar>& axis : axes_) {
            axis.predict(since_prediction_s_);
        }
        since_prediction_s_ = Scalar(0);
    }

    [[nodiscard]] static EngagementSolverSettings<Scalar> solver_settings(
        const CutEstimatorSettings<Scalar>& settings) {
        EngagementSolverSettings<Scalar> solver;
        solver.teeth = settings.teeth;
        solver.centre_offset_in_radii = settings.centre_offset_in_radii;
        solver.law_relative_sd = settings.law_relative_sd;
        solver.declared_depth_mm = settings.declared_depth_mm;
        return solver;
    }

    [[nodiscard]] PeakFactorSettings<Scalar> peak_settings(CutSide side) const {
        return peak_factor_settings(settings_, side);
    }

    using SpindleAverage = typename SpindleDrive<Scalar>::Average;
    [[nodiscard]] SpindleAverage spindle_average(const typename Averager::Window& window) const {
        SpindleAverage spindle;
        set_spindle(spindle, window, window.spindle_speed_rad_s);
        spindle.acceleration_rad_s2 = window.spindle_acceleration_rad_s2;
        // Two half-windows, each bounded by two counts of ± half a count (variance 1/12 each).
        const Scalar half_s = halved(window.duration_s);
        spindle.acceleration_variance =
            half_s > Scalar(0) ? square(count_rad_ / square(half_s)) * static_cast<Scalar>(0.33L) : Scalar(0);
        return spindle;
    }
    /// What is not common to a window and its last tooth period.
    static void set_spindle(SpindleAverage& spindle, const typename Averager::Means& average, Scalar speed_rad_s) {
        spindle.current_A = average.mean[0];
        spindle.speed_rad_s = speed_rad_s;
        spindle.samples = average.samples;
        spindle.present = (average.present & 1U) != 0U;
    }

    [[nodiscard]] typename FeedDrive<Scalar>::Average axis_average(const typename Averager::Window& window,
                                                                   std::size_t axis) const {
        const auto k = static_cast<Eigen::Index>(axis);
        typename FeedDrive<Scalar>::Average average;
        average.current_A = window.mean[first_current + k];
        average.velocity_mm_s = window.mean[first_velocity + k];
        average.acceleration_mm_s2 = window.slope_per_s[k];
        average.duration_s = window.duration_s;
        average.samples = window.samples;
        average.present = (window.present & (2U << axis)) != 0U;
        return average;
    }

    static constexpr int parts_of_engagement = 3;
    /// A CNC takes up an override within as long; and a force that grows too slowly to be seen has grown little.
    static constexpr Scalar longest_wait_s = static_cast<Scalar>(0.05L);
    /// Of the tangential force: the cutting law itself is no better known.
    static constexpr Scalar least_change = static_cast<Scalar>(0.02L);

    /// Idle torque and friction drift over minutes.
    static constexpr Scalar drifts_move_in_s = static_cast<Scalar>(0.1L);

    /// What is to be done next for the tooth period in work.
    enum class Stage : unsigned char { idle, axes, peaks, show, scale };

    void work_at_once() {
        predict_drifts();
        take_period();
        if (stage_ == Stage::axes) {
            take_axes();
            solver_.solve(search_, asked_, asked_feed_per_tooth_mm_, settings_.side);
            engagement_ = search_.estimate();
            read_whole_engagement();
            take_peaks();
        }
        show();
    }

    /// The next piece of work. True where the estimate is new by it.
    bool work_on(bool is_end_of_period, Moment moment) {
        switch (stage_) {
            case Stage::axes:
                take_axes();
                return false;
            case Stage::peaks:
                take_peaks();
                return false;
            case Stage::show:
                show();
                stage_ = window_.revolutions > 0 && estimate().tooth_periods > 0 ? Stage::scale : Stage::idle;
                return true;
            case Stage::scale:
                set_scale_of_repetition(estimate());
                stage_ = Stage::idle;
                return false;
            case Stage::idle:
                break;
        }
        const bool is_engagement_in_work = search_due_ || !search_.done() || unread_parts_ > 0;
        if (periods_ended_ > 0 && !(has_engagements_turn_ && is_engagement_in_work) && !may_wait(moment)) {
            take_period();
        } else if (is_engagement_in_work) {
            has_waited_ = moment.is_busy && !has_waited_;  // never twice: a slow caller is busy each time
            if (!has_waited_) {
                work_on_engagement(is_end_of_period);
            }
        } else {
            has_engagements_turn_ = false;
            is_resting_ = true;
        }
        return false;
    }

    /// The teeth repeat themselves, and neither the revolution nor a steady moment's wait is over.
    [[nodiscard]] bool may_wait(Moment moment) const {
        if (repetition_.has_changed()) {
            return false;
        }
        const int since_memory = periods_since_memory_ + periods_ended_;
        return since_memory < window_.tooth_periods ||
               (moment.is_steady && Scalar(since_memory) * tooth_period_s_ < longest_wait_s);
    }

    void follow_teeth() {
        const auto& tooth = average_.tooth();
        if (!average_.has_tooth_before() || (tooth.present & average_.tooth_before().present & 1U) == 0U) {
            repetition_.lose();
            return;
        }
        repetition_.follow(tooth.mean[0], average_.tooth_before().mean[0]);
    }

    void set_scale_of_repetition(const CutEstimate<Scalar>& e) {
        const Scalar share = Scalar(1) / Scalar(window_.tooth_periods);
        tooth_period_s_ = window_.duration_s * share;
        const Scalar newtons_per_A = spindle_.torque_constant_Nm_per_A(e.spindle_speed_rad_s) * per_Nm_;
        const bool has_force = e.tangential_N.valid && newtons_per_A > Scalar(0);
        repetition_.set_scale(spindle_.difference_variance_A2(window_.samples * share),
                              has_force ? least_change * e.tangential_N.value / newtons_per_A : Scalar(0));
    }

    /// What does not belong to a tooth period: a value of the solver, or the reading of its solution.
    void work_on_engagement(bool is_end_of_period) {
        if (unread_parts_ == 0) {
            has_engagements_turn_ = false;
            solve_on();
        } else if (!is_end_of_period) {
            has_engagements_turn_ = false;
            read_engagement();
            if (unread_parts_ == 0 && estimate().window_s > Scalar(0) && must_be_shown()) {
                work() = estimate();
                work().tooth_periods = 0;
                stage_ = Stage::peaks;
            }
        }
    }

    /// The solution that has been read cannot wait for the next tooth period: it tells of a higher force, or of less
    /// that is known.
    [[nodiscard]] bool must_be_shown() const {
        const EngagementEstimate<Scalar>& shown = estimate().engagement;
        return peaks_.factors().now > shown_factor_ + least_change * shown_factor_ ||
               (shown.immersion_valid && !engagement_.immersion_valid) || (shown.solved && !engagement_.solved);
    }

    void solve_on() {
        int values = settings_.solver_values_per_step;
        if (search_due_) {
            search_due_ = false;
            if (since_prediction_s_ > drifts_move_in_s) {
                predict_drifts();
            }
            solver_.begin(search_, asked_, asked_feed_per_tooth_mm_, settings_.side);
            --values;
        } else if (search_.done()) {
            return;
        }
        if (solver_.advance(search_, values)) {
            const bool tells = search_.estimate().solved || engagement_.solved;  // nothing again: all is read
            engagement_ = search_.estimate();
            unread_parts_ = tells ? parts_of_engagement : 0;
        }
    }

    /// What every tooth period tells: the tangential force.
    void take_period() {
        average_.read_window(window_);
        CutEstimate<Scalar>& e = work();
        e = {};
        e.tooth_periods = periods_ended_;
        periods_ended_ = 0;
        period_timeout_s_ = Scalar(0);
        stage_ = Stage::show;
        if (window_.revolutions == 0) {
            return;
        }
        period_timeout_s_ = Scalar(3) * window_.duration_s + Scalar(0.02F);
        e.window_s = window_.duration_s;
        e.spindle_speed_rad_s = window_.spindle_speed_rad_s;
        estimate_tangential(e);
        repetition_.start();
        periods_since_memory_ = periods_since_memory_ + e.tooth_periods;
        is_new_revolution_ = periods_since_memory_ >= window_.tooth_periods;
        const bool has_axes = estimate().window_s > Scalar(0);
        const bool axes_are_due = !in_portions() || !has_axes || is_new_revolution_ || !memory_.holds(e.tangential_N);
        if (!axes_are_due) {
            static_cast<FeedForces<Scalar>&>(e) = estimate();
        }
        stage_ = axes_are_due ? Stage::axes : Stage::peaks;
    }

    void estimate_tangential(CutEstimate<Scalar>& e) const {
        if (!(per_Nm_ > Scalar(0))) {
            return;
        }
        SpindleAverage spindle = spindle_average(window_);
        e.tangential_N = spindle_.force_N(spindle, per_Nm_);
        set_spindle(spindle, average_.tooth(), average_.tooth_speed_rad_s());
        e.tooth_tangential_N = spindle_.force_N(spindle, per_Nm_);
    }

    /// The forces along the axes, and the engagement that they ask for.
    void take_axes() {
        CutEstimate<Scalar>& e = work();
        estimate_feed(e);
        e.x_N = axes_[0].force_N(axis_average(window_, 0));
        e.y_N = axes_[1].force_N(axis_average(window_, 1));
        e.z_N = axes_[2].force_N(axis_average(window_, 2));
        estimate_along_feed(e);
        take_up_engagement(e);
        stage_ = Stage::peaks;
    }

    void take_peaks() {
        CutEstimate<Scalar>& e = work();
        if (!(e.feed_mm_s > Scalar(0))) {
            estimate_feed(e);
        }
        e.engagement = engagement_;
        shown_factor_ = peaks_.factors().now;
        tooth_force_.fill(e, peaks_, solver_.table(peaks_.side()));
        stage_ = Stage::show;
    }

    void show() {
        shown_ = 1U - shown_;
        stage_ = Stage::idle;
        has_engagements_turn_ = true;
    }

    /// A part of it.
    void read_engagement() {
        if (unread_parts_ == 3) {
            peaks_.take(engagement_, solver_);
        } else if (unread_parts_ == 2) {
            peaks_.take_changes(solver_);
        } else {
            peaks_.take_bounds(engagement_, solver_, search_.feed());
        }
        --unread_parts_;
    }
    void read_whole_engagement() {
        unread_parts_ = parts_of_engagement;
        while (unread_parts_ > 0) {
            read_engagement();
        }
    }

    void estimate_feed(CutEstimate<Scalar>& e) const {
        using std::sqrt;
        e.feed_mm_s = sqrt(square(window_.mean[first_velocity]) + square(window_.mean[first_velocity + 1]));
        const Scalar teeth_per_rad = settings_.teeth * turns_per_rad<Scalar>;
        const Scalar teeth_per_s = teeth_per_rad * window_.spindle_speed_rad_s;
        e.feed_per_tooth_mm = teeth_per_s > Scalar(0) ? e.feed_mm_s / teeth_per_s : Scalar(0);
    }

    void estimate_along_feed(CutEstimate<Scalar>& e) {
        if (!(e.feed_mm_s > Scalar(0))) {
            return;
        }
        direction_x_ = window_.mean[first_velocity] / e.feed_mm_s;
        direction_y_ = window_.mean[first_velocity + 1] / e.feed_mm_s;
        const auto usable = [](const Measurement<Scalar>& m, Scalar share) {
            return m.valid || square(share) < static_cast<Scalar>(0.001L);
        };
        if (usable(e.x_N, direction_x_) && usable(e.y_N, direction_y_)) {
            e.feed_N.valid = true;
            e.feed_N.value = (e.x_N.valid ? direction_x_ * e.x_N.value : Scalar(0)) +
                             (e.y_N.valid ? direction_y_ * e.y_N.value : Scalar(0));
            e.feed_N.variance = square(direction_x_) * e.x_N.variance + square(direction_y_) * e.y_N.variance;
        }
    }

    void take_up_engagement(const CutEstimate<Scalar>& e) {
        AverageForceMeasurement<Scalar> forces;
        forces.tangential_N = e.tangential_N;
        forces.x_N = e.x_N;
        forces.y_N = e.y_N;
        forces.feed_direction_x = direction_x_;
        forces.feed_direction_y = direction_y_;
        periods_since_memory_ = is_new_revolution_ ? 0 : periods_since_memory_;
        memory_.blend(forces, e.feed_mm_s, tooth_force_.force_exponent(), is_new_revolution_);
        const bool has_changed = !(memory_.revolutions() > Scalar(1));
        const bool may_be_asked = search_.done() && (is_new_revolution_ || has_changed);
        if (!in_portions() || (may_be_asked && asks_anything_new(forces, e))) {
            asked_ = forces;
            asked_.radial_immersion = told_immersion_;
            asked_feed_per_tooth_mm_ = e.feed_per_tooth_mm;
            search_due_ = in_portions();
        }
    }

    /// A solution's answer is known while its question stays: the forces, carried to the present feed, within a third
    /// of a deviation of one window's noise or within least_change, the feed within three tenths, and nothing known
    /// much better.
    [[nodiscard]] bool asks_anything_new(const AverageForceMeasurement<Scalar>& forces,
                                         const CutEstimate<Scalar>& e) const {
        const Scalar more_feed_mm = e.feed_per_tooth_mm - asked_feed_per_tooth_mm_;
        const Scalar most_mm = static_cast<Scalar>(0.3L) * asked_feed_per_tooth_mm_;
        if (told_immersion_.valid || asked_.radial_immersion.valid || !feed_in_one_direction(forces, asked_) ||
            !(more_feed_mm < most_mm && -more_feed_mm < most_mm)) {
            return true;
        }
        // F ∝ f^m: for so small a step its tangent.
        const Scalar carried = Scalar(1) + tooth_force_.force_exponent() * more_feed_mm / asked_feed_per_tooth_mm_;
        const Scalar least_N = least_change * forces.tangential_N.value;
        return has_moved(forces.tangential_N, asked_.tangential_N, carried, least_N) ||
               has_moved(forces.x_N, asked_.x_N, carried, least_N) ||
               has_moved(forces.y_N, asked_.y_N, carried, least_N);
    }
    [[nodiscard]] static bool has_moved(const Measurement<Scalar>& now, const Measurement<Scalar>& asked,
                                        Scalar carried, Scalar least_N) {
        if (!now.valid || !asked.valid) {
            return now.valid != asked.valid;
        }
        constexpr Scalar ninth = static_cast<Scalar>(1.0L / 9.0L);
        const Scalar off_N2 = square(now.value - carried * asked.value);
        return (off_N2 > ninth * now.noise && off_N2 > square(least_N)) ||
               now.variance < halved(square(carried) * asked.variance);
    }

    [[nodiscard]] CutEstimate<Scalar>& work() { return estimates_[1U - shown_]; }

    // What each sample touches comes first, then what each tooth period does; the large tables are last. Near the
    // object's start an access is one instruction.
    Scalar since_period_s_{0};
    Scalar since_prediction_s_{0};  // of the drifts, to the end of the last tooth period
    Scalar period_timeout_s_{0};    // 0: no window
    int periods_ended_ = 0;         // that no estimate has taken up
    bool has_closed_ = false;       // the last call closed a tooth period
    Stage stage_ = Stage::idle;
    std::uint8_t shown_ = 0;   // of estimates_; the other one is in work
    bool is_resting_ = false;  // nothing is in work before the next tooth period
    bool search_due_ = false;
    bool has_engagements_turn_ = false;  // before the next tooth period: where teeth pass fast there is no other time
    bool has_waited_ = false;            // the engagement has, for a caller that was busy
    bool is_new_revolution_ = false;     // no period of the window is one that memory_ has taken
    int unread_parts_ = 0;               // of engagement_, that peaks_ has not seen yet
    int periods_since_memory_ = 0;
    Scalar tooth_period_s_{0};
    Scalar per_Nm_{0};  // F_at of a torque, 1000/R
    Scalar count_rad_{0};
    EncoderAngle<Scalar> encoder_{};
    ToothRepetition<Scalar> repetition_{};
    typename Averager::Window window_{};
    SpindleDrive<Scalar> spindle_{};
    Averager average_{};

    CutEstimatorSettings<Scalar> settings_{};
    typename EngagementSolver<Scalar>::Search search_{};
    EngagementEstimate<Scalar> engagement_{};  // the last that the solver gave
    AverageForceMeasurement<Scalar> asked_{};  // what it is to be given next
    Scalar asked_feed_per_tooth_mm_{0};
    std::array<FeedDrive<Scalar>, 3> axes_{};
    EngagementPeaks<Scalar> peaks_{};
    ToothForce<Scalar> tooth_force_{};
    Scalar shown_factor_{0};  // of the peaks, in the newest estimate
    ForceMemory<Scalar> memory_{};
    Measurement<Scalar> told_immersion_{};
    Scalar direction_x_{1};
    Scalar direction_y_{0};
    std::array<CutEstimate<Scalar>, 2> estimates_{};
    typename Averager::Window air_window_{};
    int air_periods_ = 0;
    CuttingLaw<Scalar> law_{};
    EngagementSolver<Scalar> solver_{};
};

}  // namespace millforce::estimation
