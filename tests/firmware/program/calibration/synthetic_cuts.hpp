// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"
#include "estimation/cutting/cutting_law.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

/// Tables of cuts whose law is known.

namespace millforce::test {

struct CutsToMake {
    estimation::CutSide side = estimation::CutSide::down;
    std::vector<double> feeds_per_tooth_mm{0.02, 0.04, 0.08, 0.12};
    std::vector<double> widths_mm{0.6, 1.2, 2.4, 4.0, 6.4};
    double error = 0.02;  ///< standard deviation of a measured value, relative
    unsigned seed = 1;
    bool with_normal_force = true;
    bool with_feed_force = false;
};

/// Ø8 mm, four flutes, 1260 1/min, 6 mm deep.
inline std::vector<host::CutRow> make_cuts(const estimation::CuttingLaw<double>& law, const CutsToMake& make) {
    std::mt19937_64 generator(make.seed);
    std::normal_distribution<double> normal;
    const auto measured = [&](double value) { return value * (1.0 + make.error * normal(generator)); };
    std::vector<host::CutRow> cuts;
    for (const double f_z : make.feeds_per_tooth_mm) {
        for (const double width_mm : make.widths_mm) {
            host::CutRow row;
            row.tool_diameter_mm = 8.0;
            row.flutes = 4.0;
            row.spindle_rad_s = 1260.0 * std::numbers::pi / 30.0;
            row.axial_depth_mm = 6.0;
            row.radial_width_mm = width_mm;
            row.feed_mm_s = f_z * row.flutes * row.spindle_rad_s / (2.0 * std::numbers::pi);
            const auto forces = estimation::average_forces(law, row.measurement(make.side).cut);
            row.spindle_torque_Nm = measured(forces.tangential_N * row.radius_mm() / 1000.0);
            row.normal_force_N = make.with_normal_force ? measured(-forces.normal_N) : host::no_estimate;
            row.feed_force_N = make.with_feed_force ? measured(forces.feed_N) : host::no_estimate;
            cuts.push_back(row);
        }
    }
    return cuts;
}

inline std::string table_of(const std::vector<host::CutRow>& cuts) {
    std::ostringstream text;
    text.precision(10);
    text << "tool_diameter_mm,flutes,spindle_rad_s,axial_depth_mm,radial_width_mm,feed_mm_s,spindle_torque_Nm,"
            "normal_force_N,feed_force_N\n";
    const auto cell = [](double value) { return std::isnan(value) ? std::string() : host::CsvWriter::cell(value); };
    for (const host::CutRow& row : cuts) {
        text << row.tool_diameter_mm << ',' << row.flutes << ',' << row.spindle_rad_s << ',' << row.axial_depth_mm
             << ',' << row.radial_width_mm << ',' << row.feed_mm_s << ',' << row.spindle_torque_Nm << ','
             << cell(row.normal_force_N) << ',' << cell(row.feed_force_N) << '\n';
    }
    return text.str();
}

/// Kim & Chung's carbide end mill in SM45C.
inline estimation::CuttingLaw<double> carbide_law() {
    estimation::CuttingLaw<double> law;
    law.k_s_N_per_mm2 = 1007.59;
    law.p_s = -0.2557;
    law.k_1 = 0.2242;
    law.p_1 = -0.1546;
    return law;
}

}  // namespace millforce::test
