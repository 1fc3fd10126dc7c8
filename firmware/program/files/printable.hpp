// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Text that came from a file, for a message: a terminal must not obey it, and it must not fill the screen.

namespace millforce::host {

/// Control characters appear as '?', those of UTF-8 (U+0080 to U+009F), too.
[[nodiscard]] std::string without_controls(std::string_view text);

/// The same, and at most 60 bytes.
[[nodiscard]] std::string printable(std::string_view text);

/// "a, b, c, …": at most 12 names, each printable.
[[nodiscard]] std::string name_list(const std::vector<std::string>& names);

}  // namespace millforce::host
