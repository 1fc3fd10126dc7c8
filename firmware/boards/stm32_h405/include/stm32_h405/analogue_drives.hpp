// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hal/drive_source.hpp"
#include "stm32/current_scan.hpp"
#include "stm32/timers.hpp"
#include "stm32_h405/motion.hpp"
#include "stm32_h405/wiring.hpp"

namespace millforce::stm32_h405 {

/// Drives wired to the chip: currents by its converter, motion by its timers' encoder inputs. poll() reads both: once
/// per sample period, and the sample has its time. A spindle count that its index contradicts is absent (EncoderWatch).
/// No heap; no interrupt; one thread. Cost: that of CurrentScan::take() and four encoders.
class AnalogueDrives final : public hal::DriveSource {
  public:
    /// `wiring` outlives it.
    AnalogueDrives(const Peripherals& peripherals, const Wiring& wiring);

    void start();
    void watch_spindle(std::uint32_t counts_per_rev) { encoder_watch_ = EncoderWatch(counts_per_rev); }

    void poll(std::uint64_t now_us) override;
    [[nodiscard]] bool take_sample(hal::DriveSample& sample) override;
    [[nodiscard]] std::uint8_t complete() const override { return hal::all_present; }
    [[nodiscard]] hal::SourceState state() const override { return state_; }

    [[nodiscard]] stm32::CurrentScan& currents() { return currents_; }

  private:
    void read_spindle(const stm32::ScanReading& currents, hal::DriveSample& sample);
    void read_axis(std::size_t axis, const stm32::ScanReading& currents, hal::DriveSample& sample);

    const Wiring& wiring_;
    stm32::Encoder spindle_;
    std::array<stm32::Encoder, hal::axis_count> axes_;
    stm32::CurrentScan currents_;
    std::array<AxisVelocity, hal::axis_count> velocities_{};
    EncoderWatch encoder_watch_{0};
    hal::DriveSample sample_{};
    bool has_sample_ = false;
    hal::SourceState state_ = hal::SourceState::waiting;
};

}  // namespace millforce::stm32_h405
