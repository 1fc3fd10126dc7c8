// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

/// Calibration cuts as drives record them: recordings (CSV), and a table that says which stretch of which recording is
/// which cut, or running in air.

namespace millforce::host {

/// One row of the table of cuts.
struct StretchConditions {
    std::string recording;  ///< file name; empty: the only recording
    std::string place;      ///< "cuts.csv:7", for messages
    double start_s = 0.0;
    double end_s = 0.0;
    double tool_diameter_mm = 0.0;
    int flutes = 0;
    double axial_depth_mm = 0.0;
    double radial_width_mm = 0.0;

    [[nodiscard]] bool in_cut() const { return axial_depth_mm > 0.0 && radial_width_mm > 0.0; }
};

/// Averages of the drives over one stretch.
struct RecordedStretch {
    StretchConditions conditions;
    double middle_s = 0.0;
    double duration_s = 0.0;
    double spindle_current_A = 0.0;
    double spindle_rad_s = 0.0;
    std::size_t axis = 0;  ///< the one that feeds: 0 x, 1 y, 2 z
    double axis_current_A = 0.0;
    double feed_mm_s = 0.0;  ///< signed feed

    [[nodiscard]] double feed_m_per_min() const { return 0.06 * feed_mm_s; }
    [[nodiscard]] double feed_per_tooth_mm() const;
};

/// One sample of the drives; an axis that is not recorded is NaN.
struct DriveReading {
    double time_s = 0.0;
    double spindle_angle_rad = 0.0;
    double spindle_current_A = 0.0;
    std::array<double, 3> axis_current_A{};
    std::array<double, 3> axis_velocity_mm_s{};
};

/// Averages the samples of one stretch. The spindle's angle may begin again at 0 after each revolution.
class StretchAverage {
  public:
    void add(const DriveReading& reading);
    [[nodiscard]] std::size_t samples() const { return samples_; }
    /// Throws InputError where there are fewer than 20 samples, the spindle does not turn, no axis feeds or more than
    /// one does (the others faster than 2 % of it), or the feed changes by more than a tenth within the stretch.
    [[nodiscard]] RecordedStretch stretch(const StretchConditions& conditions) const;

  private:
    [[nodiscard]] std::size_t feeding_axis(const StretchConditions& conditions) const;

    std::size_t samples_ = 0;
    DriveReading first_{};
    DriveReading last_{};
    double turned_rad_ = 0.0;
    double spindle_current_ = 0.0;
    std::array<double, 3> current_{};
    std::array<double, 3> velocity_{};
    std::vector<std::array<double, 3>> velocities_;
};

/// Reads the table of cuts: start_s, end_s, tool_diameter_mm, flutes, axial_depth_mm, radial_width_mm, and `recording`
/// where there is more than one. Depth or width 0 or empty: running in air. Throws InputError; a row that repeats
/// another one is refused, too.
std::vector<StretchConditions> read_cut_table(const std::filesystem::path& table,
                                              const std::vector<std::filesystem::path>& recordings);

/// The stretches of the table, averaged, in the table's order. Recordings need time_s, spindle_angle_rad,
/// spindle_current_A, and current and velocity of an axis. Throws InputError, also where feed or speed are no tool's.
std::vector<RecordedStretch> read_recorded_cuts(const std::vector<std::filesystem::path>& recordings,
                                                const std::filesystem::path& table);

}  // namespace millforce::host
