// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/coefficient_library.hpp"
#include "calibration/drive_forces.hpp"

namespace millforce::host {

/// One cut that the fit has not seen: what the calibrated drives say, and what the published law says.
struct ValidatedCut {
    std::string axis;
    double feed_mm_min = 0.0;
    double radial_width_mm = 0.0;
    double torque_Nm = 0.0;
    double expected_torque_Nm = 0.0;
    double feed_force_N = 0.0;
    double expected_feed_force_N = 0.0;
    double torque_bound = 0.0;  ///< relative: twice the stated deviation
    double force_bound = 0.0;

    [[nodiscard]] double torque_error() const { return torque_Nm / expected_torque_Nm - 1.0; }
    [[nodiscard]] double force_error() const { return feed_force_N / expected_feed_force_N - 1.0; }
    [[nodiscard]] bool holds() const;
};

/// Throws InputError as read_recorded_cuts() and forces_of_cuts() do.
std::vector<ValidatedCut> validate_cuts(const std::vector<std::filesystem::path>& recordings,
                                        const std::filesystem::path& cuts, const MachineParameters& machine,
                                        const LibraryEntry& entry, estimation::CutSide side);

}  // namespace millforce::host
