// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace millforce::host {

/// The candidate that is `name` with more words behind it, e.g. its unit (top → top_mm); else the one that differs from
/// `name` by the fewest insertions, deletions and replacements of a character; empty where even the nearest shares less
/// than half of its characters.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace millforce::host
