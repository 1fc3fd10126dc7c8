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
/// add() is for the tick, a few dozen operations; work() is for whatever runs beside it, as long as work_due() says so:
/// one evaluation each time, up to some milliseconds on a desktop processor (force_drop.hpp, flute_profile_fit.hpp).
/// Meanwhile samples are dropped, not mixed up.
/// Memory: 7 KiB in float. No heap. Not thread-safe: add() and work() by one thread, or one after the other.
/// Bodies: wide_band_monitor_impl.hpp.

namespace millforce::firmware {

/// The newest estimates of the methods; not valid: no estimate. An estimate stays until the next one is due.
template <typename Scalar>
struct WideBandEstimate {
    estimation::Measurement<Scalar> force_drop_immersion{};
    estimation::Measurement<Scalar> axial_depth_mm{};
    estimation::Measurement<Scalar> radial_width_mm{};
    std::uint32_t force_drops = 0;  ///< evaluations, counted from 0; and those that gave an estimate
    std::uint32_t force_drops_valid = 0;
    std::uint32_t force_drops_of_another_filter = 0;  ///< evaluations in which the low-pass was not as told
    std::uint32_t depths = 0;
    std::uint32_t depths_valid = 0;
};

/// In the monitor's place where the memory is short.
template <typename Scalar>
class NoWideBand {
  public:
    explicit NoWideBand(const Parameters<Scalar>& /*parameters*/) {}
    bool add(Scalar /*dt_s*/, const hal::DriveSample& /*sample*/, bool /*in_cut*/) { return false; }
    [[nodiscard]] static bool work_due() { return false; }
    void work() {}
    [[nodiscard]] const WideBandEstimate<Scalar>& estimate() const { return estimate_; }

  private:
    WideBandEstimate<Scalar> estimate_{};
};

template <typename Scalar>
class WideBandMonitor {
  public:
    explicit WideBandMonitor(const Parameters<Scalar>& p);

    [[nodiscard]] bool uses_force_drop() const { return uses_force_drop_; }
    [[nodiscard]] bool uses_depths() const { return uses_depths_; }

    /// One drive sample, dt_s after the last one. `in_cut`: the cutter is neither in air nor entering or leaving, as
    /// far as is known; else there is nothing to be averaged. True where the force drops' average goes on from the
    /// last sample; false where there is none or it has restarted.
    bool add(Scalar dt_s, const hal::DriveSample& sample, bool in_cut);

    [[nodiscard]] bool work_due() const { return force_drop_.complete() || depths_.complete(); }
    /// One evaluation.
    void work();

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

    void restart();
    void follow(Scalar dt_s, const Forces& forces);
    void collect(Scalar dt_s, const Forces& forces);
    void evaluate_force_drop();
    void evaluate_depths();
    void drop_outdated();

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
