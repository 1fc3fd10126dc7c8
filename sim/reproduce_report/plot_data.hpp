// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "report/json_writer.hpp"
#include "reproduce/reproduction.hpp"

namespace millforce::sim {

/// Points of one series that a page holds at most.
inline constexpr std::size_t plot_point_count = 600;

/// The series with at most `plot_point_count` points and no peak lost: it is cut into equal groups of consecutive
/// points, and of each the smallest and the largest value are kept, in their order; of a band's lower bound the
/// smallest alone, of its upper bound the largest. A value that is not finite is a gap, and kept as one.
[[nodiscard]] Plot::Series decimated(const Plot::Series& series);

/// What the page draws of a plot: axes' labels, and per series name, style, x and y; null is a gap.
void write_plot(host::JsonWriter& json, const Plot& plot);

}  // namespace millforce::sim
