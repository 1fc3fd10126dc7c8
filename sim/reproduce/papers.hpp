// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// A paper whose system is reproduced here. Seconds: about what it takes on one core, for the order of work.
struct Paper {
    std::string_view name;
    Reproduction (*reproduce)();
    double typical_s;
};

/// All of them, in the order in which they are printed. A new one needs its line in papers.cpp and nothing else.
[[nodiscard]] std::span<const Paper> papers();

/// Runs the papers, as many at once as there are cores, the longest first; the results are in the order of `chosen`.
/// `watch` is called from time to time, from this thread, with the names of those that run. An exception of a paper is
/// thrown here.
[[nodiscard]] std::vector<Reproduction> reproduce(
    std::span<const Paper> chosen, const std::function<void(const std::vector<std::string_view>& running)>& watch);

}  // namespace millforce::sim
