#pragma once

#include <filesystem>
#include <vector>

#include "files/csv.hpp"
#include "firmware/parameters.hpp"
#include "loop/simulation.hpp"

namespace millforce::sim {

/// Writes drive samples as a recording: time_s, spindle_angle_rad, spindle_current_A, x_current_A … z_velocity_mm_s,
/// override. The angle is the encoder's: whole counts.
void write_recording(const std::filesystem::path& file, const std::vector<RecordedSample>& samples);

/// Reads a recording row by row as drive samples. Columns are found by name; a current or velocity that is missing, as a
/// column or in a row, is "not present" in the sample. Required: time_s, spindle_angle_rad, spindle_current_A, and one
/// axis with current and velocity. Throws InputError: time that does not grow, angles beyond 1e7 rad, and all that
/// CsvReader rejects.
class RecordingReader {
  public:
    RecordingReader(const std::filesystem::path& file, std::uint32_t encoder_counts_per_rev);

    bool next();
    [[nodiscard]] const hal::DriveSample& sample() const { return sample_; }
    [[nodiscard]] double time_s() const { return time_s_; }
    /// The recorded override; NaN where there is none.
    [[nodiscard]] double override_ratio() const;

  private:
    struct Axis {
        std::optional<CsvColumn> current;
        std::optional<CsvColumn> velocity;
    };
    CsvReader csv_;
    std::uint32_t counts_per_rev_;
    CsvColumn time_;
    CsvColumn angle_;
    CsvColumn spindle_current_;
    std::array<Axis, 3> axes_;
    std::optional<CsvColumn> override_;
    hal::DriveSample sample_{};
    double time_s_ = no_estimate;
};

}  // namespace millforce::sim
