// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace millforce::host {

/// One line for the user, on a stream that may be full, closed or gone: what cannot be written is dropped. Never
/// throws. (fmt::print throws where a write fails, and ends a thread that catches nothing.)
void print_line(std::FILE* stream, std::string_view line) noexcept;

/// Writes out what standard output still holds. False where it, or something before it, could not be written.
[[nodiscard]] bool flush_standard_output() noexcept;

}  // namespace millforce::host
