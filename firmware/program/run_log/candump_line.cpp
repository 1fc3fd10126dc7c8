// SPDX-License-Identifier: Apache-2.0
#include "run_log/candump_line.hpp"

#include <fmt/format.h>

#include <iterator>

namespace millforce::host {

std::string candump_line(const hal::CanFrame& frame, std::uint64_t unix_us, std::string_view interface) {
    std::string line = fmt::format("({:010}.{:06}) {} ", unix_us / 1'000'000, unix_us % 1'000'000, interface);
    const auto end = std::back_inserter(line);
    fmt::format_to(end, "{:0{}X}#", frame.id, frame.extended ? 8 : 3);
    if (frame.remote) {
        line += frame.length > 0 ? fmt::format("R{}", frame.length) : "R";
    } else {
        for (std::size_t k = 0; k < frame.length && k < frame.data.size(); ++k) {
            fmt::format_to(end, "{:02X}", frame.data[k]);
        }
    }
    line += '\n';
    return line;
}

}  // namespace millforce::host
