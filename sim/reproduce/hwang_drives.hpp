// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hal/drive_sample.hpp"
#include "reproduce/hwang_bench.hpp"

/// The bench's cut on the simulated machine instead of the dynamometer: what the feed drives report.

namespace millforce::sim {

struct DriveCut {
    BenchCut cut{};
    double feed_direction_rad = 0.0;  ///< from machine x towards machine y
    double air_s = 0.8;               ///< the axes travel before the tool meets the workpiece
    double cut_s = 6.0;
    double sample_s = 1e-3;
    std::uint64_t seed = 1;
};

struct DriveRecording {
    std::vector<hal::DriveSample> samples;  ///< samples of the cut alone, its first half second left out
    std::uint32_t encoder_counts_per_rev = 0;
};

[[nodiscard]] DriveRecording drive_recording(const DriveCut& drive_cut);

}  // namespace millforce::sim
