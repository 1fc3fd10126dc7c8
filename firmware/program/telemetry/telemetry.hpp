// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "parameters/tool_set.hpp"
#include "run_log/tool_forces.hpp"
#include "telemetry/telemetry_sample.hpp"

namespace millforce::host {

/// A sample as it is shown: with what is worked out beside the real-time thread.
struct Telemetry {
    std::uint64_t unix_us = 0;  ///< when the tick was done; goes on steadily where the clock is set
    double time_s = 0.0;        ///< of the tick, by the clock of its samples
    TelemetrySample sample{};
    firmware::ShownForces shown{};
    float tooth_force_limit_N = firmware::TickRecord::no_estimate;
    std::uint64_t lost = 0;  ///< samples that did not fit between the two threads, since the start
};

/// Makes telemetry of samples. Not for the real-time thread: cost and heap of ToolForces.
class TelemetryMaker {
  public:
    /// `unix_offset_us`: Unix time minus monotonic time, in µs.
    TelemetryMaker(const ToolSet& tools, std::int64_t unix_offset_us);

    [[nodiscard]] Telemetry of(const TelemetrySample& sample, std::uint64_t lost) const;

  private:
    ToolForces forces_;
    std::map<std::uint32_t, float> tooth_force_limits_N_{};
    std::int64_t unix_offset_us_;
};

}  // namespace millforce::host
