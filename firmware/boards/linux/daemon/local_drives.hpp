// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "files/machine_bus.hpp"
#include "hal/can_frame.hpp"
#include "iio/adc_currents.hpp"
#include "iio/counter_input.hpp"

/// Drives without a bus, on the bus: at each SYNC the motor currents of a converter, and the counts of encoders, go out
/// as PDOs of their nodes. So they are recorded, replayed and watched as any drive's values are: one that is missing,
/// stale or out of range makes the sample incomplete, and after the CNC's `stale_s` the feed is held with the fault
/// `stale_input`.
///
/// | object | width | unit |
/// |---|---|---|
/// | 0x6078 | 32 | mA (per mille of 1 A) |
/// | 0x6064, spindle with a counter | 32 | counts |
/// | 0x606C, axis with a counter | 32 | µm/s |
///
/// The current is the converter's mean since the SYNC before. A drive of the bus that tells its motion alone keeps its
/// own PDOs beside this one. No heap after construction; reads of a slow converter's sysfs files block. One thread.

namespace millforce::host {

struct LocalInputHealth {
    bool is_failed = false;
    const char* what = "";  ///< one word, e.g. `absent`
    iio::Fault fault{};     ///< the file, where one is at fault
};

class LocalDrives {
  public:
    /// Throws InputError: a path or a channel's name that is too long.
    explicit LocalDrives(const MachineBus& bus);

    /// When a SYNC was on the bus; `now_us` on CLOCK_MONOTONIC.
    void on_sync(std::uint64_t now_us);
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);
    [[nodiscard]] LocalInputHealth health() const;

  private:
    struct Drive {
        std::uint32_t id = 0;  ///< 0: not local
        std::optional<iio::CounterInput> counter{};
    };
    void read(std::size_t place, const iio::CurrentReading& currents, std::uint64_t now_us);

    std::optional<iio::AdcCurrents> adc_{};
    std::array<Drive, iio::drive_capacity> drives_{};
    std::array<hal::CanFrame, iio::drive_capacity> outgoing_{};
    std::size_t outgoing_count_ = 0;
    std::size_t taken_ = 0;
};

}  // namespace millforce::host
