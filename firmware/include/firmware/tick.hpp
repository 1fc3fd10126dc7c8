// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "control/feed_controller.hpp"
#include "estimation/cut_estimator.hpp"
#include "firmware/carried_immersion.hpp"
#include "firmware/parameters.hpp"
#include "firmware/surface_monitor.hpp"
#include "firmware/wide_band_monitor.hpp"
#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"

/// The tick: one drive sample in, one feed override out. The same class runs on the drive controller, in the daemon and
/// in the simulation.
///
///     send(tick.step(sample, program));   // each sample: averages, the law, the override. Bounded and short.
///     finish_work(tick);                  // a computer, at once: what a tooth period that has ended asks for
///
/// A chip, whose main loop must be back for the next sample, calls `if (tick.work_due()) tick.work();` in that loop:
/// one bounded slice each time. The law of a step uses the newest estimate that is complete. The estimate does not
/// depend on how its work was sliced; tooth periods that end meanwhile are merged into the next (cut_estimator.hpp).
///
/// Rezeroing in air is its own: in a rapid, and while the controller's state is `air` and the torque is near its idle
/// value, each new revolution corrects the idle torque and the friction of the moving axes. What a cut shows can so not
/// be taken for drift: contact ends it at once, and the drift per second is bounded by its Kalman gain. As long as the
/// idle torque is known no better than by its calibration, a light cut looks like drift, and no feed move teaches: the
/// first time takes a rapid or axes at rest, some five revolutions of it.
///
/// Beside it runs a WideBand monitor (NoWideBand where the memory is short): an immersion from force drops enters the
/// solver as one more measurement of the engagement (carried_immersion.hpp). An evaluation of the monitor is one slice,
/// of up to some milliseconds on a desktop processor.
///
/// No heap, no clock. One thread. Bodies: tick_impl.hpp; instances for float and estimation::Fixed: firmware/src.

namespace millforce::firmware {

template <typename Scalar, typename WideBand = WideBandMonitor<Scalar>>
class ForceControlTick {
  public:
    explicit ForceControlTick(const Parameters<Scalar>& parameters);

    /// A new drive sample.
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program);

    /// No drive sample came for `silent_s`: the tick still runs and gives its heartbeat.
    hal::FeedOverride step_without_sample(float silent_s, float dt_s, const hal::ProgramStatus& program);

    void reset_fault() { controller_.reset(); }

    [[nodiscard]] bool work_due() const { return estimator_.work_due() || wide_band_.work_due(); }
    /// One slice of the work beside the steps.
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
    /// R_a or R_z (the tool's `measure`) of the surface in work; not valid without a model or without both forces.
    [[nodiscard]] const estimation::RoughnessPrediction<Scalar>& roughness() const { return surface_.prediction(); }

  private:
    using Velocity = typename estimation::DriveSignals<Scalar>::Velocity;

    Scalar elapsed_s(std::uint32_t time_us);
    [[nodiscard]] bool is_in_cut() const;
    void follow_wide_band(Scalar dt_s, const hal::DriveSample& sample);
    void work_on_wide_band();
    void take_estimate();
    void forget_estimate();
    void rezero_in_air();
    void set_cut();
    void set_motion(Velocity velocity);
    void run_law(Velocity velocity, const hal::ProgramStatus& program, Scalar dt_s, Scalar time_since_sample_s);
    hal::FeedOverride output();

    estimation::CutEstimator<Scalar> estimator_;
    WideBand wide_band_;
    CarriedImmersion<Scalar> drops_{};
    SurfaceMonitor<Scalar> surface_;
    control::FeedController<Scalar> controller_;
    control::FeedControllerParameters<Scalar> control_parameters_;
    Scalar reaction_s_;  // of the CNC

    control::ControlInput<Scalar> input_{};
    control::ControlOutput<Scalar> control_{};
    bool has_new_estimate_ = false;  // that no law has seen
    bool is_rapid_ = false;
    bool was_rezeroed_ = false;
    int air_periods_ = 0;
    bool has_time_ = false;
    std::uint32_t last_time_us_ = 0;
    std::uint32_t heartbeat_ = 0;
};

/// As a small chip has it: drives alone, no force sensor.
template <typename Scalar>
using SmallTick = ForceControlTick<Scalar, NoWideBand<Scalar>>;

/// All the work that is due, for a computer: there it takes microseconds, but for that of the wide band. `worker`: a
/// tick, or whatever else has work in slices.
template <typename Worker>
void finish_work(Worker& worker) {
    while (worker.work_due()) {
        worker.work();
    }
}

/// A step and all its work, where nobody waits for the override in between: in a simulation and in tests.
template <typename Scalar, typename WideBand>
hal::FeedOverride step_and_work(ForceControlTick<Scalar, WideBand>& tick, const hal::DriveSample& sample,
                                const hal::ProgramStatus& program) {
    const hal::FeedOverride output = tick.step(sample, program);
    finish_work(tick);
    return output;
}

}  // namespace millforce::firmware
