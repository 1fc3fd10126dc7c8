// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "control/feed_controller.hpp"
#include "estimation/cut_estimator.hpp"
#include "estimation/surface/roughness.hpp"
#include "firmware/parameters.hpp"
#include "firmware/wide_band_monitor.hpp"
#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"
#include "hal/finite.hpp"

/// The tick: one drive sample in, one feed override out. The same class runs on the drive controller, in the daemon and
/// in the simulation.
///
/// Rezeroing in air is its own: in a rapid, and while the controller's state is `air` and the torque is near its idle
/// value, each new revolution corrects the idle torque and the friction of the moving axes. What a cut shows can so not
/// be taken for drift: contact ends it at once, and the drift per second is bounded by its Kalman gain. As long as the
/// idle torque is known no better than by its calibration, a light cut looks like drift, and no feed move teaches: the
/// first time takes a rapid or axes at rest, some five revolutions of it.
///
/// Beside it runs a WideBand monitor (NoWideBand where the memory is short): an immersion from force drops enters the
/// solver as one more measurement of the engagement. What the cut has changed since the drops were seen adds to its
/// variance. Its work() is not part of step(): call it where there is time, as soon as work_due() says so.

namespace millforce::firmware {

template <typename Scalar, typename WideBand = WideBandMonitor<Scalar>>
class ForceControlTick {
  public:
    [[gnu::cold, gnu::noinline]] explicit ForceControlTick(const Parameters<Scalar>& parameters)
        : controller_(controller_parameters(parameters)),
          estimator_(estimator_settings(parameters), parameters.machine.spindle, parameters.machine.axes,
                     parameters.tool.law),
          wide_band_(parameters),
          control_parameters_(controller_parameters(parameters)),
          roughness_model_(parameters.tool.roughness),
          tool_diameter_mm_(parameters.tool.diameter_mm),
          declared_depth_mm_(parameters.tool.declared_axial_depth_mm),
          reaction_s_(parameters.machine.cnc.override_latency_s) {}

    /// A new drive sample. Cost: accumulation, every 5 ms the law, and once per tooth period the estimate. Inlined: a
    /// controller calls it in one place.
    [[gnu::always_inline]] hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
        const Scalar dt_s = elapsed_s(sample.time_us);
        const estimation::DriveSignals<Scalar> signals = taken_from(sample);
        const bool has_angle = (sample.present & hal::mask(hal::Present::spindle_count)) != 0;
        if (!has_angle) {
            estimator_.restart();
            set_cut();
        }
        if constexpr (WideBand::has_force_drops) {
            if (!wide_band_.add(dt_s, sample, may_be_in_cut())) {
                forget_sections();
            }
            estimator_.tell_immersion(immersion_by_force_drops());
        }
        since_control_s_ += dt_s;
        const bool law_is_due = control_is_due_ || since_control_s_ > control_interval_s || !is_told(program);
        const bool fresh = has_angle && estimator_.add(dt_s, sample.spindle_count, sample.spindle_index_count,
                                                       sample.spindle_index_number, signals, {law_is_due, is_steady_});
        if (fresh) {
            rezero_in_air(program.rapid);
            follow_section();
            if (roughness_model_.has_model()) {
                predict_roughness(signals.velocity());
            }
            set_cut();
        }
        if (fresh || law_is_due) {
            input_.cut.fresh = fresh;
            run_control(signals.velocity(), program, dt_s);
        }
        return output();
    }

    /// No drive sample came for `silent_s`: the tick still runs and gives its heartbeat.
    hal::FeedOverride step_without_sample(float silent_s, float dt_s, const hal::ProgramStatus& program) {
        estimator_.restart();  // no average reaches over the gap
        set_cut();
        since_control_s_ += Scalar(dt_s);
        input_.cut.fresh = false;
        input_.surface.valid = false;
        has_time_ = false;
        run_control({}, program, Scalar(silent_s));
        return output();
    }

    void reset_fault() {
        controller_.reset();
        control_is_due_ = true;
    }

