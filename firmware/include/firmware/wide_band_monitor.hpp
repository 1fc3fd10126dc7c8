// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "estimation/depth_shape/depth_monitor.hpp"
#include "estimation/force_drop/force_drop.hpp"
#include "firmware/feed_frame_forces.hpp"
#include "firmware/parameters.hpp"
#include "firmware/wide_band_settings.hpp"
#include "hal/drive_sample.hpp"

/// The methods that look at the force within a revolution, beside the tick's averages: radial immersion from force
/// drops (Hwang et al.) and both depths from the force's shape (Yang, DeVor & Kapoor).
///
/// The forces are a force sensor's, or the feed drives' (FeedFrameForces). Depths from the shape take a force sensor.
///
/// add() is for the tick, a few dozen operations; work() is for whatever runs beside it, once where work_due() says so:
/// up to some milliseconds (force_drop.hpp, flute_profile_fit.hpp). Meanwhile samples are dropped, not mixed up.
/// Memory: 7 KiB in float. No heap. Not thread-safe: add() and work() by one thread, or one after the other.

namespace millforce::firmware {

/// What the methods say at this moment; not valid: no estimate. An estimate stays until the next one is due.
template <typename Scalar>
struct WideBandEstimate {
    estimation::Measurement<Scalar> force_drop_immersion{};
    estimation::Measurement<Scalar> axial_depth_mm{};
    estimation::Measurement<Scalar> radial_width_mm{};
    std::uint32_t force_drops = 0;  ///< how often it was due, counted from 0; and how often there was an estimate
    std::uint32_t force_drops_valid = 0;
    std::uint32_t depths = 0;
    std::uint32_t depths_valid = 0;
};

/// In the monitor's place where the memory is short.
template <typename Scalar>
class NoWideBand {
  public:
    static constexpr bool has_force_drops = false;
    explicit NoWideBand(const Parameters<Scalar>&) {}
    [[nodiscard]] static bool work_due() { return false; }
    void work() {}
    [[nodiscard]] const WideBandEstimate<Scalar>& estimate() const { return estimate_; }

  private:
    WideBandEstimate<Scalar> estimate_{};
};

template <typename Scalar>
class WideBandMonitor {
  public:
    static constexpr bool has_force_drops = true;

    explicit WideBandMonitor(const Parameters<Scalar>& p)
        : forces_(p),
          teeth_(p.tool.teeth),
          force_drop_revolutions_(p.tool.force_drop.revolutions),
          depth_revolutions_(p.tool.depth_shape.revolutions) {
        const bool has_sensor = has_force_sensor(p.tool);
        const bool has_drives =
            p.machine.axes[0].K_x4_N_per_A > Scalar(0) && p.machine.axes[1].K_x4_N_per_A > Scalar(0);
        uses_force_drop_ = has_force_drop_law(p.tool) && (has_sensor || has_drives);
        uses_depths_ = has_nominal_depths(p.tool) && force_has_shape(p.tool) && has_sensor;
        if (uses_force_drop_) {
            force_drop_ = estimation::ForceDrop<Scalar>(force_drop_law(p.tool), force_drop_settings(p));
        }
        if (uses_depths_) {
            depths_ =
                estimation::DepthMonitor<Scalar>(depth_shape_settings(p.tool), static_cast<int>(depth_revolutions_));
        }
    }

    [[nodiscard]] bool uses_force_drop() const { return uses_force_drop_; }
    [[nodiscard]] bool uses_depths() const { return uses_depths_; }

    /// One drive sample, dt_s after the last one. `in_cut`: the cutter is neither in air nor entering or leaving, as
    /// far as anybody knows; else there is nothing to be averaged. True where the force drops' average goes on from the
    /// last sample; false where there is none or it has begun anew.
    bool add(Scalar dt_s, const hal::DriveSample& sample, bool in_cut) {
        if (!uses_force_drop_ && !uses_depths_) {
            return false;
        }
        const Forces forces = in_cut ? forces_.read(dt_s, sample) : Forces{};
        if (!forces.valid || forces.is_new_frame) {
            restart();
        }
        if (!forces.valid) {
            forces_.restart();
            return false;
        }
        is_clear_ = false;
        follow(dt_s, forces);
        collect(dt_s, forces);
        drop_outdated();
        return uses_force_drop_ && !forces.is_new_frame;
    }

