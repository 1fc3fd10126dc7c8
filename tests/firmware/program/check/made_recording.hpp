// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "check/finding.hpp"
#include "firmware/parameters.hpp"
#include "hal/drive_sample.hpp"

/// A recording of the simulated machine of sim/scenarios/machines/vmc.toml, with its noise: the spindle turns with the
/// axes at rest, x and y go to and fro in air, and a cut along x follows.

namespace millforce::test {

struct RecordedSample {
    double time_s = 0.0;
    hal::DriveSample drives;
};
using MadeRecording = std::vector<RecordedSample>;

struct RecordingSettings {
    std::uint64_t seed = 1;
    int teeth = 4;
    double rate_hz = 1000.0;
    double spindle_rpm = 3000.0;
    double friction_scale = 1.0;
    bool has_rest = true;  ///< the axes rest in the beginning, between moves and in the end
    bool has_air = true;   ///< else it is one cut
    bool has_y = true;     ///< y moves in air
    bool has_cut = true;
};

MadeRecording made_recording(const RecordingSettings& settings);

/// machines/vmc.toml and tools/endmill_10mm.toml.
firmware::Parameters<float> right_parameters();

/// All findings, a line each.
std::string lines_of(const host::Findings& findings);

/// Of the recording against the parameters; with index pulses or without. `commanded_rad_s`: what the CNC tells.
std::string lines_for(const MadeRecording& recording, const firmware::Parameters<float>& parameters,
                      bool has_index = true, float commanded_rad_s = 0.0F);

/// The recording after `change` of each sample's drives.
template <typename Change>
MadeRecording changed(MadeRecording recording, Change change) {
    for (RecordedSample& sample : recording) {
        change(sample.drives);
    }
    return recording;
}

}  // namespace millforce::test