    /// Work beside the tick, in the same thread or between two steps; some milliseconds on a desktop processor.
    [[nodiscard]] bool work_due() const { return wide_band_.work_due(); }
    void work() {
        const WideBandEstimate<Scalar> before = wide_band_.estimate();
        wide_band_.work();
        if (wide_band_.estimate().force_drops != before.force_drops) {
            take_section_of_drops(before.force_drop_immersion);
        }
    }
    [[nodiscard]] const WideBandEstimate<Scalar>& wide_band() const { return wide_band_.estimate(); }

    [[nodiscard]] const estimation::CutEstimate<Scalar>& estimate() const { return estimator_.estimate(); }
    [[nodiscard]] const estimation::CutEstimator<Scalar>& estimator() const { return estimator_; }

    /// The engagement for display and record. "No estimate" outside a cut, in `entry`, and
    /// in a cut that fades: while the cutter's radius enters the workpiece or leaves it the arc begins and ends
    /// anywhere, and the law of a straight cut does not describe it. (The controller goes on with the forces
    /// themselves, and may not raise the feed in that state.)
    [[nodiscard]] estimation::EngagementEstimate<Scalar> engagement() const {
        estimation::EngagementEstimate<Scalar> shown = estimator_.estimate().engagement;
        const bool arc_is_known = is_in_cut();
        shown.immersion_valid = shown.immersion_valid && arc_is_known;
        shown.depth_valid = shown.depth_valid && arc_is_known;
        return shown;
    }
    [[nodiscard]] const control::ControlOutput<Scalar>& control() const { return control_; }
    /// R_a or R_z (the tool's `measure`) of the surface in work; not valid without a model or without both forces.
    [[nodiscard]] const estimation::RoughnessPrediction<Scalar>& roughness() const { return roughness_; }

  private:
    using Velocity = typename estimation::DriveSignals<Scalar>::Velocity;

    [[nodiscard]] bool is_in_cut() const {
        const bool is_cutting =
            control_.state == control::CutState::in_cut || control_.state == control::CutState::hold;
        return is_cutting && !control_.fading;
    }

    /// Without a tangential force (no spindle current: a force sensor alone) nothing tells air from cut.
    [[nodiscard]] bool may_be_in_cut() const { return !estimator_.estimate().tangential_N.valid || is_in_cut(); }

    /// The mean section of the drops' revolutions; and how much of its growth since the last drops the width had.
    void take_section_of_drops(const estimation::Measurement<Scalar>& last) {
        constexpr Scalar least_growth2 = static_cast<Scalar>(0.0016L);  // 4 %
        const estimation::Measurement<Scalar>& now = wide_band_.estimate().force_drop_immersion;
        const Scalar section_mm2 = sections_ > 0 ? section_sum_mm2_ / Scalar(sections_) : Scalar(0);
        if (last.valid && now.valid && section_of_drops_mm2_ > Scalar(0) && last.value > Scalar(0)) {
            const Scalar growth = section_mm2 / section_of_drops_mm2_ - Scalar(1);
            if (estimation::square(growth) > least_growth2) {
                const Scalar seen =
                    estimation::clamp((now.value / last.value - Scalar(1)) / growth, Scalar(0), Scalar(1));
                width_share_ += Scalar(0.5F) * (seen - width_share_);
            }
        } else {
            width_share_ = Scalar(0.5F);
        }
        section_of_drops_mm2_ = section_mm2;
        forget_sections();
    }

    void forget_sections() {
        section_sum_mm2_ = Scalar(0);
        sections_ = 0;
    }

    /// Sections of the revolutions that the force drops' average holds.
    void follow_section() {
        section_sum_mm2_ += estimator_.estimate().section_mm2;
        ++sections_;
    }

    /// The immersion of the drops' revolutions. Where the section has grown since, the width may have grown as much or
    /// the depth instead: as before the drops, and as doubtful as if all between the two were evenly likely.
    [[nodiscard]] estimation::Measurement<Scalar> immersion_by_force_drops() const {
        estimation::Measurement<Scalar> told = wide_band_.estimate().force_drop_immersion;
        const Scalar now_mm2 = estimator_.estimate().section_mm2;
        told.valid = told.valid && section_of_drops_mm2_ > Scalar(0) && now_mm2 > Scalar(0);
        if (told.valid) {
            const Scalar growth = now_mm2 / section_of_drops_mm2_ - Scalar(1);
            constexpr Scalar of_even_distribution = static_cast<Scalar>(0.0833333333L);  // 1/12
            told.variance += of_even_distribution * estimation::square(growth * told.value);
            told.value *= Scalar(1) + width_share_ * growth;
            told.valid = estimation::square(growth) < Scalar(0.25F);
        }
        return told;
    }

