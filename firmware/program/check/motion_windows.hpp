// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

/// A recording in windows of a fifth of a second: means of the drives' signals, and whether they were steady.

namespace millforce::host {

enum class ToolPlace : unsigned char { unknown, in_air, in_cut };

struct AxisWindow {
    bool is_present = false;  ///< current and velocity are there in every sample
    double current_A = 0.0;
    double velocity_mm_s = 0.0;
    double slowest_mm_s = std::numeric_limits<double>::infinity();  ///< smallest velocity, with its sign
    double fastest_mm_s = -std::numeric_limits<double>::infinity();

    [[nodiscard]] bool is_at_rest() const;
    /// Moves, at a velocity that changes by less than a tenth.
    [[nodiscard]] bool is_steady() const;
};

struct MotionWindow {
    double start_s = 0.0;
    double duration_s = 0.0;
    std::size_t samples = 0;
    double turned_rev = 0.0;  ///< by the stated counts per revolution
    double spindle_acceleration_rad_s2 = 0.0;
    bool has_spindle_current = false;  ///< every sample has it
    double spindle_current_A = 0.0;
    std::array<AxisWindow, hal::axis_count> axes{};
    bool is_rapid = false;
    double programmed_feed_mm_s = 0.0;  ///< the largest of the window; 0: not known
    double commanded_rad_s = 0.0;       ///< speed that the spindle is commanded; 0: not told, or it changes
    ToolPlace place = ToolPlace::unknown;

    [[nodiscard]] double end_s() const { return start_s + duration_s; }
    [[nodiscard]] double spindle_rad_s() const;
    [[nodiscard]] bool turns() const { return turned_rev > 0.5; }
    [[nodiscard]] bool turns_steadily() const;
    /// Along its path, of the axes that are present.
    [[nodiscard]] double speed_mm_s() const;
    [[nodiscard]] bool moves() const;
    [[nodiscard]] bool is_at_rest() const;
};

/// Fills windows sample by sample. A gap of more than a tenth of a second begins a new one.
class MotionWindows {
  public:
    explicit MotionWindows(std::uint32_t encoder_counts_per_rev);

    void add(double time_s, const hal::DriveSample& sample, const hal::ProgramStatus& program);
    /// The windows that were filled; the rest at the end is left out.
    [[nodiscard]] const std::vector<MotionWindow>& windows() const { return windows_; }

  private:
    void begin(double time_s);
    void add_axes(const hal::DriveSample& sample);
    void close(double end_s);

    double counts_per_rev_;
    std::vector<MotionWindow> windows_;
    MotionWindow window_{};
    double first_half_rev_ = 0.0;
    double first_half_s_ = 0.0;
    double last_s_ = 0.0;
    std::uint32_t last_count_ = 0;
    bool has_last_ = false;
};

}  // namespace millforce::host
