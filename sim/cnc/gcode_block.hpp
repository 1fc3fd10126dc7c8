// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "cnc/gcode_words.hpp"

/// A block of a part program with its words in their places: which code of each modal group, which number of each
/// address.

namespace millforce::sim::gcode {

/// Codes of one group exclude each other within a block.
enum ModalGroup : std::size_t {
    motion,
    dwell,
    plane,
    units,
    distance,
    cutter_compensation,
    tool_length,
    coordinate_system,
    canned_cycle,
    return_level,
    arc_centre,
    retreat,
    feed_mode,
    spindle,
    stopping,
    path_mode,
    adaptive_feed,
    tool_change,
    coolant,
    pause,
    group_count,
};

/// The words of a block, sorted by what they are; each points into the block.
struct SortedBlock {
    std::array<const GcodeWord*, group_count> codes{};
    std::array<const GcodeWord*, 26> addresses{};

    const GcodeWord* code(ModalGroup group) const { return codes[group]; }
    const GcodeWord* address(char letter) const { return addresses[static_cast<std::size_t>(letter - 'A')]; }
    const GcodeWord* first_of(std::string_view letters) const {
        const GcodeWord* first = nullptr;
        for (const char letter : letters) {
            const GcodeWord* word = address(letter);
            if (word != nullptr && (first == nullptr || word->column < first->column)) {
                first = word;
            }
        }
        return first;
    }
};

/// A G code in tenths: 17 is 170. Codes carry at most one decimal, and rounding keeps G20 and G20.0 the same.
[[nodiscard]] long tenths(const GcodeWord& word);

/// The words point into `block`. Throws InputError for a word or code that is not known or has no place here, and for
/// two codes of one group.
[[nodiscard]] SortedBlock sort_words(const GcodeBlock& block, std::string_view file_name);

}  // namespace millforce::sim::gcode