    /// Since the last sample; 0 for the first one and where the clock went backwards.
    Scalar elapsed_s(std::uint32_t time_us) {
        const auto elapsed_us = static_cast<std::int32_t>(time_us - last_time_us_);
        last_time_us_ = time_us;
        if (!has_time_) {
            has_time_ = true;
            return Scalar(0);
        }
        return elapsed_us > 0 ? static_cast<Scalar>(elapsed_us) * static_cast<Scalar>(1e-6L) : Scalar(0);
    }

    static constexpr unsigned all_drives = hal::all_present & ~hal::mask(hal::Present::spindle_count);

    static estimation::DriveSignals<Scalar> taken_from(const hal::DriveSample& sample) {
        const auto& [x_A, y_A, z_A] = sample.axis_current_A;
        const auto& [x_mm_s, y_mm_s, z_mm_s] = sample.axis_velocity_mm_s;
        const bool is_whole = (sample.present & all_drives) == all_drives &&
                              hal::all_finite(sample.spindle_current_A, x_A, y_A, z_A, x_mm_s, y_mm_s, z_mm_s);
        return is_whole ? signals_of(sample) : signals_of(usable_part_of(sample));
    }

    static estimation::DriveSignals<Scalar> signals_of(const hal::DriveSample& sample) {
        const auto& [x_A, y_A, z_A] = sample.axis_current_A;
        const auto& [x_mm_s, y_mm_s, z_mm_s] = sample.axis_velocity_mm_s;
        decltype(estimation::DriveSignals<Scalar>::values) values;
        values << Scalar(sample.spindle_current_A), Scalar(x_A), Scalar(y_A), Scalar(z_A), Scalar(x_mm_s),
            Scalar(y_mm_s), Scalar(z_mm_s);
        return {values, (sample.present & all_drives) >> 1U};
    }

    /// What is there and finite; an axis as a whole.
    [[gnu::noinline]] static hal::DriveSample usable_part_of(const hal::DriveSample& sample) {
        hal::DriveSample part;
        if ((sample.present & hal::mask(hal::Present::spindle_current)) != 0 &&
            hal::is_finite(sample.spindle_current_A)) {
            part.present = hal::mask(hal::Present::spindle_current);
            part.spindle_current_A = sample.spindle_current_A;
        }
        for (std::size_t k = 0; k < hal::axis_count; ++k) {
            if ((sample.present & hal::axis_mask(k)) != 0 && hal::is_finite(sample.axis_current_A[k]) &&
                hal::is_finite(sample.axis_velocity_mm_s[k])) {
                part.present = static_cast<std::uint8_t>(part.present | hal::axis_mask(k));
                part.axis_current_A[k] = sample.axis_current_A[k];
                part.axis_velocity_mm_s[k] = sample.axis_velocity_mm_s[k];
            }
        }
        return part;
    }

    [[gnu::noinline]] void rezero_in_air(bool rapid) {
        const auto& estimate = estimator_.estimate();
        const bool in_air = controller_.state() == control::CutState::air;
        const Scalar half_contact_N = Scalar(0.5F) * control_parameters_.contact_force_N;
        const bool looks_idle = was_rezeroed_
                                    ? estimate.tangential_N.valid && estimate.tangential_N.value < half_contact_N
                                    : estimator_.axes_rest();
        // A rapid is the program's word for air, even where drift has grown to what looks like a cut.
        air_periods_ = rapid || (in_air && looks_idle) ? air_periods_ + estimate.tooth_periods : 0;
        // The first windows after a change hold a mixture of air and cut.
        const int enough = 2 * static_cast<int>(control_parameters_.teeth) + 1;
        if (air_periods_ >= enough) {
            was_rezeroed_ = estimator_.rezero() || was_rezeroed_;
            air_periods_ = enough;
        } else {
            estimator_.leave_air();
        }
    }

