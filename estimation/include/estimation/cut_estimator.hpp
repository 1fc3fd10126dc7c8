#pragma once

#include "estimation/encoder_angle.hpp"
#include "estimation/engagement_peaks.hpp"
#include "estimation/engagement_solver.hpp"
#include "estimation/feed_drive.hpp"
#include "estimation/force_memory.hpp"
#include "estimation/spindle_drive.hpp"
#include "estimation/synchronous_average.hpp"

/// From drive signals to forces, engagement and peak force: the chain that the tick runs.
///
///   encoder → averages over tooth and revolution → F_at, F_x, F_y → R_r, a_p → peak of one tooth, total, threshold
///
/// One call of add() per drive sample; work is done when a tooth period ends, the rest is accumulation.
/// No heap, no clock; about 12 KiB with its tables in float. Not thread-safe.

namespace millforce::estimation {

template <typename Scalar>
struct CutEstimatorSettings {
    Scalar teeth{4};
    Scalar cutter_radius_mm{5};
    Scalar helix_rad{0};
    Scalar runout_mm{0};             ///< largest difference of two teeth's radii
    CutSide side = CutSide::unknown;
    Scalar centre_offset_in_radii{0};
    Scalar largest_depth_mm{10};     ///< longest depth of cut of the tool's flutes
    Scalar nominal_feed_per_tooth_mm{static_cast<Scalar>(0.05L)};
    Scalar assumed_immersion{1};     ///< used for peaks (never to speed up) until an immersion is known
    Scalar surge_immersion{0};       ///< see FeedControllerParameters::surge_radial_immersion
    Scalar turn_immersion{0};        ///< … and turn_radial_immersion
    Scalar tooth_force_limit_N{1000};
    Scalar declared_depth_mm{0};     ///< axial depth that the program tells; 0: not told
    Scalar law_relative_sd{static_cast<Scalar>(0.02L)};
    Scalar min_samples{12};
    int solver_values_per_step{0};   ///< of J in one add(); 0: all at once (see add())
    std::uint32_t encoder_counts_per_rev = 4096;
};

/// One drive sample, as plain numbers. `present`: bit 0 spindle current, bits 1–3 the axes x, y, z.
template <typename Scalar>
struct DriveSignals {
    Scalar spindle_current_A{0};
    std::array<Scalar, 3> axis_current_A{};
    std::array<Scalar, 3> axis_velocity_mm_s{};
    std::uint32_t present = 0;
};

template <typename Scalar>
struct CutEstimate {
    Measurement<Scalar> tangential_N{};        ///< F_at over the window (whole revolutions)
    Measurement<Scalar> tooth_tangential_N{};  ///< F_at over the last tooth period alone
    Measurement<Scalar> x_N{};                 ///< along the machine's axes, on the workpiece
    Measurement<Scalar> y_N{};
    Measurement<Scalar> z_N{};
    Measurement<Scalar> feed_N{};  ///< F_ax, along the feed; not valid where a needed axis stands
    EngagementEstimate<Scalar> engagement{};

