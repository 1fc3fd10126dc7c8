// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

/// A short commissioning of the simulated machine, for tests: answers, and a scenario for each of the programs that the
/// session writes.

namespace millforce::test {

/// What a user knows whatever the machine is connected by: the screw, the tool, the standard cut.
inline std::string commissioning_answers() {
    return fmt::format(R"(machine.axes = "x"
cnc.acceleration_mm_s2 = 2000
x.travel_per_motor_turn_mm = 5
x.mass_kg = 250
idle.highest_rpm = 4800
idle.lowest_rpm = 1200
idle.speeds = 3
idle.dwell_s = 1.0
air.lowest_feed_mm_min = 1000
air.feeds = 4
air.travel_mm = 20
tool.teeth = 4
tool.diameter_mm = 8
tool.flute_length_mm = 19
tool.overhang_mm = 30
tool.tooth_force_limit_N = 600
control.max_feed_per_tooth_mm = 0.12
control.monitor_only = false
standard_cut.database = "{}/sim/scenarios/tools/coefficients.toml"
standard_cut.entry = "SM45C_carbide"
standard_cut.spindle_rpm = 4800
standard_cut.feed_mm_min = 1600
standard_cut.axial_depth_mm = 8
standard_cut.radial_width_mm = 0.8
)",
                       MILLFORCE_SOURCE_DIR);
}

/// The block, with the origin of the programs at its corner, and where the tool begins.
struct CommissioningBlock {
    double min_x_mm, max_x_mm, min_y_mm, max_y_mm;
    double start_x_mm, start_y_mm;
    double top_mm = 0.0;
};
inline CommissioningBlock block_along_x(double start_x_mm) {
    return {0.0, 18.0, -10.0, 0.0, start_x_mm, 8.0};
}
inline CommissioningBlock block_along_y(double start_y_mm) {
    return {0.0, 10.0, 0.0, 18.0, -8.0, start_y_mm};
}
/// Far below the tool, which may move in all axes.
inline CommissioningBlock block_below() {
    return {0.0, 1.0, 0.0, 1.0, 0.0, 0.0, -100.0};
}

/// `hardness`: of the steel, over that of the database.
inline std::string commissioning_scenario(const std::string& machine, const std::string& program, int seed,
                                          const CommissioningBlock& block, double hardness = 1.0) {
    return fmt::format(R"(machine = "{}"
tool = "{}/sim/scenarios/commissioning/endmill_8mm.toml"
program = "{}"
seed = {}
[stock]
min_x_mm = {}
max_x_mm = {}
min_y_mm = {}
max_y_mm = {}
top_mm = {}
cell_mm = 0.1
start_x_mm = {}
start_y_mm = {}
start_z_mm = 5
[material]
name = "SM45C, carbide end mill"
K_tc_N_mm2 = {}
K_rc_N_mm2 = {}
size_effect_exponent = -0.2557
size_effect_radial_exponent = -0.4103
chip_model = "circular"
)",
                       machine, MILLFORCE_SOURCE_DIR, program, seed, block.min_x_mm, block.max_x_mm, block.min_y_mm,
                       block.max_y_mm, block.top_mm, block.start_x_mm, block.start_y_mm, 1047.4 * hardness,
                       257.4 * hardness);
}

/// A value of a TOML file by its table and key, as it stands there.
inline double toml_value(const std::string& text, const std::string& table, const std::string& key) {
    const std::size_t begin = text.find("\n[" + table + "]\n");
    const std::size_t at = begin == std::string::npos ? begin : text.find("\n" + key + " = ", begin + 1);
    return at == std::string::npos ? -1e9 : std::stod(text.substr(at + key.size() + 4));
}

}  // namespace millforce::test
