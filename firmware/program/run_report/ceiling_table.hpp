// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "control/cut_state.hpp"

namespace millforce::host {

/// For how long each ceiling held the feed.
struct CeilingTimes {
    std::array<double, control::limit_count> held_s{};
    std::array<double, control::limit_count> held_in_cut_s{};  ///< in the states entry and in_cut
    double all_s = 0.0;
    double cut_s = 0.0;

    void add(double step_s, control::Limit limit, control::CutState state);
    /// Those that held, by their time in the cut and then by all their time.
    [[nodiscard]] std::vector<control::Limit> longest_first() const;
    [[nodiscard]] double of(control::Limit limit) const { return held_s[static_cast<std::size_t>(limit)]; }
    [[nodiscard]] double in_cut(control::Limit limit) const { return held_in_cut_s[static_cast<std::size_t>(limit)]; }
};

/// 0 where there is no whole.
[[nodiscard]] constexpr double share_of(double part, double whole) {
    return whole > 0.0 ? part / whole : 0.0;
}

/// The ceilings by their keys, with time, share and meaning.
[[nodiscard]] std::string ceilings_html(const CeilingTimes& times);

}  // namespace millforce::host
