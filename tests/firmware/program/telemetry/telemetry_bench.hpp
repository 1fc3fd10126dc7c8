// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parameters/tool_set.hpp"
#include "temporary_folder.hpp"

namespace millforce::test {

/// An end mill whose tooth may carry 700 N.
inline host::ToolSet one_tool() {
    const TemporaryFolder folder;
    folder.write("tool.toml",
                 "[tool]\nteeth = 4\ndiameter_mm = 10\nflute_length_mm = 22\ntooth_force_limit_N = 700\n[control]\n"
                 "entry_feed_per_tooth_mm = 0.03\nair_feed_per_tooth_mm = 0.03\nmax_feed_per_tooth_mm = 0.2\n"
                 "[cutting]\nk_s_N_per_mm2 = 1650\nk_1 = 0.376\n");
    return {{}, {folder.path("tool.toml").string(), {}}};
}

}  // namespace millforce::test
