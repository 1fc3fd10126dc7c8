// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "firmware/tick_record.hpp"
#include "firmware_can/conditions.hpp"
#include "hal/drive_sample.hpp"

namespace millforce::host {

/// One tick for whoever watches: what went in and what came out. Plain data, which the real-time thread fills by
/// copies.
struct TelemetrySample {
    std::uint64_t monotonic_us = 0;  ///< when the tick was done, on CLOCK_MONOTONIC
    firmware::TickRecord tick{};
    std::uint32_t tool = 0;  ///< tool that the override is for; 0: one tool, or not known
    bool is_held = true;     ///< the feed is held as the CNC is told: by the tick, or from outside of it
    hal::DriveSample drives{};
    hal::ProgramStatus program{};
    firmware::Conditions conditions{};
};

}  // namespace millforce::host
