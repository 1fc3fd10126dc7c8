// SPDX-License-Identifier: Apache-2.0
#include "cnc/gcode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <istream>

#include "cnc/gcode_interpreter.hpp"
#include "cnc/gcode_words.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr std::size_t largest_text_bytes = std::size_t{256} << 20U;

}  // namespace

GcodeProgram read_gcode(std::string_view text, std::string_view file_name, const GcodeSettings& settings) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) {
        text.remove_prefix(byte_order_mark.size());
    }
    gcode::Interpreter interpreter(file_name, settings);
    std::size_t line = 1;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        interpreter.run(split_block(text.substr(begin, end - begin), file_name, line));
        if (interpreter.ended()) {
            return {interpreter.take_moves(), interpreter.take_notes()};
        }
        begin = end + 1;
    }
    if (interpreter.may_end_here()) {
        interpreter.note_end();
        return {interpreter.take_moves(), interpreter.take_notes()};
    }
    reject({file_name, line, 1}, "", "the closing % of the program");
}

GcodeProgram read_gcode(std::istream& stream, std::string_view file_name, const GcodeSettings& settings) {
    std::string text;
    std::array<char, 65536> chunk{};
    while (stream.read(chunk.data(), chunk.size()) || stream.gcount() > 0) {
        text.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > largest_text_bytes) {
            throw host::InputError(
                fmt::format("{}: found more than {} bytes, expected a part program of at most 256 MiB", file_name,
                            largest_text_bytes));
        }
    }
    if (stream.bad()) {
        throw host::InputError(fmt::format("{}: found a read error, expected a readable part program", file_name));
    }
    return read_gcode(text, file_name, settings);
}

std::vector<Move> parse_gcode(std::string_view text, std::string_view file_name, const GcodeSettings& settings) {
    return read_gcode(text, file_name, settings).moves;
}

}  // namespace millforce::sim
