// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "telemetry/telemetry.hpp"

namespace millforce::host {

enum class EventLevel : std::uint8_t { info, warning, fault };

constexpr const char* name(EventLevel level) {
    return level == EventLevel::fault ? "fault" : level == EventLevel::warning ? "warning" : "info";
}

/// Something that began or ended between two ticks.
struct TelemetryEvent {
    std::uint64_t unix_us = 0;
    EventLevel level = EventLevel::info;
    std::string text;  ///< e.g. "fault: overload", "drive_lost", "drive_lost ended"; printable
};

/// Finds events by comparing each sample with the one before.
class EventWatch {
  public:
    using Report = std::function<void(const TelemetryEvent&)>;

    void follow(const Telemetry& telemetry, const Report& report);

  private:
    std::optional<TelemetrySample> last_{};
};

}  // namespace millforce::host
