// SPDX-License-Identifier: Apache-2.0
#include "commands/scenario_info.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cutting/angle_units.hpp"
#include "loop/simulation.hpp"

namespace millforce::sim {

ScenarioInfo info_of(const Scenario& scenario, const ConstantFeeds& feeds) {
    ScenarioInfo info;
    info.name = scenario.name;
    info.title = scenario.title;
    info.description = scenario.description;
    info.tool = fmt::format("{} teeth, Ø{:g} mm, helix {:g}°", scenario.cutter.teeth, scenario.cutter.diameter_mm,
                            scenario.cutter.helix_rad / degree);
    info.material = scenario.material;
    info.seed = scenario.seed;
    info.tooth_force_limit_N = static_cast<double>(scenario.parameters.tool.tooth_force_limit_N);
    info.cutter_diameter_mm = scenario.cutter.diameter_mm;
    for (const Move& move : moves_of(scenario)) {
        const double feed_mm_s = move.kind == MoveKind::rapid ? 0.0 : move.feed_mm_s;
        info.spindle_speed_rad_s = std::max(info.spindle_speed_rad_s, move.spindle_speed_rad_s);
        info.constant_feed_mm_s = std::max(info.constant_feed_mm_s, feed_mm_s * feeds.safe_ratio);
        info.hindsight_feed_mm_s = std::max(info.hindsight_feed_mm_s, feed_mm_s * feeds.hindsight_ratio);
    }
    info.origin = {{"Machine", scenario.machine_file}, {"Tool", scenario.tool_file}};
    const host::Facts process = host::facts_of_this_process();
    info.origin.insert(info.origin.end(), process.begin(), process.end());
    info.origin.emplace_back("Date", host::date_and_time());
    info.hardest_material = feeds.hardest;
    info.has_top_view = scenario.has_program();
    info.stock_min_x_mm = scenario.stock.block.min_x_mm;
    info.stock_min_y_mm = scenario.stock.block.min_y_mm;
    info.stock_max_x_mm = scenario.stock.block.max_x_mm;
    info.stock_max_y_mm = scenario.stock.block.max_y_mm;
    return info;
}

}  // namespace millforce::sim
