// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"
#include "calibration/recorded_cuts.hpp"
#include "estimation_calibration/current_cutting_fit.hpp"
#include "firmware/parameters.hpp"

#include <vector>

/// Forces of recorded cuts from the drives' currents, by a calibrated machine.

namespace millforce::host {

using MachineParameters = firmware::MachineParameters<float>;

/// σ I_f(w) of Kim & Chung Eq. 9: the friction current in air, with the sign of the feed; without the weight's share.
double signed_friction_current_A(const MachineParameters& machine, std::size_t axis, double feed_m_per_min);

/// Throws InputError where the stretch is slower than the axis' velocity_floor_mm_s.
void refuse_below_velocity_floor(const RecordedStretch& stretch, const MachineParameters& machine);

/// K_t1 g(ω): torque per ampere, with field weakening.
double spindle_gain_Nm_per_A(const MachineParameters& machine, double spindle_rad_s);

/// What the drives show in air at the time of a cut: between the stretches in air before and after it in the same
/// recording, or as in the nearest if there is air on one side only. The friction is taken from air at the feed of the
/// cut if there is any.
struct AirBaseline {
    double idle_current_A = 0.0;
    double friction_scale = 1.0;  ///< κ: friction then over that of the machine file
};

/// Throws InputError, naming the cut, where its recording has no stretch in air with the same axis and direction.
AirBaseline air_baseline(const std::vector<RecordedStretch>& stretches, const RecordedStretch& cut,
                         const MachineParameters& machine);

/// The cuts among the stretches, with T = K_t1 (I − I_idle) and F_ax = K_x4 (I − I_g − κ I_f) + K_x5/w along the feed.
/// Throws InputError where the machine has no K_x4 for the axis that feeds, or as above.
std::vector<CutRow> forces_of_cuts(const std::vector<RecordedStretch>& stretches, const MachineParameters& machine);

/// Doubt of the forces from the machine's gains (gain_relative_sd). Standard cuts give both gains by one database: what
/// both doubts have in common, the smaller one, is taken for shared.
estimation::DriveGainDoubt gain_doubt(const MachineParameters& machine, std::size_t axis);

}  // namespace millforce::host
