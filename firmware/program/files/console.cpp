// SPDX-License-Identifier: Apache-2.0
#include "files/console.hpp"

#include <iostream>

namespace millforce::host {

void print_line(std::FILE* stream, std::string_view line) noexcept {
    std::fwrite(line.data(), 1, line.size(), stream);
    std::fputc('\n', stream);
    std::fflush(stream);
}

bool flush_standard_output() noexcept {
    std::cout.flush();
    const bool is_flushed = std::fflush(stdout) == 0;
    return is_flushed && std::cout.good() && std::ferror(stdout) == 0;
}

}  // namespace millforce::host
