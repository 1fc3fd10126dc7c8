// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/roughness_fit.hpp"

#include <array>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace millforce::host {

/// What `millforce calibrate roughness` was called with.
struct RoughnessCalibrationOptions {
    std::vector<std::filesystem::path> data;
    std::filesystem::path output;
    std::string measure;            ///< "Ra" or "Rz"; empty: Ra where the data have it, else Rz
    std::vector<std::string> held;  ///< columns of variables whose exponents are not fitted
};

/// Columns of the five variables, in the order of estimation::RoughnessVariable.
inline constexpr std::array<const char*, 5> roughness_columns{"spindle_speed_rpm", "feed_mm_rev", "tool_diameter_mm",
                                                              "axial_depth_mm", "force_ratio"};

/// Roughness model of a tool and a material from cutting tests: estimation::fit_roughness.
///
/// Columns: spindle_speed_rpm, feed_mm_rev (per revolution), tool_diameter_mm, axial_depth_mm; force_ratio, or in its
/// place feed_force_N and axial_force_N, of which the ratio of magnitudes is taken; the measured Ra_um or Rz_um. A row
/// with an empty roughness cell was not measured, and is left out. Rows that repeat another one exactly count once.
///
/// Prints exponents with standard errors, scatter, the test furthest off, and how many tests lie in the 95 % prediction
/// interval of the model that was fitted without them; the stated bound is 85 % of them. Writes a complete [roughness]
/// table to `output`. Returns 0, or 1 where the bound is broken or a unit is asked for. Throws InputError for bad data,
/// and where the tests cannot determine an exponent: it names the exponent and the missing variation.
int calibrate_roughness(const RoughnessCalibrationOptions& options, std::ostream& out);

}  // namespace millforce::host