    /// From F_x/F_z, F_z by the z drive's current: where z stands its force hides in static friction, and there is no
    /// prediction. F_x is the force along the feed. Not inlined: once per tooth period, and every tick is shorter for
    /// it.
    [[gnu::noinline]] void predict_roughness(Velocity velocity) {
        using std::sqrt;
        const estimation::CutEstimate<Scalar>& e = estimator_.estimate();
        constexpr Scalar turn = Scalar(2) * estimation::pi<Scalar>;
        const Scalar turns_per_s = e.spindle_speed_rad_s / turn;
        const Scalar path_mm_s = sqrt(estimation::square(e.feed_mm_s) + estimation::square(velocity.z_mm_s));
        const Scalar estimated_depth_mm = e.engagement.depth_valid ? e.engagement.axial_depth_mm : Scalar(0);
        const estimation::RoughnessConditions<Scalar> cut{
            Scalar(60) * turns_per_s, turns_per_s > Scalar(0) ? path_mm_s / turns_per_s : Scalar(0), tool_diameter_mm_,
            declared_depth_mm_ > Scalar(0) ? declared_depth_mm_ : estimated_depth_mm, Scalar(1)};
        roughness_ = roughness_model_.predict(cut, e.feed_N, e.z_N);
        surface_ = {};
        const bool is_Ra = !(roughness_model_.model().measure > Scalar(0.5F));
        if (is_Ra && control_parameters_.Ra_limit_um > Scalar(0)) {
            const auto ceiling = roughness_model_.feed_ceiling(cut, e.feed_N, e.z_N, control_parameters_.Ra_limit_um);
            surface_.valid = ceiling.valid;
            surface_.in_range = ceiling.in_range;
            // Where even the lowest fitted feed is too fast, it is no reason to speed up towards it.
            const bool is_below = !ceiling.reachable && cut[estimation::roughness_feed] < ceiling.feed_mm_rev;
            surface_.feed_ceiling_mm_s =
                turns_per_s * (is_below ? cut[estimation::roughness_feed] : ceiling.feed_mm_rev);
        }
    }

    /// What the controller is told of the present sample.
    void set_motion(Velocity velocity) {
        using std::sqrt;
        input_.velocity_x_mm_s = velocity.x_mm_s;
        input_.velocity_y_mm_s = velocity.y_mm_s;
        const Scalar plane2 = estimation::square(input_.velocity_x_mm_s) + estimation::square(input_.velocity_y_mm_s);
        const Scalar axial2 = estimation::square(velocity.z_mm_s);
        input_.path_speed_mm_s = sqrt(plane2 + axial2);
        input_.plunging = axial2 > plane2 && axial2 > Scalar(0.25F);
        const estimation::CutEstimate<Scalar>& e = estimator_.estimate();
        input_.cut.spindle_turning = estimator_.spindle_turns();
        input_.cut.force_valid = e.tangential_N.valid && input_.cut.spindle_turning;
    }

    /// What a new estimate tells. Not inlined: once per tooth period, and every tick is shorter for it.
    [[gnu::noinline]] void set_cut() {
        using std::sqrt;
        const estimation::CutEstimate<Scalar>& e = estimator_.estimate();
        control::CutEstimateForControl<Scalar>& cut = input_.cut;
        const bool tooth_is_higher = e.tooth_tangential_N.valid && e.tooth_tangential_N.value > e.tangential_N.value;
        const auto& F_at = tooth_is_higher ? e.tooth_tangential_N : e.tangential_N;
        cut.tangential_N = F_at.value;
        cut.tangential_sd_N = sqrt(F_at.variance);
        const estimation::Measurement<Scalar>& tooth = e.tooth_force_N;
        const Scalar tooth_sd_N = sqrt(tooth.variance);
        cut.tooth_force_valid = tooth.valid;
        cut.tooth_force_is_bound = e.tooth_force_is_bound;
        cut.least_tooth_force_N = e.least_tooth_force_N;
        cut.tooth_force_N =
            tooth.valid ? tooth.value + control_parameters_.caution_sd * tooth_sd_N : e.worst_tooth_force_N;
        // What the force will be once the CNC acts on this override: it grows meanwhile as it grew in the last window.
        if (e.newest_tangential_N > Scalar(0)) {
            const Scalar lead_s = reaction_s_ + Scalar(0.5F) * e.window_s;
            cut.tooth_force_N *= Scalar(1) + e.tangential_growth_N_per_s * lead_s / e.newest_tangential_N;
        }
        cut.tooth_periods = Scalar(e.tooth_periods);
        cut.cutting_share = e.cutting_share;
        cut.surge_ratio = e.surge.ratio;
        cut.surge_cutting_share = e.surge.cutting_share;
        cut.turn_ratio = e.turn.ratio;
        cut.turn_cutting_share = e.turn.cutting_share;
        cut.section_mm2 = e.section_mm2;
        cut.section_noise_mm2 = e.section_noise_mm2;
        cut.feed_exponent = e.feed_exponent;
        cut.feed_mm_s = e.feed_mm_s;
        cut.spindle_speed_rad_s = e.spindle_speed_rad_s;
        input_.surface = surface_;
    }

