// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "estimation/force_drop/force_drop.hpp"
#include "estimation_calibration/force_drop_calibration.hpp"
#include "reproduce/hwang_bench.hpp"
#include "reproduce/hwang_drives.hpp"

/// The project's estimator on the bench's samples: calibration, the cuts of Table 1, and the feed drives.

namespace millforce::sim {

using FloatForceDrop = estimation::ForceDrop<float>;
using FittedForceDropLaw = estimation::ForceDropLaw<double>;
using FloatForceDropEstimate = estimation::ForceDropEstimate<float>;

/// Twenty-one cuts at 300 rpm, Ø100, 3 inserts, 1.5 mm: feeds 0.10, 0.15, 0.20 mm, immersions 0.2…0.8, each with its
/// own noise, drift and mounting of the cutter. All other conditions of Table 1 are not among them.
[[nodiscard]] std::vector<estimation::ForceDropCalibrationCut> calibration_cuts(const BenchMaterial& material,
                                                                                bool up_milling, std::uint64_t seed);

[[nodiscard]] estimation::ForceDropCalibration calibration_of(
    const std::vector<estimation::ForceDropCalibrationCut>& cuts);

/// One estimate and the truth.
struct ForceDropRun {
    double immersion = 0.0;  ///< true
    FloatForceDropEstimate estimate{};
    double revolution = 0.0;  ///< place of the last sample
};

[[nodiscard]] estimation::ForceDropSettings<float> force_drop_settings(const BenchCut& cut, int revolutions);

/// Every estimate that the samples give.
[[nodiscard]] std::vector<ForceDropRun> run_force_drop(const FittedForceDropLaw& law, const BenchCut& cut,
                                                       int revolutions, const std::vector<BenchSample>& samples);

/// The same from the drives' currents and velocities.
[[nodiscard]] std::vector<ForceDropRun> run_force_drop_on_drives(const FittedForceDropLaw& law,
                                                                 const DriveCut& drive_cut, int revolutions,
                                                                 const DriveRecording& recording);

}  // namespace millforce::sim
