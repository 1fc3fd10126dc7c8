// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace millforce::sim {

/// What the parts have in common: six kinds, each with four parts.
enum class PartKind : std::uint8_t { pocket, slot, rib, face, depth, round };

/// Half of the parts is for choosing the settings of the rivals (and for whoever improves the control law); the other
/// half only judges. The split is fixed.
enum class PartUse : std::uint8_t { training, judging };

/// A part in a few numbers; part_program.hpp makes its blank and its G-code out of them. Its shape is the name of a
/// function there.
struct BenchPart {
    std::string_view name;
    PartKind kind;
    std::string_view shape;
    PartUse use;
    double tool_diameter_mm;
    int teeth;
    double spindle_rpm;
    double depth_mm;    ///< deepest axial depth of cut
    double width_mm;    ///< radial width of cut, or the step from one path to the next
    double length_mm;   ///< of the part along x
    double breadth_mm;  ///< of the part along y
    std::string_view meaning;
};

[[nodiscard]] std::span<const BenchPart> bench_parts();

[[nodiscard]] std::string_view name_of(PartKind kind);
[[nodiscard]] std::string_view name_of(PartUse use);

/// What a programmer writes as F: 0.9 % of the diameter per tooth. The override may double it.
[[nodiscard]] double programmed_feed_mm_min(const BenchPart& part);

}  // namespace millforce::sim
