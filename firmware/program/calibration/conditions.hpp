// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/cutting_fit.hpp"
#include "files/csv.hpp"

#include <filesystem>
#include <optional>

namespace millforce::host {

/// One row of a conditions file: a straight cut, and what was measured. A value that is not given is NaN.
struct CutRow {
    double tool_diameter_mm = no_estimate;
    double flutes = no_estimate;
    double spindle_rad_s = no_estimate;
    double axial_depth_mm = no_estimate;
    double radial_width_mm = no_estimate;
    double feed_mm_s = no_estimate;
    double spindle_torque_Nm = no_estimate;
    double normal_force_N = no_estimate;  ///< −F_ay: in down milling it pushes tool and wall apart.
    double feed_force_N = no_estimate;    ///< F_ax, on the workpiece.

    /// f_z = 2π v_f / (N ω)
    double feed_per_tooth_mm() const;
    double radius_mm() const { return 0.5 * tool_diameter_mm; }
    /// Entry and exit for `width_mm`.
    estimation::EngagementAngles<double> engagement(estimation::CutSide side, double width_mm) const;
    /// The row as a measurement for the fit. Torque becomes F_at = T/R.
    estimation::CuttingMeasurement measurement(estimation::CutSide side) const;
};

/// Reads conditions (CSV): tool_diameter_mm, flutes, spindle_rad_s, feed_mm_s must be there; axial_depth_mm,
/// radial_width_mm, spindle_torque_Nm, normal_force_N and feed_force_N may be missing or empty. Values are checked:
/// diameter 0.01…1000 mm, flutes 1…100 (whole), spindle 0.1…1e6 rad/s, feed 1e-4…1e4 mm/s, axial depth above 0 to 1000
/// mm, radial width above 0 to the diameter. InputError otherwise.
class ConditionsReader {
  public:
    explicit ConditionsReader(const std::filesystem::path& file);

    bool next(CutRow& row);
    const CsvReader& csv() const { return csv_; }
    bool has_torque() const { return torque_.has_value(); }
    bool has_force() const { return normal_.has_value() || feed_force_.has_value(); }

  private:
    CsvReader csv_;
    CsvColumn diameter_, flutes_, spindle_, feed_;
    std::optional<CsvColumn> depth_, width_, torque_, normal_, feed_force_;
};

}  // namespace millforce::host
