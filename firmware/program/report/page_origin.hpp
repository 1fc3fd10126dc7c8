// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

/// Where a page comes from.

namespace millforce::host {

/// Names and values, as text.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// Version of the program and of the operating system, and the command as it was typed.
[[nodiscard]] Facts facts_of_this_process();

/// Now, by this computer's clock and in its time zone.
[[nodiscard]] std::string date_and_time();

}  // namespace millforce::host
