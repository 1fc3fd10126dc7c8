// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "control/feed_controller.hpp"
#include "estimation/cut_estimator.hpp"
#include "firmware/carried_immersion.hpp"
#include "firmware/drift_doubt.hpp"
#include "firmware/load_answer.hpp"
#include "firmware/parameters.hpp"
#include "firmware/settled_feed.hpp"
#include "firmware/signal_supervisor.hpp"
#include "firmware/surface_monitor.hpp"
#include "firmware/wide_band_monitor.hpp"
#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"

/// The tick: one drive sample in, one feed override out. The same class runs on the drive controller, in the daemon and
/// in the simulation.
///
///     tick.take(sample);            // averages
///     finish_estimate(tick);        // where a tooth period has ended: the estimate of its cut, some microseconds
///     send(tick.answer(program));   // the law, the override
///     finish_work(tick);            // the wide band's evaluation, up to some milliseconds
///
/// A computer does it in this order; step_and_work() does all four. A chip on which an estimate takes longer than a
/// tick sends `tick.step(sample, program)`, averages and law, and calls `if (tick.work_due()) tick.work();` in its main
/// loop: one bounded slice each time. Its law uses the newest estimate that is complete. The estimate does not depend
/// on how its work was sliced; tooth periods that end meanwhile are merged into the next (cut_estimator.hpp).
///
/// The tick re-zeroes in air by itself: in a rapid, and while the controller's state is `air` and the torque is near
/// its idle value, each new revolution corrects the idle torque and the friction of the moving axes. So a cut cannot be
/// taken for drift: contact ends it at once, and the drift per second is bounded by its Kalman gain. As long as the
/// idle torque is known no better than by its calibration, a light cut looks like drift, and no feed move teaches: the
/// first time takes a rapid or axes at rest, some five revolutions of it.
///
/// A supervisor beside it holds the signals against each other (signal_supervisor.hpp); what it finds is a fault.
///
/// A WideBand monitor runs next to it (NoWideBand if memory is short): an immersion from force drops enters the solver
/// as one more measurement of the engagement (carried_immersion.hpp). An evaluation of the monitor is one slice, of up
/// to some milliseconds on a desktop processor.
///
/// No heap, no clock. One thread. Bodies: tick_impl.hpp; instances for float and estimation::Fixed: firmware/src.

namespace millforce::firmware {

/// What a tick has learnt of the machine, whatever the tool.
template <typename Scalar>
struct MachineKnowledge {
    estimation::MachineDrives<Scalar> drives;
    bool was_rezeroed = false;
};

template <typename Scalar, typename WideBand = WideBandMonitor<Scalar>>
class ForceControlTick {
  public:
    explicit ForceControlTick(const Parameters<Scalar>& parameters);

    /// A new drive sample.
    void take(const hal::DriveSample& sample);
    /// The override, by the newest estimate. Once for each sample.
    hal::FeedOverride answer(const hal::ProgramStatus& program);

    /// take() and answer() at once.
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program);

    /// What a part map says of the way ahead, before answer(); stays until the next call. None by default.
    void set_way_ahead(const control::WayAhead<Scalar>& way) { input_.way = way; }
    /// There is an estimate that no answer has seen yet.
    [[nodiscard]] bool has_new_estimate() const { return has_new_estimate_; }
    /// The estimate belongs to the present feed, however late the spindle current comes.
    [[nodiscard]] bool feed_is_settled() const { return settled_feed_.is_settled(); }

    /// No drive sample came for `silent_s`: the tick still runs and gives its heartbeat.
    hal::FeedOverride step_without_sample(float silent_s, float dt_s, const hal::ProgramStatus& program);

    /// Only with the axes at rest. What was learnt in air is forgotten where the fault says that it was none.
    void reset_fault();
    /// No axis moves, in the mean of the newest revolution: each is slower than half the programmed feed at the
    /// smallest override, or than hal::at_rest_mm_s. False where the spindle does not turn.
    [[nodiscard]] bool axes_rest() const;

    /// For the tick of the next tool, before its first sample.
    [[nodiscard]] MachineKnowledge<Scalar> machine_knowledge() const { return {estimator_.drives(), was_rezeroed_}; }
    void set_machine_knowledge(const MachineKnowledge<Scalar>& learnt) {
        estimator_.set_drives(learnt.drives);
        was_rezeroed_ = learnt.was_rezeroed;
    }

    /// Time passes without samples of the drives: what was learnt of the machine is less certain.
    void let_machine_drift(Scalar passed_s) { estimator_.let_drives_drift(passed_s); }

    /// The operator's, within the range of the machine's override.
    [[nodiscard]] Scalar operators_override(const hal::ProgramStatus& program) const {
        return control::bounded(controller_.parameters(), Scalar(program.operator_override));
    }

    [[nodiscard]] bool estimate_due() const { return estimator_.work_due(); }
    [[nodiscard]] bool work_due() const { return estimator_.work_due() || wide_band_.work_due(); }
    /// One slice of the work beside the steps, of the estimate first.
    void work();

