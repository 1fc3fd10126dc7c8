// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "cnc/gcode.hpp"
#include "files/input_error.hpp"

namespace millforce::sim {

/// The moves of a program that starts at the origin.
inline std::vector<Move> parse(std::string_view text) {
    return parse_gcode(text, "part.ngc", {.start_mm = Eigen::Vector3d::Zero()});
}

/// With spindle and feed running before it and M2 behind.
inline std::string with_frame(std::string_view body) {
    return fmt::format("M3 S600 F600\n{}\nM2\n", body);
}

inline std::vector<Move> parse_body(std::string_view body) {
    return parse(with_frame(body));
}

inline std::string refusal_of(std::string_view text) {
    try {
        parse(text);
    } catch (const host::InputError& error) {
        return error.what();
    }
    return "";
}

inline std::string refusal_of_body(std::string_view body) {
    return refusal_of(with_frame(body));
}

}  // namespace millforce::sim
