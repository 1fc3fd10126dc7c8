// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::sim {

/// One word of a part program: an address letter and its number.
struct GcodeWord {
    char letter = ' ';  ///< Upper case.
    double value = 0.0;
    std::size_t column = 0;  ///< 1-based byte of the line.
    std::string text;        ///< As written, for messages.
};

/// One line of a part program without its comments.
struct GcodeBlock {
    std::size_t line = 0;  ///< 1-based.
    std::vector<GcodeWord> words;
    bool is_percent = false;  ///< A % alone: the begin or end of the program.
};

/// Where a message points: file, line and column (1-based).
struct GcodePlace {
    std::string_view file_name;
    std::size_t line = 0;
    std::size_t column = 0;
};

/// Throws InputError "file:line:column: found '…', expected …". Bytes outside printable ASCII appear as \xNN.
[[noreturn]] void reject(const GcodePlace& place, std::string_view found, std::string_view expected);

/// Splits one line into words. Comments ( … ) and ; … are skipped, as are blanks; a line that begins with / (block
/// delete) is empty. Numbers are decimal, without exponent, at most 32 characters long.
/// Throws InputError for an unclosed or nested comment, a letter without a number, and any other character.
GcodeBlock split_block(std::string_view text, std::string_view file_name, std::size_t line);

}  // namespace millforce::sim