    [[nodiscard]] const WideBandEstimate<Scalar>& wide_band() const { return wide_band_.estimate(); }
    [[nodiscard]] const estimation::CutEstimate<Scalar>& estimate() const { return estimator_.estimate(); }
    [[nodiscard]] const estimation::CutEstimator<Scalar>& estimator() const { return estimator_; }

    /// The engagement for display and record. "No estimate" outside a cut, in `entry`, and
    /// in a cut that fades: while the cutter's radius enters the workpiece or leaves it the arc begins and ends
    /// anywhere, and the law of a straight cut does not describe it. (The controller goes on with the forces
    /// themselves, and may not raise the feed in that state.)
    [[nodiscard]] estimation::EngagementEstimate<Scalar> engagement() const;
    [[nodiscard]] const control::ControlOutput<Scalar>& control() const { return control_; }
    /// Since the last sample.
    [[nodiscard]] Scalar step_s() const { return input_.dt_s; }
    [[nodiscard]] Scalar path_speed_mm_s() const { return input_.path_speed_mm_s; }
    /// By the last answer. A rapid has a feed of its own: the present one.
    [[nodiscard]] Scalar asked_feed_mm_s() const {
        return input_.rapid ? input_.path_speed_mm_s : control_.ratio * input_.programmed_feed_mm_s;
    }
    /// R_a or R_z (the tool's `measure`) of the surface in work; not valid without a model or without both forces.
    [[nodiscard]] const estimation::RoughnessPrediction<Scalar>& roughness() const { return surface_.prediction(); }

  private:
    using Velocity = typename estimation::DriveSignals<Scalar>::Velocity;

    void take_silence(float silent_s, float dt_s);
    Scalar elapsed_s(std::uint32_t time_us);
    using Signals = estimation::DriveSignals<Scalar>;
    void watch_sample(const hal::DriveSample& sample, const Signals& signals, Scalar dt_s);
    void watch_encoder(std::uint32_t count, Scalar spindle_current_A, Scalar dt_s);
    [[nodiscard]] bool is_in_cut() const;
    void follow_wide_band(Scalar dt_s, const hal::DriveSample& sample);
    void work_on_wide_band();
    void take_estimate();
    void forget_estimate();
    void rezero_in_air();
    [[nodiscard]] bool is_idle(const estimation::CutEstimate<Scalar>& e) const;
    void ask_load();
    void set_cut();
    void allow_for_drift();
    void set_motion(Velocity velocity);
    void run_law(const hal::ProgramStatus& program);
    [[nodiscard]] bool belongs_to_this_feed() const;
    void use_tooth_force_of_map();
    hal::FeedOverride output();

    estimation::CutEstimator<Scalar> estimator_;
    WideBand wide_band_;
    CarriedImmersion<Scalar> drops_{};
    DriftDoubt<Scalar> drift_doubt_;
    LoadAnswer<Scalar> load_answer_;
    SurfaceMonitor<Scalar> surface_;
    SignalSupervisor<Scalar> supervisor_;
    control::FeedController<Scalar> controller_;
    Scalar reaction_s_;  // of the CNC
    Scalar K_t1_Nm_per_A_;
    Scalar contact_torque_Nm_;

    control::ControlInput<Scalar> input_{};
    control::ControlOutput<Scalar> control_{};
    bool has_new_estimate_ = false;  // that no law has seen
    hal::ProgramStatus program_{};   // of the last answer
    bool was_rezeroed_ = false;
    int air_periods_ = 0;
    bool has_time_ = false;
    std::uint32_t last_time_us_ = 0;
    bool has_begun_ = false;  // a whole sample came
    Scalar since_whole_sample_s_{0};
    std::uint32_t last_count_ = 0;
    Scalar encoder_stands_s_{0};
    Scalar not_forwards_s_{0};  // the encoder stands or counts backwards
    SettledFeed<Scalar> settled_feed_;
    std::uint32_t heartbeat_ = 0;
};

/// As a small chip has it: drives alone, no force sensor.
template <typename Scalar>
using SmallTick = ForceControlTick<Scalar, NoWideBand<Scalar>>;

/// The estimate that is due, before the law: for a computer.
template <typename Tick>
void finish_estimate(Tick& tick) {
    while (tick.estimate_due()) {
        tick.work();
    }
}

/// All the work that is due, for a computer. `worker`: a tick, or whatever else has work in slices.
template <typename Worker>
void finish_work(Worker& worker) {
    while (worker.work_due()) {
        worker.work();
    }
}

/// A sample's whole tick, where nobody waits for the override before its end: in a simulation, a replay, a test.
template <typename Tick>
hal::FeedOverride step_and_work(Tick& tick, const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    tick.take(sample);
    finish_estimate(tick);
    const hal::FeedOverride output = tick.answer(program);
    finish_work(tick);
    return output;
}

}  // namespace millforce::firmware
