// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"
#include "files/csv.hpp"

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

/// Values that no machine has, and that a wrong unit explains. Each function throws an InputError that names the value,
/// what was expected, and the likely unit. What few machines have is asked about instead. Of drives:
/// plausible_drives.hpp.

namespace millforce::host {

/// What a sound machine may answer with no: each is printed as a warning, and the command ends with exit code 1.
using UnitQuestions = std::vector<std::string>;
void append(UnitQuestions& questions, const UnitQuestions& more);
/// Prints them; returns `exit_code` where there are none.
int ask(std::ostream& out, const UnitQuestions& questions, int exit_code);

/// The upper one of the two in the middle, where there are two. `values` holds one at least.
double median_of(std::vector<double> values);

/// No tool takes a larger chip: 1.5 mm per tooth and 6 % of the diameter.
double largest_feed_per_tooth_mm(double tool_diameter_mm);
/// Nor a thinner one than 10⁻⁴ of the diameter: edges are rounded to some 5·10⁻⁴ of it, and only rub below a fifth of
/// that.
double smallest_feed_per_tooth_mm(double tool_diameter_mm);

/// A tool's cut: a chip between these two, and 0.01 to 120 m/s of cutting speed. `place`: "cuts.csv:7". Where the speed
/// comes from an angle, a wrong unit of time is named, too.
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

/// Where the torques, forces and speeds of cuts come from.
enum class CutSource { table, recording };

/// The median of K_s that the torques mean by F_at = K_s f_z a_p N c/2π alone, within these two.
void refuse_implausible_pressure(const std::string& file, const std::vector<CutRow>& cuts, estimation::CutSide side,
                                 CutSource source);

/// Asks about a K_s that is usual, but not at the cuts' speed: K_s times the cutting speed is the power for each mm² of
/// chip, 500 W for steel by slow HSS and for plastics, 64 000 W for aluminium at 80 m/s. A speed in 1/s makes it 39
/// times too small, one in 1/min 91 times too large. Usual are 200 to 100 000 W.
UnitQuestions ask_about_speed_of(const std::vector<CutRow>& cuts, estimation::CutSide side, CutSource source);

/// The medians of the measured forces, normal and along the feed: each 0.02 to 20 times the force along the edge that
/// the torque means. Geometry and r_1 leave 0.1 to 3.
void refuse_implausible_forces(const std::string& file, const std::vector<CutRow>& cuts, CutSource source);

/// A force sensor's average force over what the tool's [cutting] law gives for the same cut, as a median over cuts.
/// Throws where the pressure that it means is none of a material; asks where it is not a quarter to four times the
/// law's.
UnitQuestions force_against_law(const std::string& table, double measured_over_law, double law_N_per_mm2);

/// The two components of that force over the law's, along and across the feed: asks where one is more than four times
/// the other, as when fx_N or fy_N alone is in another unit.
UnitQuestions ask_about_one_force(double along_over_law, double across_over_law);

/// Whether all speeds are multiples of 50 1/min if `per_minute` turns them into 1/min, to a unit of the fourth digit,
/// and are no whole numbers themselves.
bool is_round_only_by(const std::vector<double>& speeds, double per_minute);

/// Cuts whose roughness was measured: rows as in the file.
struct RoughnessUnits {
    std::string place;
    double spindle_rpm = 0.0;
    double feed_mm_rev = 0.0;
    double tool_diameter_mm = 0.0;
    double axial_depth_mm = 0.0;
    double force_ratio = 0.0;
    double roughness_um = 0.0;
};
/// Throws where the cutting speed is not 0.01 to 120 m/s, the feed per revolution more than the diameter (16 teeth of 6
/// %) or less than 10⁻⁴ of it, the depth more than 10 diameters or less than 10⁻⁴ of one, the ratio of forces not 0.01
/// to 100, or the median roughness ten times beyond the grades of ISO 1302 (R_a 0.025 to 50 µm, R_z four times that).
/// Asks where the roughness is beyond the grades, where the feed is more than 0.3 diameters, and where only another
/// unit makes round spindle speeds.
UnitQuestions look_at_roughness_tests(const std::vector<RoughnessUnits>& tests, const std::string& measure);

/// Looks at each angle of a recording in turn: one that begins again at 360 is in degrees, one that does so at 1 in
/// revolutions. The latter shows at the end.
class AngleUnit {
  public:
    void look_at(const CsvReader& csv, CsvColumn column, double angle);
    void look_at_end(const CsvReader& csv) const;

  private:
    double last_ = 0.0;
    double smallest_ = 0.0;
    double largest_ = 0.0;
    int falls_ = 0;
};

/// Why the angles of a whole recording are in another unit. Throws where it cannot be read.
std::optional<std::string> angle_in_another_unit(const std::filesystem::path& recording);

}  // namespace millforce::host
