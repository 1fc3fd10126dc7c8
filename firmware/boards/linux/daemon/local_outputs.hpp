// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "gpio/feed_hold_line.hpp"
#include "gpio/gpio_chip.hpp"
#include "hal/feed_override.hpp"
#include "iio/analogue_override.hpp"
#include "parameters/local_io.hpp"

namespace millforce::host {

struct LocalOutputHealth {
    bool is_failed = false;  ///< the override does not reach the converter or the lines: the others say hold
    const char* what = "";
    iio::Fault fault{};
    int error = 0;  ///< errno
};

/// The override as a voltage and on lines of this computer, in addition to the CAN frame; each if machine.toml has it.
/// drivers/README.md says what each shows on hold, on a fault and with a dead tick. One thread; no heap after
/// construction.
class LocalOutputs {
  public:
    /// Throws InputError: a path or a name that is too long.
    explicit LocalOutputs(const LocalIoKeys& keys);

    /// With each tick's override.
    void update(const hal::FeedOverride& feed_override, std::uint64_t now_us);
    /// At least every 5 ms, whether ticks come or not.
    void poll(std::uint64_t now_us);
    [[nodiscard]] LocalOutputHealth health() const;

  private:
    std::optional<iio::AnalogueOverride> voltage_{};
    std::optional<gpio::GpioChip> chip_{};
    std::optional<gpio::FeedHoldLine> lines_{};
};

}  // namespace millforce::host
