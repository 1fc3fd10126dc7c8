// SPDX-License-Identifier: Apache-2.0
#include "part_map/path_position.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::host {

namespace {

/// A path that is blended round corners is shorter than the programmed one.
constexpr double slack_mm = 1.0;
/// So long line and distance to go may belong to different blocks while a CNC blends from one into the next.
constexpr int samples_of_change = 50;

}  // namespace

PathPosition::PathPosition(const PartMap& map) {
    for (const MapPlace& place : map) {
        const bool is_new =
            blocks_.empty() || blocks_.back().line != place.line || blocks_.back().end_mm != place.block_end_mm;
        if (is_new) {
            blocks_.push_back({place.line, place.path_mm, place.block_end_mm});
        }
    }
}

std::optional<double> PathPosition::find(std::uint32_t line, double distance_to_go_mm) {
    const std::optional<double> reported = reported_by(line, distance_to_go_mm);
    const bool goes_on = reported && std::abs(*reported - last_mm_) <= slack_mm;
    jumps_ = goes_on ? 0 : std::min(jumps_ + 1, samples_of_change);
    if (jumps_ > 0 && jumps_ < samples_of_change && has_position_) {
        return last_mm_;
    }
    has_position_ = reported.has_value();
    last_mm_ = reported.value_or(last_mm_);
    return reported;
}

std::optional<double> PathPosition::reported_by(std::uint32_t line, double distance_to_go_mm) const {
    if (line == 0 || !std::isfinite(distance_to_go_mm) || distance_to_go_mm < 0.0) {
        return std::nullopt;
    }
    const std::optional<double> ahead = first_from(last_mm_ - slack_mm, line, distance_to_go_mm);
    return ahead ? ahead : first_from(0.0, line, distance_to_go_mm);
}

std::optional<double> PathPosition::first_from(double lowest_mm, std::uint32_t line, double distance_to_go_mm) const {
    auto block = std::ranges::lower_bound(blocks_, lowest_mm, {}, &Block::end_mm);
    for (; block != blocks_.end(); ++block) {
        const double path_mm = block->end_mm - distance_to_go_mm;
        const bool is_in_block = path_mm >= block->begin_mm - slack_mm;
        const bool goes_on = std::abs(path_mm - last_mm_) <= slack_mm;
        if (block->line == line && path_mm >= lowest_mm && (is_in_block || goes_on)) {
            return goes_on ? path_mm : std::max(path_mm, block->begin_mm);
        }
    }
    return std::nullopt;
}

}  // namespace millforce::host
