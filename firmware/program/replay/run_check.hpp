// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <fstream>
#include <string>

#include "run_log/estimate_entry.hpp"
#include "run_log/tool_forces.hpp"

namespace millforce::host {

/// Compares a replay with the log that the run itself wrote (`millforce run --log`): each of its estimates, to the last
/// digit, and by its digest every tick between them.
class RunCheck {
  public:
    /// Throws InputError if there is no such file, or no estimate in it.
    RunCheck(const std::string& file, const ToolForces& forces);

    void add(const EstimateEntry& entry);
    /// After the replay. True where every estimate of the run's log came again.
    [[nodiscard]] bool is_same() const { return matched_ > 0 && !differs_ && expected_.empty(); }
    [[nodiscard]] std::string summary() const;

  private:
    void next_expected();

    std::string file_;
    ToolForces forces_;
    std::ifstream in_;
    std::string expected_;  ///< empty: all came again
    std::string got_;
    std::size_t matched_ = 0;
    bool differs_ = false;
};

}  // namespace millforce::host
