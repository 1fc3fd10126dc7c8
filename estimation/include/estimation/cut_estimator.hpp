// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "estimation/drives/machine_drives.hpp"
#include "estimation/engagement/depth_memory.hpp"
#include "estimation/engagement/engagement_solver.hpp"
#include "estimation/engagement/force_memory.hpp"
#include "estimation/engagement/law_doubt.hpp"
#include "estimation/signal/encoder_angle.hpp"
#include "estimation/signal/revolution_harmonic.hpp"
#include "estimation/signal/synchronous_average.hpp"
#include "estimation/tooth_force/engagement_peaks.hpp"
#include "estimation/tooth_force/runout_meter.hpp"
#include "estimation/tooth_force/tooth_force.hpp"
#include "estimation/tooth_force/total_force.hpp"

#include <array>
#include <cstdint>

/// From drive signals to forces, engagement and peak force: the chain that the tick runs.
///
///   encoder → averages over tooth and revolution → F_at, F_x, F_y → R_r, a_p → peak of one tooth, total, threshold
///
/// add() takes in one drive sample and is short. All else is work beside it, which begins when a tooth period has
/// ended:
///
///     estimator.add(...);                                 // each sample
///     while (estimator.work_due()) estimator.work();      // a computer: at once. A chip: slice by slice, in idle time
///
/// work() does one bounded slice: the forces of the period, then some steps of the engagement solver, at last the
/// peaks; with the last slice the estimate is published. The first slice takes a snapshot of the averages. So the
/// estimate has the same bits however many slices it was made in, and however many samples came between them. Tooth
/// periods that end while an estimate is in work are merged: they are in the averages of the next.
///
/// No heap, no clock; about 12 KiB with its tables in float. Not thread-safe. Bodies: cut_estimator_impl.hpp.

namespace millforce::estimation {

template <typename Scalar>
class CutEstimator {
  public:
    /// Steps of the solver in one slice: with it a slice is no longer than the others, some 3 000 instructions in
    /// float.
    static constexpr int solver_steps_per_slice = 4;

    CutEstimator(const CutEstimatorSettings<Scalar>& settings, const SpindleDriveParameters<Scalar>& spindle,
                 const std::array<FeedDriveParameters<Scalar>, 3>& axes, const CuttingLaw<Scalar>& law);

    /// Adds one sample.
    void add(Scalar dt_s, std::uint32_t count, std::uint32_t index_count, std::uint8_t index_number,
             const DriveSignals<Scalar>& signals);

    [[nodiscard]] bool work_due() const { return stage_ != Stage::idle || periods_ended_ > 0; }
    /// One slice. Returns true when estimate() is new by it.
    bool work(int solver_steps = solver_steps_per_slice);

    /// An immersion of the present cut from another method, for the estimates that begin from now on; not valid: none.
    void set_immersion_of_other_method(const Measurement<Scalar>& radial_immersion) { other_ = radial_immersion; }

    /// The encoder failed or the samples stopped: forgets the cut, keeps what was learnt in air.
    void restart();

    /// The cut of estimate() neither begins nor ends: its depth is used later, where the forces do not determine it,
    /// and whether they contradict the law (law_doubt.hpp). Call once per new estimate.
    void learn_in_cut();
    /// The tool is in air: the law may hold in the next cut.
    void end_cut() { law_doubt_.forget(); }

    /// The tool has been in air up to now: re-zero the spindle's idle torque and the moving axes' friction, and learn
    /// how noisy their currents are. Uses the window from one revolution earlier, so that first contact is not taken
    /// for drift. `may_cut`: nothing but the forces says that this is air. Call once per new estimate while in air;
    /// leave_air() when that ends. Returns whether it was done.
    bool rezero(bool may_cut);
    /// The last re-zeroing found more torque than the idle torque can be, and this may be a cut: one so light that its
    /// noise hides it. Then the idle torque stays as it was. Returns whether it was so.
    bool find_hidden_cut() { return drives_.spindle.find_hidden_cut(); }
    void leave_air();
    /// The signals were wrong: nothing that they taught of the drives in air holds.
    void forget_air() {
        leave_air();
        drives_.forget();
    }
    /// What was learnt in air, up to now: for the estimator of the next tool, before its first sample.
    [[nodiscard]] MachineDrives<Scalar> drives() const;
    void set_drives(const MachineDrives<Scalar>& learnt) { drives_ = learnt; }
    /// Time passes without samples.
    void let_drives_drift(Scalar passed_s) { drives_.predict(passed_s); }
    /// In the mean of the window no axis moved: nothing can be cut.
    [[nodiscard]] bool axes_rest() const {
        constexpr Scalar rest_mm_s = literal<Scalar>(0.1L);
        return axes_are_slower_than(rest_mm_s);
    }
    /// Each in the mean of the window.
    [[nodiscard]] bool axes_are_slower_than(Scalar mm_s) const;

