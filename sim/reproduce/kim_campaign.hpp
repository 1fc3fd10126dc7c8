// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/cutting_calibration.hpp"
#include "calibration/drive_forces.hpp"
#include "calibration/standard_cut_calibration.hpp"
#include "cutting/cutting_coefficients.hpp"

#include <cstdint>
#include <vector>

/// Kim & Chung's three steps on simulated machines: air cuts, standard cuts, cuts with an unknown tool. The drives are
/// those of sim/machine, with friction, noise, quantisation and a bearing that warms up; their constants differ from
/// machine to machine, and nothing but recorded currents reaches the estimators.

namespace millforce::sim {

/// Table 1 and the text next to it.
struct KimStandardCut {
    static constexpr double diameter_mm = 8.0;
    static constexpr int flutes = 4;
    static constexpr double spindle_rpm = 1260.0;
    static constexpr double feed_mm_min = 250.0;
    static constexpr double radial_width_mm = 0.8;
    static constexpr double axial_depth_mm = 12.0;
    static constexpr double radius_mm = 0.5 * diameter_mm;
    static constexpr double feed_per_tooth_mm = feed_mm_min / (flutes * spindle_rpm);
};

struct KimCut {
    double feed_mm_min = KimStandardCut::feed_mm_min;
    double radial_width_mm = KimStandardCut::radial_width_mm;
    double axial_depth_mm = KimStandardCut::axial_depth_mm;
    bool up = false;
};

/// One machine: what its drives are.
struct KimMachine {
    std::uint64_t seed = 1;
    double torque_constant_Nm_per_A = 0.7;
    double force_constant_N_per_A = 120.0;
    double friction_scale = 1.0;
    double start_mm = 0.0;  ///< phase of the screw's ripple

    /// Constants within 10 %, friction within 20 % of the usual; the first machine is the usual one.
    static KimMachine numbered(std::uint64_t number);
};

/// All cuts in one recording, each after running in air at the same feed: 2 mm for the drives to settle, then as many
/// turns of the screw as take 6 s. Air once more at the end.
std::vector<host::RecordedStretch> simulate_cuts(const KimMachine& machine, const AverageChipLaw& law,
                                                 const std::vector<KimCut>& cuts, std::uint64_t noise);

/// One feed of step 1.
struct KimAirCut {
    double feed_m_per_min = 0.0;
    double current_A = 0.0;
};

/// What the three steps gave on one machine.
struct KimCampaign {
    KimMachine machine;
    std::vector<KimAirCut> air_cuts;
    host::MachineParameters calibrated;  ///< after steps 1 and 2
    host::StandardCutGains gains;        ///< gains of step 2
    std::vector<host::RecordedStretch> standard_cuts;
    estimation::DriveGainDoubt gain_doubt;
    double idle_torque_Nm = 0.0;  ///< torque of the plant's warm bearing at the spindle's speed
};

/// Steps 1 and 2; the forces of the standard cuts by `database`, which is the plant's law as well.
KimCampaign calibrate_machine(const KimMachine& machine, const AverageChipLaw& database);

/// Step 3 on a calibrated machine.
struct KimUnknownTool {
    std::vector<host::RecordedStretch> stretches;
    std::vector<host::CutRow> cuts;  ///< with forces from currents
    estimation::CuttingFit fit;
};
KimUnknownTool calibrate_tool(const KimCampaign& campaign, const AverageChipLaw& law, std::uint64_t noise);

std::vector<KimCut> kim_standard_cuts();
std::vector<KimCut> kim_unknown_cuts();

/// The law in the estimators' words.
estimation::CuttingLaw<double> closed_law(const AverageChipLaw& law);

}  // namespace millforce::sim
