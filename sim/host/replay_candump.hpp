#pragma once

#include <string>

namespace millforce::sim {

struct ReplayCandumpOptions {
    std::string log;
    std::string machine;
    std::string tool;
    std::string output;
    std::string interface;  ///< empty: the only one of the log
    double interval_s = 0.02;
};

/// Whether the file's first line that is no comment begins as those of candump do. Throws InputError: no such file.
bool is_candump_log(const std::string& file);

int replay_candump(const ReplayCandumpOptions& options);

}  // namespace millforce::sim