    [[nodiscard]] const CutEstimate<Scalar>& estimate() const { return estimate_; }
    [[nodiscard]] Scalar since_period_s() const { return since_period_s_; }
    /// Tooth periods still end: the last one is no longer ago than three windows.
    [[nodiscard]] bool spindle_turns() const;
    /// The last re-zeroing found an idle torque that its calibration does not leave open: there is no F_at.
    [[nodiscard]] bool spindle_is_implausible() const { return drives_.spindle.is_implausible(); }
    [[nodiscard]] Scalar spindle_drift_Nm() const { return drives_.spindle.drift_Nm(); }
    [[nodiscard]] Scalar friction_scale(std::size_t axis, bool positive) const {
        return drives_.axes[axis].friction_scale(positive);
    }
    /// Input of TotalForce, for a display of the total force of estimate().
    [[nodiscard]] TotalForceInput<Scalar> total_force_input() const {
        return {estimate_.worst_tooth_force_N, peaks_.now().radial_immersion, peaks_.depth_mm(), peaks_.side()};
    }

  private:
    using Averager = SynchronousAverage<Scalar, DriveSignals<Scalar>::channels, DriveSignals<Scalar>::velocities>;
    using Window = typename Averager::Window;

    /// What the next slice does.
    enum class Stage : unsigned char { idle, engagement, peaks, bound };

    [[nodiscard]] typename SpindleDrive<Scalar>::Average spindle_average(const Window& window) const;
    [[nodiscard]] typename SpindleDrive<Scalar>::Average spindle_average_of_tooth(const Window& window) const;
    [[nodiscard]] static typename FeedDrive<Scalar>::Average axis_average(const Window& window, std::size_t axis);

    [[nodiscard]] bool begin_estimate();
    void estimate_forces();
    void estimate_along_feed();
    void estimate_tooth_change();
    void begin_engagement(Scalar passed_s);
    void publish();
    void rezero_drives(bool may_cut);
    void learn_noise();
    void follow_turning_force(Scalar dt_s, const EncoderReading<Scalar>& reading, const DriveSignals<Scalar>& signals);
    [[nodiscard]] TurningForce<Scalar> turning_force(const typename RevolutionHarmonic<Scalar>::Mean& seen,
                                                     const Window& window) const;
    void learn_air_of_runout();
    void learn_runout();

    EncoderAngle<Scalar> encoder_;
    Averager average_;
    RevolutionHarmonic<Scalar> harmonic_;
    Scalar since_period_s_{0};
    Scalar since_prediction_s_{0};  // of the drifts, to the end of the last tooth period
    int periods_ended_ = 0;         // that no estimate has taken up

    Stage stage_ = Stage::idle;
    Window window_{};  // the snapshot
    typename RevolutionHarmonic<Scalar>::Mean turning_{};
    CutEstimate<Scalar> in_work_{};
    typename EngagementSolver<Scalar>::Search search_{};
    CutEstimate<Scalar> estimate_{};

    CutEstimatorSettings<Scalar> settings_{};
    Scalar per_Nm_{0};  // F_at of a torque, 1000/R
    MachineDrives<Scalar> drives_;
    ForceMemory<Scalar> memory_{};
    DepthMemory<Scalar> depth_{};
    LawDoubt law_doubt_{};
    int periods_since_memory_ = 0;
    Scalar direction_x_{1};
    Scalar direction_y_{0};
    Measurement<Scalar> other_{};
    EngagementPeaks<Scalar> peaks_{};
    ToothForce<Scalar> tooth_force_{};
    RunoutMeter<Scalar> runout_;
    Window air_window_{};
    TurningForce<Scalar> air_turning_{};
    int air_periods_ = 0;
    CuttingLaw<Scalar> law_{};
    EngagementSolver<Scalar> solver_{};
};

}  // namespace millforce::estimation