    /// The controller knows the program's words, to the bit: so comparing them takes no floating-point unit.
    [[nodiscard]] bool is_told(const hal::ProgramStatus& program) const {
        const auto same = [](float a, float b) {
            return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
        };
        return same(program.programmed_feed_mm_s, program_.programmed_feed_mm_s) &&
               same(program.operator_override, program_.operator_override) && program.rapid == program_.rapid &&
               program.feed_hold == program_.feed_hold;
    }

    [[gnu::noinline]] void run_control(Velocity velocity, const hal::ProgramStatus& program,
                                       Scalar time_since_sample_s) {
        set_motion(velocity);
        input_.time_since_sample_s = time_since_sample_s;
        program_ = program;
        input_.dt_s = since_control_s_;
        since_control_s_ = Scalar(0);
        control_is_due_ = false;
        input_.programmed_feed_mm_s = Scalar(program.programmed_feed_mm_s);
        input_.operator_override = Scalar(program.operator_override);
        input_.rapid = program.rapid;
        input_.feed_hold = program.feed_hold;
        control_ = controller_.step(input_);
        is_steady_ = control::is_cutting(control_.state) && !control_.fading && !control_.rising;
    }

    hal::FeedOverride output() {
        hal::FeedOverride output;
        output.ratio = static_cast<float>(control_.ratio);
        output.hold = control_.hold;
        output.state = static_cast<std::uint8_t>(control_.state);
        output.fault = static_cast<std::uint8_t>(control_.fault);
        output.heartbeat = ++heartbeat_;
        return output;
    }

    /// A CNC takes an override up every few milliseconds, and no axis follows it faster. A little less than five of a
    /// kilohertz' samples, so that the fifth is the one.
    static constexpr Scalar control_interval_s = static_cast<Scalar>(0.0045L);

    // What each sample touches comes first: near the object's start an access is one instruction.
    control::ControlInput<Scalar> input_{};
    control::ControlOutput<Scalar> control_{};
    hal::ProgramStatus program_{};  // that the controller was told last
    Scalar since_control_s_{0};
    std::uint32_t last_time_us_ = 0;
    std::uint32_t heartbeat_ = 0;
    bool has_time_ = false;
    bool control_is_due_ = false;
    bool is_steady_ = false;  // in air each revolution is looked at as well: it teaches the idle torque
    bool was_rezeroed_ = false;
    int air_periods_ = 0;
    control::FeedController<Scalar> controller_;
    estimation::CutEstimator<Scalar> estimator_;
    WideBand wide_band_;
    control::FeedControllerParameters<Scalar> control_parameters_;
    estimation::RoughnessPredictor<Scalar> roughness_model_;
    Scalar tool_diameter_mm_;
    Scalar declared_depth_mm_;
    Scalar reaction_s_;
    estimation::RoughnessPrediction<Scalar> roughness_{};
    control::SurfaceForControl<Scalar> surface_{};
    Scalar section_sum_mm2_{0};
    Scalar section_of_drops_mm2_{0};
    Scalar width_share_{Scalar(0.5F)};  ///< of the section's growth
    int sections_ = 0;
};

/// As a small chip has it: drives alone, no force sensor.
template <typename Scalar>
using SmallTick = ForceControlTick<Scalar, NoWideBand<Scalar>>;

}  // namespace millforce::firmware
