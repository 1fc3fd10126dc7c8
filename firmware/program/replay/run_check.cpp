// SPDX-License-Identifier: Apache-2.0
#include "replay/run_check.hpp"

#include <fmt/format.h>

#include "files/input_error.hpp"
#include "files/text_lines.hpp"
#include "run_log/estimate_line.hpp"

namespace millforce::host {

RunCheck::RunCheck(const std::string& file, const ToolForces& forces)
    : file_(file), forces_(forces), in_(open_to_read(file)) {
    next_expected();
    if (expected_.empty()) {
        throw InputError(fmt::format("{}: no estimates, expected a log of 'millforce run --log'", file));
    }
}

void RunCheck::next_expected() {
    expected_.clear();
    for (std::string line; std::getline(in_, line);) {
        if (line.starts_with(R"({"type":"estimate")")) {
            expected_ = line + '\n';
            return;
        }
    }
}

void RunCheck::add(const EstimateEntry& entry) {
    if (differs_ || expected_.empty()) {
        return;  // what came after the run's end
    }
    got_ = json_line(entry, forces_);
    differs_ = got_ != expected_;
    if (!differs_) {
        ++matched_;
        next_expected();
    }
}

std::string RunCheck::summary() const {
    if (is_same()) {
        return fmt::format("{}: all {} estimates are the run's, bit for bit, and every tick between them\n", file_,
                           matched_);
    }
    if (differs_) {
        return fmt::format("{}: after {} equal estimates the replay differs\n  run:    {}  replay: {}", file_, matched_,
                           expected_, got_);
    }
    return fmt::format("{}: after {} equal estimates the replay ends, and the run does not\n", file_, matched_);
}

}  // namespace millforce::host
