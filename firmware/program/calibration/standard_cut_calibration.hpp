// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/calibration_report.hpp"
#include "calibration/drive_forces.hpp"
#include "estimation_calibration/standard_cut_fit.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace millforce::host {

/// What `millforce calibrate standard-cut` was called with.
struct StandardCutOptions {
    std::vector<std::filesystem::path> data;  ///< recordings
    std::filesystem::path cuts;               ///< table of cuts; see recorded_cuts.hpp
    std::filesystem::path machine;            ///< file with the friction of the air cuts
    std::filesystem::path database;           ///< coefficients of the standard tool and workpiece
    std::string entry;                        ///< entry of the database; empty: its only one
    std::filesystem::path output;
    estimation::CutSide side = estimation::CutSide::down;
};

/// Gains of the drives from stretches of standard cuts and air.
struct StandardCutGains {
    estimation::DriveGainFit spindle;
    std::array<std::optional<estimation::DriveGainFit>, 3> axes;  ///< fits of those that fed
    /// K_x5 of the axes that were fitted without it, because its standard error was larger than its value.
    std::array<std::optional<FittedValue>, 3> left_out_K_x5;
};

/// `law`: of the standard tool and workpiece. The spindle is fitted for each recording separately, because each begins
/// at another temperature, and the gains are averaged by their standard errors; K_t2 is that of the last recording. A
/// lack stays in the fits. K_x5 is always fitted; leave_out_vague_K_x5 fits again without it.
StandardCutGains standard_cut_gains(const std::vector<RecordedStretch>& stretches, const MachineParameters& machine,
                                    const estimation::CuttingLaw<double>& law, estimation::CutSide side);

/// Fits K_x4 of an axis again without K_x5 where that is smaller than its standard error: K_x5/w grows towards rest,
/// and so does what the noise has put into it.
void leave_out_vague_K_x5(StandardCutGains& gains, const std::vector<RecordedStretch>& stretches,
                          const MachineParameters& machine, const estimation::CuttingLaw<double>& law,
                          estimation::CutSide side);

/// Kim & Chung's second step: K_t1, K_t2 of the spindle and K_x4, K_x5 of the axes that fed, from standard cuts whose
/// forces are known from the database. Prints them, and writes K_t1, K_t2, K_x4, K_x5 and gain_relative_sd (the fit's
/// standard error and the database's uncertainty together) to `output`. Returns 0, or 1 where a gain is far from that
/// of the machine's file (ask_about_gain). Throws InputError for bad data, for a wrong unit, and where the cuts cannot
/// determine a parameter: it names the parameter and the missing cut.
int calibrate_standard_cut(const StandardCutOptions& options, std::ostream& out);

}  // namespace millforce::host
