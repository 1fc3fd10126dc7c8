// SPDX-License-Identifier: Apache-2.0
#include "telemetry/telemetry.hpp"

namespace millforce::host {

TelemetryMaker::TelemetryMaker(const ToolSet& tools, std::int64_t unix_offset_us)
    : forces_(tools), unix_offset_us_(unix_offset_us) {
    if (!forces_.has_numbers()) {
        tooth_force_limits_N_.emplace(0, tools.parameters().tool.tooth_force_limit_N);
    }
    for (const NumberedTool& tool : tools.tools()) {
        tooth_force_limits_N_.emplace(tool.number, tool.parameters.tooth_force_limit_N);
    }
}

Telemetry TelemetryMaker::of(const TelemetrySample& sample, std::uint64_t lost) const {
    Telemetry made;
    made.unix_us = static_cast<std::uint64_t>(static_cast<std::int64_t>(sample.monotonic_us) + unix_offset_us_);
    made.time_s = 1e-6 * static_cast<double>(sample.tick.time_us);
    made.sample = sample;
    made.shown = forces_.of(sample.tick, sample.tool);
    if (const auto limit = tooth_force_limits_N_.find(sample.tool); limit != tooth_force_limits_N_.end()) {
        made.tooth_force_limit_N = limit->second;
    }
    made.lost = lost;
    return made;
}

}  // namespace millforce::host
