// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "firmware/way_source.hpp"
#include "parameters/tool_set.hpp"
#include "replay/playback.hpp"
#include "run_log/bus_clock.hpp"

namespace millforce::host {

struct ReplayCandumpOptions {
    std::string log;
    std::string machine;
    ToolChoice tools;
    std::string output;
    std::string interface;  ///< empty: the only one of the log
    double interval_s = 0.02;
    std::string run_log;  ///< file of `millforce run --log`, to compare with; empty: none
    std::string mcap;     ///< file to write, too; empty: none
    BusPace pace{};
    std::string report{};                       ///< folder for the page; empty: none
    firmware::WaySource<float>* way = nullptr;  ///< what lies ahead of one tool; outlives the replay
    bool may_print = true;                      ///< rows without a file to standard output
};

/// Whether the file's first line that is no comment begins as those of candump do. Throws InputError: no such file.
bool is_candump_log(const std::string& file);

/// 1 where the run's log has other estimates. `tools`: read from the files of the options. `begin_playback`: called
/// once the log can be replayed.
int replay_candump(const ReplayCandumpOptions& options, const ToolSet& tools,
                   const std::function<Playback()>& begin_playback);

}  // namespace millforce::host
