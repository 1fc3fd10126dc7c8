// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace millforce::host {

/// What `millforce calibrate friction` was called with.
struct FrictionCalibrationOptions {
    std::vector<std::filesystem::path> data;
    std::filesystem::path output;
    std::string axis = "x";                        ///< table for data of a single axis (position_m, motor_force_N).
    double low_pass_hz = 20.0;                     ///< corner for position and force alike
    double minimum_speed_mm_s = 2.0;               ///< slower samples are pre-sliding: left out.
    std::optional<double> force_constant_N_per_A;  ///< of motor_force_N: the friction as a current is written, too
};

/// Friction and inertia of feed axes from motion without cutting. The columns show which kind of data it is:
///
///  - time_s, position_m, motor_force_N: one axis, evenly sampled. Position and force pass one zero-phase low-pass;
///    velocity and acceleration are central differences; M, F_v, F_c and offset follow by least squares
///    (estimation::MechanicalFrictionFit), over both directions together and by direction. Standard errors count
///    correlated samples as few. As a check the axis is fitted on the first half alone, and the force that it then
///    seems to feel in the second half is a phantom: more than 1.5 times the residual and the prediction error is a
///    broken bound; so is a friction that differs by more than 10 % and four standard deviations.
///  - time_s, AXIS_velocity_mm_s, AXIS_current_A for AXIS x, y, z: a recording of air cuts at several feeds. Each
///    stretch with steady feed becomes one row of estimation::FeedCurrentFit; K_x1…K_x3 in A and m/min. An axis that
///    did not move enough is left out and named, unless none is left. As a check a drift with time is fitted beside the
///    friction: more than 10 % from the first stretch to the last, and twice its 95 % band, is a broken bound.
///
/// A parameter whose standard error is larger than its value (K_x1: whose 95 % band is) is left out: the fit is made
/// without it, and it is not written.
///
/// Prints the fit on `out` and writes `output`. Returns 0, or 1 where the bound is broken or a unit is asked for;
/// where the data cannot show a change, the report says so. Throws InputError for bad data, for a reversed sign or a
/// wrong unit, and where the data cannot determine a parameter that the friction needs: it names the parameter and what
/// to measure.
int calibrate_friction(const FrictionCalibrationOptions& options, std::ostream& out);

}  // namespace millforce::host