    Measurement<Scalar> tooth_force_N{};  ///< peak in-plane force of one tooth; without an immersion its upper bound
    bool tooth_force_is_bound = false;         ///< tooth_force_N is the most that it can be, and may be far above it
    Scalar least_tooth_force_N{0};  ///< the least that it can be: F_at shared by the widest cut
    Scalar worst_tooth_force_N{0};        ///< the same with an assumed immersion where none is known
    Scalar tangential_growth_N_per_s{0};  ///< of F_at over the last revolution, where it is significant; ≥ 0
    Scalar newest_tangential_N{0};        ///< F_at of the window, or of the last tooth where that is clearly higher
    Scalar cutting_share{1};            ///< of F_at: what is not edge force
    Scalar feed_exponent{static_cast<Scalar>(0.75L)};  ///< 1 + p_s: cutting force ∝ f^(1+p_s)
    /// The force of a tooth at another immersion, at the same depth and feed.
    struct Change {
        Scalar ratio{1};          ///< over its force now
        Scalar cutting_share{1};  ///< of it: what is not edge force
    };
    Scalar section_mm2{0};        ///< width × depth that F_at stands for at the known K_s; 0: no F_at
    Scalar section_noise_mm2{0};  ///< of it, what differs from one window to the next
    Change surge{};  ///< to settings.surge_immersion, where that is larger than now
    Change turn{};   ///< to settings.turn_immersion
    Scalar feed_mm_s{0};  ///< path speed over the window
    Scalar feed_per_tooth_mm{0};
    Scalar spindle_speed_rad_s{0};
    Scalar window_s{0};
};

template <typename Scalar>
class CutEstimator {
  public:
    CutEstimator() = default;
    CutEstimator(const CutEstimatorSettings<Scalar>& settings, const SpindleDriveParameters<Scalar>& spindle,
                 const std::array<FeedDriveParameters<Scalar>, 3>& axes, const CuttingLaw<Scalar>& law)
        : settings_(settings),
          law_(law),
          encoder_(settings.encoder_counts_per_rev),
          average_({static_cast<int>(settings.teeth), settings.min_samples}),
          spindle_(spindle),
          per_Nm_(settings.cutter_radius_mm > Scalar(0) ? Scalar(1000) / settings.cutter_radius_mm : Scalar(0)),
          count_rad_(Scalar(2) * pi<Scalar> / static_cast<Scalar>(settings.encoder_counts_per_rev)),
          axes_{FeedDrive<Scalar>(axes[0]), FeedDrive<Scalar>(axes[1]), FeedDrive<Scalar>(axes[2])},
          solver_(law, solver_settings(settings), settings.side),
          peaks_(law, {peak_settings(settings.side), settings.largest_depth_mm, settings.assumed_immersion,
                       settings.surge_immersion, settings.turn_immersion}) {}

    /// Adds one sample. Returns true when estimate() is new: a tooth period ended.
    ///
    /// With solver_values_per_step each call does one piece of work at most, so that none is long: the forces at the end of
    /// a tooth period, the peaks with the engagement that is known then (the estimate is new), some values of the solver,
    /// when it is done the tables at the new engagement, and the peaks anew. The solver is then taken up once a revolution,
    /// or as soon as the forces have left those that it was given last. (Where tooth periods end so fast that their peaks
    /// are still waiting at the next end, two pieces are done there.)
    bool add(Scalar dt_s, std::uint32_t count, std::uint32_t index_count, std::uint8_t index_number,
             const DriveSignals<Scalar>& signals) {
        const EncoderReading<Scalar> reading = encoder_.update(count, index_count, index_number);
        since_period_s_ += dt_s;
        since_prediction_s_ += dt_s;
        if (reading.event == EncoderEvent::reversed || reading.event == EncoderEvent::too_fast ||
            reading.event == EncoderEvent::index_slipped || reading.event == EncoderEvent::index_found) {
            average_.restart();
            return false;
        }
        const int completed = average_.add(dt_s, reading.turned_rev, reading.angle_rev, packed(signals), signals.present);
        if (completed == 0) {
            return work_on();
        }
        since_period_s_ = Scalar(0);
        if (!in_portions()) {
            predict_drifts();
        }
        const bool was_waiting = peaks_due_ && !has_peaks_;
        has_peaks_ = false;
        update();
        if (was_waiting) {
            read_engagement();
            return work_on();
        }
        return !peaks_due_;
    }

    /// An immersion that another method tells of the present cut, for the estimates to come; not valid: none.
    void tell_immersion(const Measurement<Scalar>& radial_immersion) { told_immersion_ = radial_immersion; }

    /// The encoder failed or the samples stopped: start anew, keep what was learnt in air.
    void restart() {
        encoder_.reset();
        average_.restart();
        estimate_ = {};
        engagement_ = {};
        search_.cancel();
        search_due_ = false;
        peaks_due_ = false;
        engagement_is_new_ = true;
    }

