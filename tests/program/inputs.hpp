// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "program.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>

#include <string>

namespace millforce::test {

inline const std::string machine_text = R"(name = "test"
[spindle]
K_t1_Nm_per_A = 0.70
K_t2_Nm = -0.953
inertia_kg_m2 = 0.004
encoder_counts_per_rev = 8192
[x]
K_x2_positive_A_min_per_m = 0.625
K_x2_negative_A_min_per_m = 0.694
K_x3_A = 1.604
gravity_A = -0.104
K_x4_N_per_A = 120.0
mass_kg = 250.0
velocity_floor_mm_s = 2.0
)";

inline const std::string tool_head = R"([tool]
teeth = 4
diameter_mm = 10.0
flute_length_mm = 22.0
side = "down"
tooth_force_limit_N = 700.0
[control]
entry_feed_per_tooth_mm = 0.035
air_feed_per_tooth_mm = 0.035
max_feed_per_tooth_mm = 0.20
)";

inline const std::string tool_text = tool_head + R"([cutting]
k_s_N_per_mm2 = 1650.0
k_1 = 0.376
K_te_N_per_mm = 22.0
K_re_N_per_mm = 28.0
)";

/// A straight cut of 5 × 3 mm from `begin_mm` to `end_mm`, with air before it and a run-out of 3 mm.
inline std::string straight_cut(int spindle_speed_rpm, int feed_mm_min, int begin_mm, int end_mm) {
    return fmt::format(R"(machine = "machine.toml"
tool = "tool.toml"
seed = 5
[profile]
spindle_speed_rpm = {0}
feed_mm_min = {1}
length_mm = {4}
interpolation = "linear"
[[profile.point]]
path_mm = {2}
axial_depth_mm = 0
radial_width_mm = 3
[[profile.point]]
path_mm = {2}.01
axial_depth_mm = 5
radial_width_mm = 3
[[profile.point]]
path_mm = {3}
axial_depth_mm = 5
radial_width_mm = 3
[[profile.point]]
path_mm = {5}
axial_depth_mm = 0
radial_width_mm = 3
[material]
K_tc_N_mm2 = 1650
K_rc_N_mm2 = 620
K_te_N_mm = 22
K_re_N_mm = 28
)",
                       spindle_speed_rpm, feed_mm_min, begin_mm, end_mm, end_mm + 4, end_mm + 3);
}

inline const std::string scenario_text = straight_cut(4000, 1200, 8, 26);

/// Two drives of a [bus] to which the controller listens.
inline const std::string spindle_and_x_on_bus = R"([bus.spindle]
node_id = 1
tpdo1 = ["0x6064:32", "0x6078:16"]
[bus.x]
node_id = 2
tpdo1 = ["0x606C:32", "0x6078:16"]
velocity_mm_s_per_unit = 0.001
)";

/// A folder with machine.toml, tool.toml and scenario.toml.
class Inputs : public TemporaryFolder {
  public:
    Inputs() {
        write("machine.toml", machine_text);
        write("tool.toml", tool_text);
        write("scenario.toml", scenario_text);
    }

    std::string name(const char* file) const { return path(file).string(); }

    /// The recording log.csv replayed to out.csv.
    Ended replay(std::vector<std::string> more = {}) const {
        std::vector<std::string> words{"replay", name("log.csv"),   "--machine", name("machine.toml"),
                                       "--tool", name("tool.toml"), "-o",        name("out.csv")};
        words.insert(words.end(), more.begin(), more.end());
        return run_millforce(words);
    }
};

}  // namespace millforce::test
