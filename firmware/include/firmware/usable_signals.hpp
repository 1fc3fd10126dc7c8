// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cut_estimate.hpp"
#include "hal/drive_sample.hpp"

namespace millforce::firmware {

/// The sample without what is absent, not finite or faster than 10 m/s, an axis as a whole; its encoder and force
/// sensor are left out.
[[nodiscard]] hal::DriveSample usable_drives_of(const hal::DriveSample& sample);

/// A velocity is there, and is not finite or faster than 10 m/s: how the axes move is not known.
[[nodiscard]] bool has_impossible_velocity(const hal::DriveSample& sample);

template <typename Scalar>
[[nodiscard]] estimation::DriveSignals<Scalar> usable_signals_of(const hal::DriveSample& sample) {
    const hal::DriveSample usable = usable_drives_of(sample);
    const auto& [x_A, y_A, z_A] = usable.axis_current_A;
    const auto& [x_mm_s, y_mm_s, z_mm_s] = usable.axis_velocity_mm_s;
    estimation::DriveSignals<Scalar> signals;
    signals.values << Scalar(usable.spindle_current_A), Scalar(x_A), Scalar(y_A), Scalar(z_A), Scalar(x_mm_s),
        Scalar(y_mm_s), Scalar(z_mm_s);
    constexpr unsigned first_drive = 1;  // bit 0 of hal::DriveSample::present is the encoder
    signals.present = usable.present >> first_drive;
    return signals;
}

}  // namespace millforce::firmware
