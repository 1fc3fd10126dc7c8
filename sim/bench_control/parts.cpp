// SPDX-License-Identifier: Apache-2.0
#include "bench_control/parts.hpp"

#include <array>

namespace millforce::sim {

namespace {

using enum PartKind;
using enum PartUse;

// name, kind, shape, use, Ø, teeth, rpm, depth, width, length, breadth, meaning
constexpr std::array all_parts{
    BenchPart{"pocket_10", pocket, "spiral", training, 10, 4, 4000, 5, 3, 34, 26, "rectangular spiral, corners"},
    BenchPart{"pocket_20", pocket, "spiral", training, 20, 4, 2000, 4, 6, 60, 48, "the same with a big cutter"},
    BenchPart{"pocket_6", pocket, "spiral", judging, 6, 3, 10000, 4, 1.5, 26, 20, "a small cutter, fast"},
    BenchPart{"pocket_12", pocket, "long_way", judging, 12, 4, 3300, 5, 4, 46, 28, "a narrow pocket, back and forth"},

    BenchPart{"slot_10", slot, "plain", training, 10, 4, 4000, 5, 10, 90, 10, "slot entered head-on"},
    BenchPart{"slot_16_shoulder", slot, "shoulder", training, 16, 4, 2500, 6, 16, 120, 16, "half of it beside air"},
    BenchPart{"slot_8_turn", slot, "turn", judging, 8, 4, 5000, 4, 8, 60, 40, "slot that turns by a right angle"},
    BenchPart{"slot_12_step", slot, "step", judging, 12, 4, 3300, 6, 12, 110, 12, "slot whose depth doubles half-way"},

    BenchPart{"ribs_10", rib, "equal", training, 10, 4, 4000, 6, 3, 150, 10, "ribs and gaps of the same width"},
    BenchPart{"ribs_6", rib, "equal", training, 6, 3, 6600, 5, 1.5, 120, 8, "the same with a small cutter"},
    BenchPart{"ribs_12_growing", rib, "growing", judging, 12, 4, 3300, 8, 3, 180, 14, "each rib wider than the last"},
    BenchPart{"ribs_16_passes", rib, "passes", judging, 16, 4, 2500, 8, 3, 140, 20, "three passes, each wider"},

    BenchPart{"face_20", face, "zigzag", training, 20, 4, 1200, 2.5, 14, 80, 42, "both directions, slow spindle"},
    BenchPart{"face_10", face, "zigzag", training, 10, 4, 4000, 4, 6, 60, 30, "both directions"},
    BenchPart{"face_16_holes", face, "holes", judging, 16, 5, 2500, 3, 11, 90, 44, "both directions over two holes"},
    BenchPart{"face_12_one_way", face, "one_way", judging, 12, 4, 3300, 3, 7, 70, 35, "one direction, back in air"},

    BenchPart{"ramp_10", depth, "ramp", training, 10, 4, 4000, 9, 3, 200, 12, "depth that grows and falls steadily"},
    BenchPart{"stairs_8", depth, "stairs", training, 8, 4, 5000, 6, 2.5, 160, 10, "three steps up in depth"},
    BenchPart{"ramp_16", depth, "ramp", judging, 16, 4, 2500, 14, 4, 220, 20, "the same ramp, deep"},
    BenchPart{"stairs_12_doubling", depth, "doubling", judging, 12, 4, 3300, 8, 3.5, 200, 14, "depths 1, 2, 4, 8, 4"},

    BenchPart{"round_pocket_10", round, "outwards", training, 10, 4, 4000, 5, 2.5, 40, 40, "circles outwards"},
    BenchPart{"trochoid_8", round, "trochoid", training, 8, 4, 5000, 8, 1.2, 30, 14, "a slot in small circles"},
    BenchPart{"boss_12", round, "boss", judging, 12, 4, 3300, 6, 4, 48, 48, "a square block turned into a round boss"},
    BenchPart{"island_6", round, "island", judging, 6, 3, 6600, 4, 2, 34, 34, "a pocket around a round island"},
};

}  // namespace

std::span<const BenchPart> bench_parts() {
    return all_parts;
}

std::string_view name_of(PartKind kind) {
    constexpr std::string_view names[] = {"pocket", "slot", "rib", "face", "depth", "round"};
    return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(PartUse use) {
    return use == PartUse::training ? "training" : "judging";
}

double programmed_feed_mm_min(const BenchPart& part) {
    return 0.009 * part.tool_diameter_mm * part.teeth * part.spindle_rpm;
}

}  // namespace millforce::sim
