// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/spindle_fit.hpp"

#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace millforce::host {

/// The rows of all files whose torque is known.
struct KnownSpindleTorques {
    std::vector<estimation::SpindleSample> samples;
    std::vector<std::string> places;  ///< "spindle.csv:3" of each
    bool by_angle = false;            ///< the speed of some comes from an angle
};

/// Reads the columns that calibrate_spindle names. Rows of a table that repeat another one count once; spikes of the
/// current of a recording are replaced before the low-pass. Both are named on `out`. Throws InputError for bad data,
/// for values that only a wrong unit explains, and where fewer than four rows are left.
KnownSpindleTorques read_known_spindle_torques(const std::vector<std::filesystem::path>& data, double low_pass_hz,
                                               std::ostream& out);

}  // namespace millforce::host
