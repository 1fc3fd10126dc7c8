// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "estimation/drives/feed_force_observer.hpp"
#include "estimation/signal/encoder_angle.hpp"
#include "firmware/feed_frame.hpp"
#include "firmware/parameters.hpp"
#include "firmware/wide_band_settings.hpp"
#include "hal/drive_sample.hpp"
#include "hal/finite.hpp"

namespace millforce::firmware {

/// Forces within a revolution in the feed's frame, sample by sample: of the force sensor if the tool's parameters give
/// its low-pass, else of the feed drives (FeedForceObserver), which follow the teeth if tooth passing is slow and both
/// axes travel. Not valid if something is missing or not finite, or the feed or the spindle is at rest. Some 60
/// operations a sample. Not thread-safe.
template <typename Scalar>
class FeedFrameForces {
  public:
    struct Forces {
        bool valid = false;
        bool is_new_frame = false;
        Scalar angle_rev{0};   ///< angle of the spindle in the feed's frame, 0…1
        Scalar turned_rev{0};  ///< since the last sample
        Scalar speed_mm_s{0};
        Scalar along_N{0};  ///< force on the workpiece
        Scalar across_N{0};
    };

    explicit FeedFrameForces(const Parameters<Scalar>& p)
        : encoder_(p.machine.encoder_counts_per_rev),
          x_drive_({p.machine.axes[0].K_x4_N_per_A, p.machine.axes[0].mass_kg}),
          y_drive_({p.machine.axes[1].K_x4_N_per_A, p.machine.axes[1].mass_kg}),
          has_sensor_(has_force_sensor(p.tool)) {}

    void restart() { frame_.restart(); }

    Forces read(Scalar dt_s, const hal::DriveSample& sample) {
        Forces forces;
        const unsigned needed =
            has_sensor_ ? hal::mask(hal::Present::force_sensor) : hal::axis_mask(0) | hal::axis_mask(1);
        const bool finite =
            hal::is_finite(sample.axis_velocity_mm_s[0]) && hal::is_finite(sample.axis_velocity_mm_s[1]);
        if (!has(sample, needed) || !has(sample, hal::mask(hal::Present::spindle_count)) || !finite) {
            encoder_.reset();
            return forces;
        }
        const auto reading =
            encoder_.update(sample.spindle_count, sample.spindle_index_count, sample.spindle_index_number);
        const auto pose =
            frame_.update(dt_s, Scalar(sample.axis_velocity_mm_s[0]), Scalar(sample.axis_velocity_mm_s[1]));
        const PlaneForce force =
            has_sensor_ ? from_sensor(sample, reading.angle_rev) : from_drives(dt_s, sample, reading.angle_rev, pose);
        const bool turns_on = reading.event == estimation::EncoderEvent::none ||
                              reading.event == estimation::EncoderEvent::forward ||
                              reading.event == estimation::EncoderEvent::standstill;
        if (!pose.valid || !force.valid || !turns_on) {
            return forces;
        }
        forces.valid = true;
        forces.is_new_frame = pose.is_new;
        forces.angle_rev = wrapped(force.spindle_rev + pose.direction_rev);
        forces.turned_rev = reading.turned_rev;
        forces.speed_mm_s = pose.speed_mm_s;
        forces.along_N = pose.along(force.x_N, force.y_N);
        forces.across_N = pose.across(force.x_N, force.y_N);
        return forces;
    }

  private:
    struct PlaneForce {
        bool valid = false;
        Scalar x_N{0};
        Scalar y_N{0};
        Scalar spindle_rev{0};
    };

    [[nodiscard]] static bool has(const hal::DriveSample& sample, unsigned mask) {
        return (sample.present & mask) == mask;
    }

    [[nodiscard]] static Scalar wrapped(Scalar angle_rev) {
        using std::floor;
        const Scalar rest = angle_rev - floor(angle_rev);
        return rest < Scalar(1) ? rest : Scalar(0);
    }

    [[nodiscard]] static PlaneForce from_sensor(const hal::DriveSample& sample, Scalar spindle_rev) {
        const bool finite = hal::is_finite(sample.force_N[0]) && hal::is_finite(sample.force_N[1]);
        return {finite, Scalar(sample.force_N[0]), Scalar(sample.force_N[1]), spindle_rev};
    }

    /// The observer's force belongs to the sample before.
    PlaneForce from_drives(Scalar dt_s, const hal::DriveSample& sample, Scalar spindle_rev,
                           const typename FeedFrame<Scalar>::Pose& pose) {
        const Scalar before_rev = spindle_before_rev_;
        spindle_before_rev_ = spindle_rev;
        const auto travel = [](Scalar share) { return share < Scalar(0) ? Scalar(-1) : Scalar(1); };
        const auto x = x_drive_.add(dt_s, Scalar(sample.axis_current_A[0]), Scalar(sample.axis_velocity_mm_s[0]),
                                    travel(pose.cosine));
        const auto y = y_drive_.add(dt_s, Scalar(sample.axis_current_A[1]), Scalar(sample.axis_velocity_mm_s[1]),
                                    travel(pose.sine));
        return {x.valid && y.valid, x.value, y.value, before_rev};
    }

    estimation::EncoderAngle<Scalar> encoder_;
    FeedFrame<Scalar> frame_{};
    estimation::FeedForceObserver<Scalar> x_drive_;
    estimation::FeedForceObserver<Scalar> y_drive_;
    Scalar spindle_before_rev_{0};
    bool has_sensor_;
};

}  // namespace millforce::firmware
