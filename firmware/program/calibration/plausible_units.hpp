// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"
#include "files/csv.hpp"

#include <string>
#include <string_view>
#include <vector>

/// Values that no machine has, and that a wrong unit explains. Each function throws an InputError that names the value,
/// what was expected, and the likely unit.

namespace millforce::host {

/// No tool takes a larger chip: 1.5 mm per tooth and 6 % of the diameter.
double largest_feed_per_tooth_mm(double tool_diameter_mm);

/// A tool's cut: at most largest_feed_per_tooth_mm() and 120 m/s of cutting speed. `place`: "cuts.csv:7".
struct CutKinematics {
    double tool_diameter_mm = 0.0;
    double feed_mm_s = 0.0;
    double feed_per_tooth_mm = 0.0;
    double spindle_rad_s = 0.0;
};
void refuse_implausible_cut(const std::string& place, const CutKinematics& cut, std::string_view feed_column,
                            std::string_view speed_column);

/// Of K_s: wax and foam; hard steel with thin chips.
inline constexpr double softest_N_per_mm2 = 10.0;
inline constexpr double hardest_N_per_mm2 = 15000.0;

/// The median of K_s that the torques mean by F_at = K_s f_z a_p N c/2π alone, within these two. `hint`: the units to
/// look at.
void refuse_implausible_pressure(const std::string& file, const std::vector<CutRow>& cuts, estimation::CutSide side,
                                 std::string_view hint);

/// Looks at each angle of a recording in turn: one that begins again at 360 is in degrees.
class AngleUnit {
  public:
    void look_at(const CsvReader& csv, CsvColumn column, double angle);

  private:
    double last_ = 0.0;
};

}  // namespace millforce::host
