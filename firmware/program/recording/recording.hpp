// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"
#include "recording/continuous_counts.hpp"

namespace millforce::host {

/// One step at the controller's border: what went in, and the override that came out.
struct RecordedStep {
    hal::DriveSample sample;
    hal::ProgramStatus program;
    float override_ratio = 1.0F;
};

/// Writes a recording step by step: time_s, spindle_angle_rad, spindle_current_A, x_current_A … z_velocity_mm_s,
/// override, and four columns that make a replay exact: spindle_index_angle_rad (where the encoder's last index pulse
/// came; empty before the first), programmed_feed_mm_s, rapid (0 or 1) and commanded_speed_rad_s (what the spindle's
/// drive is told; 0: not known). The angles are the encoder's whole counts.
/// With a force sensor, fx_N and fy_N are the last columns.
/// A missing value is an empty cell. Appears as a whole with commit(). Steps must be less than 2³¹ µs and 2³¹ counts
/// apart.
class RecordingWriter {
  public:
    RecordingWriter(const std::filesystem::path& file, std::uint32_t encoder_counts_per_rev, bool has_force_sensor);
    void add(const RecordedStep& step);
    void commit() { file_.commit(); }

  private:
    template <typename Value>
    void cell(Value value, bool present = true);

    AtomicFile file_;
    ContinuousCounts counts_;
    bool has_force_sensor_;
    std::string line_;
};

/// Reads a recording row by row as drive samples. Columns are found by name; a current or velocity that is missing, as
/// a column or in a row, is "not present" in the sample. Required: time_s, spindle_angle_rad, spindle_current_A, and
/// one axis with current and velocity; the columns of RecordingWriter's exact replay may be missing. Throws InputError:
/// time that does not grow, angles beyond 1e7 rad, and all that CsvReader rejects.
///
/// The column `tool`, which another program writes, has the number of the tool in the spindle; an empty cell: not
/// known.
///
/// A recording with a force sensor (fx_N and fy_N, on the workpiece in the machine's axes) needs no currents, and of
/// the axes one velocity. Without spindle_index_angle_rad the angle's zero is the index, and an angle that starts again
/// at each turn is continued. An axis without a recorded velocity counts as at rest.
class RecordingReader {
  public:
    RecordingReader(const std::filesystem::path& file, std::uint32_t encoder_counts_per_rev);
    /// The same from other rows than those of a file.
    RecordingReader(std::unique_ptr<NumberTable> rows, std::uint32_t encoder_counts_per_rev);

    bool next();
    [[nodiscard]] const hal::DriveSample& sample() const { return sample_; }
    [[nodiscard]] const hal::ProgramStatus& program() const { return program_; }
    [[nodiscard]] bool has_tool() const { return tool_.has_value(); }
    /// Number of the tool in the spindle; 0: none, or not known.
    [[nodiscard]] std::uint32_t tool() const { return tool_number_; }
    [[nodiscard]] double time_s() const { return time_s_; }
    [[nodiscard]] bool has_force_sensor() const { return fx_ && fy_; }
    /// Whether index pulses are recorded; else the angle's zero stands for them.
    [[nodiscard]] bool has_index() const { return index_angle_.has_value(); }
    [[nodiscard]] bool has_one_force_only() const { return fx_.has_value() != fy_.has_value(); }
    [[nodiscard]] double fraction_read() const { return rows_->fraction_read(); }

  private:
    struct Axis {
        std::optional<CsvColumn> current;
        std::optional<CsvColumn> velocity;
    };
    void require_drives() const;
    void read_spindle();
    void read_axes();
    void read_force_sensor();
    void read_program();
    void read_tool();
    void follow_turns(double angle_rad);
    [[nodiscard]] std::optional<std::uint32_t> index_of_zero() const;
    [[nodiscard]] std::optional<std::uint32_t> count_at(std::optional<CsvColumn> angle) const;

    std::unique_ptr<NumberTable> rows_;
    std::uint32_t counts_per_rev_;
    CsvColumn time_;
    CsvColumn angle_;
    std::optional<CsvColumn> spindle_current_;
    std::array<Axis, hal::axis_count> axes_;
    std::optional<CsvColumn> fx_;
    std::optional<CsvColumn> fy_;
    std::optional<CsvColumn> index_angle_;
    std::optional<CsvColumn> programmed_feed_;
    std::optional<CsvColumn> rapid_;
    std::optional<CsvColumn> commanded_speed_;
    std::optional<CsvColumn> tool_;
    hal::DriveSample sample_{};
    hal::ProgramStatus program_{};
    std::uint32_t tool_number_ = 0;
    double time_s_ = no_estimate;
    double last_angle_rad_ = 0.0;
    std::uint32_t whole_turns_ = 0;
    std::uint32_t index_count_ = 0;
    std::uint8_t index_number_ = 0;
};

}  // namespace millforce::host