    /// The tool has been in air up to now: re-zero the spindle's idle torque and the moving axes' friction. It is done
    /// with the window one revolution ago: the first contact must not be taken for drift before it is known as contact.
    /// Call once per new estimate while in air; leave_air() when that ends. Returns whether it was done.
    bool rezero() {
        if (window_.revolutions == 0) {
            return false;
        }
        air_periods_ = air_periods_ + 1;
        if (air_periods_ < window_.revolutions * static_cast<int>(settings_.teeth)) {
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
        return window_.revolutions > 0 && rests(window_.mean[4]) && rests(window_.mean[5]) && rests(window_.mean[6]);
    }

    [[nodiscard]] const CutEstimate<Scalar>& estimate() const { return estimate_; }
    [[nodiscard]] Scalar since_period_s() const { return since_period_s_; }
    [[nodiscard]] Scalar spindle_drift_Nm() const { return spindle_.drift_Nm(); }
    [[nodiscard]] Scalar friction_scale(std::size_t axis, bool positive) const {
        return axes_[axis].friction_scale(positive);
    }
    /// The total force's peak and its threshold, for the operator's eye and for the record: F_at κ and F_tooth,max g.
    /// Not for the tick: about 300 single-tooth forces.
    struct TotalForce {
        Scalar peak_N{0};
        Scalar limit_N{0};
    };
    [[nodiscard]] TotalForce total_force() const {
        const PeakFactors<Scalar> factors =
            peak_factors(law_, peak_settings(peaks_.side()), peaks_.now().radial_immersion, peaks_.depth_mm());
        const Scalar peak_per_tooth = factors.threshold_factor();
        return {estimate_.worst_tooth_force_N * peak_per_tooth, settings_.tooth_force_limit_N * peak_per_tooth};
    }

  private:
    static constexpr int channels = 7;
    static constexpr int first_velocity = 4;
    using Averager = SynchronousAverage<Scalar, channels, first_velocity>;
    using Signals = typename Averager::Signals;

    [[nodiscard]] bool in_portions() const { return settings_.solver_values_per_step > 0; }

    void predict_drifts() {
        spindle_.predict(since_prediction_s_);
        for (FeedDrive<Scalar>& axis : axes_) {
            axis.predict(since_prediction_s_);
        }
        since_prediction_s_ = Scalar(0);
    }

    [[nodiscard]] static EngagementSolverSettings<Scalar> solver_settings(const CutEstimatorSettings<Scalar>& settings) {
        EngagementSolverSettings<Scalar> solver;
        solver.teeth = settings.teeth;
        solver.centre_offset_in_radii = settings.centre_offset_in_radii;
        solver.law_relative_sd = settings.law_relative_sd;
        solver.declared_depth_mm = settings.declared_depth_mm;
        return solver;
    }

    [[nodiscard]] PeakFactorSettings<Scalar> peak_settings(CutSide side) const {
        PeakFactorSettings<Scalar> peak;
        peak.teeth = settings_.teeth;
        peak.cutter_radius_mm = settings_.cutter_radius_mm;
        peak.helix_rad = settings_.helix_rad;
        peak.nominal_feed_per_tooth_mm = settings_.nominal_feed_per_tooth_mm;
        peak.side = side;
        peak.centre_offset_in_radii = settings_.centre_offset_in_radii;
        return peak;
    }

    [[nodiscard]] static Signals packed(const DriveSignals<Scalar>& signals) {
        Signals vector;
        vector << signals.spindle_current_A, signals.axis_current_A[0], signals.axis_current_A[1],
            signals.axis_current_A[2], signals.axis_velocity_mm_s[0], signals.axis_velocity_mm_s[1],
            signals.axis_velocity_mm_s[2];
        return vector;
    }

    using SpindleAverage = typename SpindleDrive<Scalar>::Average;
    [[nodiscard]] SpindleAverage spindle_average(const typename Averager::Window& window) const {
        SpindleAverage spindle;
        set_spindle(spindle, window);
        spindle.acceleration_rad_s2 = window.spindle_acceleration_rad_s2;
        // Two half-windows, each bounded by two counts of ± half a count (variance 1/12 each).
        const Scalar half_s = Scalar(0.5F) * window.duration_s;
        spindle.acceleration_variance =
            half_s > Scalar(0) ? square(count_rad_ / square(half_s)) * static_cast<Scalar>(0.33L) : Scalar(0);
        return spindle;
    }
    /// What is not common to a window and its last tooth period.
    static void set_spindle(SpindleAverage& spindle, const typename Averager::Average& average) {
        spindle.current_A = average.mean[0];
        spindle.speed_rad_s = average.spindle_speed_rad_s;
        spindle.samples = average.samples;
        spindle.present = (average.present & 1U) != 0U;
    }

    [[nodiscard]] typename FeedDrive<Scalar>::Average axis_average(const typename Averager::Window& window,
                                                                      std::size_t axis) const {
        const auto k = static_cast<Eigen::Index>(axis);
        typename FeedDrive<Scalar>::Average average;
        average.current_A = window.mean[1 + k];
        average.velocity_mm_s = window.mean[first_velocity + k];
        average.acceleration_mm_s2 = window.slope_per_s[k];
        average.duration_s = window.duration_s;
        average.samples = window.samples;
        average.present = (window.present & (2U << axis)) != 0U;
        return average;
    }

    void update() {
        average_.read_window(window_);
        estimate_ = {};
        if (window_.revolutions == 0) {
            return;
        }
        estimate_.window_s = window_.duration_s;
        estimate_.spindle_speed_rad_s = window_.spindle_speed_rad_s;
        estimate_tangential();
        estimate_.x_N = axes_[0].force_N(axis_average(window_, 0));
        estimate_.y_N = axes_[1].force_N(axis_average(window_, 1));
        estimate_.z_N = axes_[2].force_N(axis_average(window_, 2));
        estimate_feed();
        take_up_engagement();
    }

    void estimate_tangential() {
        if (!(per_Nm_ > Scalar(0))) {
            return;
        }
        SpindleAverage spindle = spindle_average(window_);
        estimate_.tangential_N = spindle_.force_N(spindle, per_Nm_);
        set_spindle(spindle, average_.tooth());
        estimate_.tooth_tangential_N = spindle_.force_N(spindle, per_Nm_);
    }

    /// The next piece of work. True where the estimate is new by it.
    bool work_on() {
        if (engagement_is_new_) {
            read_engagement();
            peaks_due_ = peaks_due_ || estimate_.window_s > Scalar(0);
            return false;
        }
        if (peaks_due_) {
            peaks_due_ = false;
            has_peaks_ = true;
            estimate_.engagement = engagement_;
            estimate_peaks();
            return true;
        }
        if (search_due_) {
            search_due_ = false;
            predict_drifts();
            solver_.begin(search_, asked_, estimate_.feed_per_tooth_mm, settings_.side);
        } else if (search_.done() || !solver_.advance(search_, settings_.solver_values_per_step)) {
            return false;
        }
        if (search_.done()) {
            engagement_ = search_.estimate();
            engagement_is_new_ = true;
        }
        return false;
    }

    void read_engagement() {
        if (engagement_is_new_) {
            peaks_.take(engagement_, solver_, estimate_.feed_per_tooth_mm);
            engagement_is_new_ = false;
        }
    }

    void estimate_feed() {
        using std::sqrt;
        const Scalar v_x = window_.mean[first_velocity];
        const Scalar v_y = window_.mean[first_velocity + 1];
        const Scalar speed = sqrt(square(v_x) + square(v_y));
        estimate_.feed_mm_s = speed;
        const Scalar teeth_per_s = settings_.teeth * window_.spindle_speed_rad_s / (Scalar(2) * pi<Scalar>);
        estimate_.feed_per_tooth_mm = teeth_per_s > Scalar(0) ? speed / teeth_per_s : Scalar(0);
        if (!(speed > Scalar(0))) {
            return;
        }
        direction_x_ = v_x / speed;
        direction_y_ = v_y / speed;
        const auto usable = [](const Measurement<Scalar>& m, Scalar share) {
            return m.valid || square(share) < static_cast<Scalar>(0.001L);
        };
        if (usable(estimate_.x_N, direction_x_) && usable(estimate_.y_N, direction_y_)) {
            estimate_.feed_N.valid = true;
            estimate_.feed_N.value = (estimate_.x_N.valid ? direction_x_ * estimate_.x_N.value : Scalar(0)) +
                                     (estimate_.y_N.valid ? direction_y_ * estimate_.y_N.value : Scalar(0));
            estimate_.feed_N.variance = square(direction_x_) * estimate_.x_N.variance +
                                        square(direction_y_) * estimate_.y_N.variance;
        }
    }

    void take_up_engagement() {
        AverageForceMeasurement<Scalar> forces;
        forces.tangential_N = estimate_.tangential_N;
        forces.x_N = estimate_.x_N;
        forces.y_N = estimate_.y_N;
        forces.feed_direction_x = direction_x_;
        forces.feed_direction_y = direction_y_;
        periods_since_memory_ = periods_since_memory_ + 1;
        const bool is_new_revolution = periods_since_memory_ >= window_.revolutions * static_cast<int>(settings_.teeth);
        periods_since_memory_ = is_new_revolution ? 0 : periods_since_memory_;
        AverageForceMeasurement<Scalar> blended =
            memory_.blend(forces, estimate_.feed_mm_s, last_exponent_, is_new_revolution);
        blended.radial_immersion = told_immersion_;
        peaks_due_ = true;
        if (!in_portions()) {
            solver_.solve(search_, blended, estimate_.feed_per_tooth_mm, settings_.side);
            engagement_ = search_.estimate();
            engagement_is_new_ = true;
            read_engagement();
            work_on();
            return;
        }
        const bool has_changed = !(memory_.revolutions() > Scalar(1));
        if (search_.done() && (is_new_revolution || has_changed)) {
            asked_ = blended;
            search_due_ = true;
        }
    }

    /// The peaks are worked out with the immersion that is known, else the last one, else the assumed one.
    void estimate_peaks() {
        using std::sqrt;
        const auto& table = solver_.table(peaks_.side());
        const auto feed = table.feed(estimate_.feed_per_tooth_mm);
        const auto model = table.forces(peaks_.here_node(), feed);
        const bool has_model = model.tangential_N > Scalar(0) && estimate_.feed_per_tooth_mm > Scalar(0);
        estimate_.cutting_share = has_model ? model.cutting_tangential_N / model.tangential_N : Scalar(1);
        estimate_.feed_exponent = Scalar(1) + law_.p_s;
        last_exponent_ = estimate_.feed_exponent * estimate_.cutting_share;
        if (!estimate_.tangential_N.valid) {
            return;
        }
        const Scalar newest_N = follow_growth();
        if (has_model) {
            const Scalar width_per_F_mm_N =
                peaks_.now().radial_immersion * settings_.cutter_radius_mm / model.tangential_N;
            estimate_.section_mm2 = estimate_.tangential_N.value * width_per_F_mm_N;
            estimate_.section_noise_mm2 = sqrt(estimate_.tangential_N.noise) * width_per_F_mm_N;
        }
        estimate_tooth_force(newest_N);
        if (has_model) {
            const Scalar now_N = model.tangential_N * peaks_.factors().now;
            if (peaks_.surge_is_wider()) {
                estimate_.surge = change_to(table.forces(peaks_.surge_node(), feed), peaks_.factors().surge, now_N);
            }
            if (peaks_.turn_is_wider()) {
                estimate_.turn = change_to(table.forces(peaks_.turn_node(), feed), peaks_.factors().turn, now_N);
            }
        }
    }

    /// F_at of the window, or of the last tooth where that is clearly higher; and how fast it grows then.
    Scalar follow_growth() {
        using std::sqrt;
        const Measurement<Scalar>& window = estimate_.tangential_N;
        const Measurement<Scalar>& tooth = estimate_.tooth_tangential_N;
        const bool has_risen = tooth.valid && tooth.value - window.value > Scalar(2) * sqrt(tooth.variance);
        estimate_.newest_tangential_N = has_risen ? tooth.value : window.value;
        const Scalar half_window_s = Scalar(0.5F) * window_.duration_s;
        if (has_risen && half_window_s > Scalar(0)) {
            // The window's middle is half a window old, the last tooth's nearly now.
            estimate_.tangential_growth_N_per_s = (tooth.value - window.value) / half_window_s;
        }
        return estimate_.newest_tangential_N;
    }

    void estimate_tooth_force(Scalar newest_N) {
        const EngagementEstimate<Scalar>& e = estimate_.engagement;
        const typename EngagementPeaks<Scalar>::Factors& factors = peaks_.factors();
        const Measurement<Scalar>& window = estimate_.tangential_N;
        const Scalar runout = runout_factor();
        estimate_.worst_tooth_force_N = newest_N * factors.now * runout;
        estimate_.least_tooth_force_N = newest_N * factors.slot;
        const auto bound_by = [&](Scalar bound) {
            const Scalar ratio = runout * (bound > factors.now ? bound : factors.now);
            estimate_.tooth_force_N = {true, newest_N * ratio, square(ratio) * window.variance, Scalar(0)};
            estimate_.tooth_force_is_bound = true;
        };
        if (e.immersion_valid) {
            const Scalar factor_sd = (factors.at_low - factors.at_high) * static_cast<Scalar>(1.0L / 3.92L);
            estimate_.tooth_force_N = {true, estimate_.worst_tooth_force_N,
                                       square(runout) * (square(factors.now) * window.variance +
                                                         square(newest_N) * (square(factor_sd) + square(factors.by_K_s))),
                                       Scalar(0)};
        } else if (e.solved && e.depth_at_high_mm > Scalar(0)) {
            // No estimate of the immersion, but a bound: the narrowest cut and the smallest depth that the forces allow
            // load one tooth most. Where even that is far from the limit, the force is known well enough.
            bound_by(factors.bound);
        } else if (!e.solved && !estimate_.x_N.valid && !estimate_.y_N.valid) {
            // Axes too slow to show a force would stay so for ever without a bound: the narrowest and shallowest cut.
            bound_by(factors.narrowest);
        }
    }

    /// The tooth that stands out furthest takes (f_z + e) of chip where the mean takes f_z.
    [[nodiscard]] Scalar runout_factor() const {
        using elementary::exp;
        using elementary::log;
        if (!(settings_.runout_mm > Scalar(0)) || !(estimate_.feed_per_tooth_mm > Scalar(0))) {
            return Scalar(1);
        }
        const Scalar most = settings_.teeth;  // more than all teeth's chips one tooth cannot take
        const Scalar chip = clamp(Scalar(1) + settings_.runout_mm / estimate_.feed_per_tooth_mm, Scalar(1), most);
        return exp(last_exponent_ * log(chip));
    }

    [[nodiscard]] static typename CutEstimate<Scalar>::Change change_to(
        const typename EngagementSolver<Scalar>::Table::Forces& forces_then, Scalar factor, Scalar tooth_N_per_mm_now) {
        return {forces_then.tangential_N * factor / tooth_N_per_mm_now,
                forces_then.cutting_tangential_N / forces_then.tangential_N};
    }

    // What each sample touches comes first: near the object's start an access is one instruction.
    Scalar since_period_s_{0};
    Scalar since_prediction_s_{0};
    bool search_due_ = false;
    bool peaks_due_ = false;
    bool has_peaks_ = false;         // of this tooth period's forces
    bool engagement_is_new_ = true;  // peaks_ has not seen it yet

    CutEstimatorSettings<Scalar> settings_{};
    CuttingLaw<Scalar> law_{};
    EncoderAngle<Scalar> encoder_{};
    Averager average_{};
    SpindleDrive<Scalar> spindle_{};
    Scalar per_Nm_{0};     // F_at of a torque, 1000/R
    Scalar count_rad_{0};
    std::array<FeedDrive<Scalar>, 3> axes_{};
    EngagementSolver<Scalar> solver_{};
    typename EngagementSolver<Scalar>::Search search_{};
    EngagementEstimate<Scalar> engagement_{};  // the last that the solver gave
    AverageForceMeasurement<Scalar> asked_{};      // what it is to be given next
    EngagementPeaks<Scalar> peaks_{};

    typename Averager::Window window_{};
    typename Averager::Window air_window_{};
    int air_periods_ = 0;
    ForceMemory<Scalar> memory_{};
    Measurement<Scalar> told_immersion_{};
    int periods_since_memory_ = 0;
    Scalar last_exponent_{Scalar(0.75F)};
    CutEstimate<Scalar> estimate_{};
    Scalar direction_x_{1};
    Scalar direction_y_{0};
};

}  // namespace millforce::estimation
