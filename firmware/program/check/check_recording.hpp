// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/encoder_counts.hpp"
#include "check/finding.hpp"
#include "check/motion_windows.hpp"
#include "check/order_spectrum.hpp"
#include "firmware/parameters.hpp"
#include "hal/drive_sample.hpp"

#include <array>
#include <filesystem>
#include <optional>

namespace millforce::host {

/// A recording against machine.toml and tool.toml, sample by sample. Memory: 300 bytes for each fifth of a second and
/// 1.7 kB for each eight revolutions.
class RecordingCheck {
  public:
    /// `has_index`: index pulses are recorded.
    RecordingCheck(const firmware::Parameters<float>& parameters, bool has_index);

    void add(double time_s, const hal::DriveSample& sample, const hal::ProgramStatus& program);

    /// After the last sample. `name` of the recording, for messages.
    [[nodiscard]] Findings findings(const std::string& name) const;

  private:
    /// Whether a current has shown more than one value.
    class Channel {
      public:
        void add(bool is_present, float value);
        [[nodiscard]] bool stands() const { return samples_ > fewest_samples && !changed_; }

      private:
        static constexpr std::size_t fewest_samples = 100;
        std::size_t samples_ = 0;
        float first_ = 0.0F;
        bool changed_ = false;
    };
    void add_to_spectrum(double time_s, const hal::DriveSample& sample);
    [[nodiscard]] Findings why_nothing_is_judged() const;

    firmware::Parameters<float> parameters_;
    bool has_index_;
    std::size_t samples_ = 0;
    double first_s_ = 0.0;
    double last_s_ = 0.0;
    MotionWindows windows_;
    EncoderCounts encoder_;
    std::array<Channel, 1 + hal::axis_count> channels_{};
    OrderBlocks
        blocks_;  ///< blocks of the force sensor's direction x where there is one, else of the spindle's current
    bool has_force_ = false;
    std::optional<std::uint32_t> last_count_;
};

/// Reads the recording as `millforce replay` does; throws InputError as RecordingReader does.
Findings check_recording(const std::filesystem::path& recording, const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