    [[nodiscard]] bool work_due() const { return force_drop_.complete() || depths_.complete(); }

    void work() {
        if (force_drop_.complete()) {
            work_on_force_drop();
        }
        if (depths_.complete()) {
            work_on_depths();
        }
    }

    [[nodiscard]] const WideBandEstimate<Scalar>& estimate() const { return estimate_; }

  private:
    using Forces = typename FeedFrameForces<Scalar>::Forces;

    /// Path and rotation since the last estimate: their ratio is the feed per tooth.
    struct Travel {
        Scalar path_mm{0};
        Scalar turned_rev{0};

        [[nodiscard]] Scalar feed_per_tooth_mm(Scalar teeth) const {
            return turned_rev > Scalar(0) ? path_mm / (turned_rev * teeth) : Scalar(0);
        }
    };

    void restart() {
        if (is_clear_) {
            return;
        }
        is_clear_ = true;
        estimate_.force_drop_immersion = {};
        estimate_.axial_depth_mm = {};
        estimate_.radial_width_mm = {};
        force_drop_travel_ = {};
        depth_travel_ = {};
        force_drop_.restart();
        depths_.restart();
    }

    void follow(Scalar dt_s, const Forces& forces) {
        if (forces.is_new_frame) {
            return;
        }
        for (Travel* travel : {&force_drop_travel_, &depth_travel_}) {
            travel->path_mm += forces.speed_mm_s * dt_s;
            travel->turned_rev += forces.turned_rev;
        }
    }

    void collect(Scalar dt_s, const Forces& forces) {
        const Scalar since_s = forces.is_new_frame ? Scalar(0) : dt_s;
        if (uses_force_drop_) {
            force_drop_.collect({forces.angle_rev, since_s, forces.along_N, forces.across_N});
        }
        if (uses_depths_) {
            depths_.add(since_s, forces.angle_rev * (Scalar(2) * estimation::pi<Scalar>), forces.along_N,
                        forces.across_N);
        }
    }

    void work_on_force_drop() {
        const auto& made = force_drop_.evaluate(force_drop_travel_.feed_per_tooth_mm(teeth_));
        const Scalar variance = estimation::square(made.radial_immersion_sd);
        estimate_.force_drop_immersion = {made.valid(), made.radial_immersion, variance, variance};
        ++estimate_.force_drops;
        estimate_.force_drops_valid += made.valid() ? 1U : 0U;
        force_drop_travel_ = {};
    }

    void work_on_depths() {
        const auto made = depths_.evaluate();
        estimate_.axial_depth_mm = made.axial_depth_mm;
        estimate_.radial_width_mm = made.radial_depth_mm;
        ++estimate_.depths;
        estimate_.depths_valid += made.axial_depth_mm.valid || made.radial_depth_mm.valid ? 1U : 0U;
        depth_travel_ = {};
    }

    /// An estimate is followed by the next one as soon as the spindle has turned on as far; one that is not has been
    /// overtaken: samples are missing, or the spindle stands.
    void drop_outdated() {
        constexpr Scalar late{2};
        if (force_drop_travel_.turned_rev > late * force_drop_revolutions_) {
            estimate_.force_drop_immersion.valid = false;
        }
        if (depth_travel_.turned_rev > late * depth_revolutions_) {
            estimate_.axial_depth_mm.valid = false;
            estimate_.radial_width_mm.valid = false;
        }
    }

    FeedFrameForces<Scalar> forces_;
    estimation::ForceDrop<Scalar> force_drop_{};
    estimation::DepthMonitor<Scalar> depths_{};
    WideBandEstimate<Scalar> estimate_{};
    Travel force_drop_travel_{};
    Travel depth_travel_{};
    Scalar teeth_;
    Scalar force_drop_revolutions_;
    Scalar depth_revolutions_;
    bool uses_force_drop_ = false;
    bool uses_depths_ = false;
    bool is_clear_ = true;
};

}  // namespace millforce::firmware
