// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/friction_calibration.hpp"

#include <ostream>

namespace millforce::host {

/// calibrate_friction of position and motor force.
int calibrate_motion_friction(const FrictionCalibrationOptions& options, std::ostream& out);

}  // namespace millforce::host
