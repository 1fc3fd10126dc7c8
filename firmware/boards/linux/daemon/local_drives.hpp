// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "hal/drive_source.hpp"
#include "iio/adc_currents.hpp"
#include "iio/counter_input.hpp"
#include "parameters/machine_bus.hpp"

/// Drives without a bus: motor currents by a converter, and where they are wired encoders by counters, of this
/// computer. poll() reads them, at each SYNC. The current is the converter's mean since the poll() before.
///
/// A drive of the bus that gives its motion alone keeps its PDOs, and has its current from here. What cannot be read,
/// is stale or out of range is absent: the sample is incomplete, and after the CNC's `stale_s` the feed is held with
/// the fault `stale_input`. No heap after construction; reads of a slow converter's sysfs files block. One thread.

namespace millforce::host {

struct LocalInputHealth {
    bool is_failed = false;
    const char* what = "";  ///< one word, e.g. `absent`
    iio::Fault fault{};     ///< the file, where one is at fault
};

class LocalDrives final : public hal::DriveSource {
  public:
    /// Throws InputError: a path or a channel's name that is too long.
    explicit LocalDrives(const MachineBus& bus);

    /// When a SYNC was on the bus; `now_us` on CLOCK_MONOTONIC.
    void poll(std::uint64_t now_us) override;
    [[nodiscard]] bool take_sample(hal::DriveSample& sample) override;
    [[nodiscard]] std::uint8_t complete() const override { return complete_; }
    [[nodiscard]] hal::SourceState state() const override;
    [[nodiscard]] LocalInputHealth health() const;

  private:
    [[nodiscard]] iio::MotionReading read_motion(std::uint64_t now_us);

    std::uint8_t complete_;
    std::optional<iio::AdcCurrents> adc_{};
    std::array<std::optional<iio::CounterInput>, iio::drive_capacity> counters_{};
    std::array<float, hal::axis_count> largest_velocity_mm_s_{};
    hal::DriveSample sample_{};
    bool has_sample_ = false;
    bool had_sample_ = false;
};

}  // namespace millforce::host
