// SPDX-License-Identifier: Apache-2.0
#include "run_log/estimate_line.hpp"

#include <fmt/format.h>

#include <utility>

#include "control/cut_state.hpp"
#include "files/csv.hpp"

namespace millforce::host {

namespace {

/// With the digits of the estimates' CSV.
std::string number_or_null(float value) {
    const std::string cell = CsvWriter::cell(value);
    return cell.empty() ? "null" : cell;
}

std::string estimate_members(const EstimateEntry& entry, const ToolForces& forces) {
    const firmware::TickRecord& tick = entry.tick;
    const hal::FeedOverride& out = tick.feed_override;
    const firmware::ShownForces shown = forces.of(tick, entry.tool);
    std::string text =
        fmt::format(R"("state":"{}","limit":"{}","fault":"{}","override":{},"hold":{})",
                    control::name(static_cast<control::CutState>(out.state)),
                    control::name(static_cast<control::Limit>(tick.limit)),
                    control::name(static_cast<control::Fault>(out.fault)), CsvWriter::cell(out.ratio), out.hold);
    for (const auto& [key, value] :
         {std::pair{"tangential_force_N", tick.tangential_force_N}, std::pair{"feed_force_N", tick.feed_force_N},
          std::pair{"radial_immersion", tick.radial_immersion},
          std::pair{"radial_immersion_sd", tick.radial_immersion_sd}, std::pair{"axial_depth_mm", tick.axial_depth_mm},
          std::pair{"axial_depth_sd_mm", tick.axial_depth_sd_mm}, std::pair{"peak_force_N", shown.peak_N},
          std::pair{"force_limit_N", shown.limit_N}, std::pair{"runout_um", tick.runout_um}}) {
        text += fmt::format(R"(,"{}":{})", key, number_or_null(value));
    }
    text += tick.has_side() ? fmt::format(R"(,"cut_side":"{}")", name(tick.side)) : R"(,"cut_side":null)";
    text += fmt::format(R"(,"law_misfit":{})", number_or_null(tick.law_misfit));
    text += forces.has_numbers() ? fmt::format(R"(,"tool":{})", entry.tool) : "";
    return text + fmt::format(R"(,"digest":"{:016x}")", entry.digest);
}

}  // namespace

std::string json_time(std::uint64_t time_us) {
    return fmt::format("{}.{:06}", time_us / 1'000'000, time_us % 1'000'000);
}

std::string json_line(const EstimateEntry& entry, const ToolForces& forces) {
    return fmt::format("{{\"type\":\"estimate\",\"time_s\":{},{}}}\n", json_time(entry.tick.time_us),
                       estimate_members(entry, forces));
}

}  // namespace millforce::host
