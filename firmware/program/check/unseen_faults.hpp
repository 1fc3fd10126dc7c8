// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "firmware/parameters.hpp"

namespace millforce::host {

/// Faults that no other signal of a machine with these parameters contradicts, and what bounds the feed all the same:
/// one sentence each, to be shown once `run` or `serve` is ready. tests/README.md has what they led to in simulated
/// parts.
[[nodiscard]] std::vector<std::string> unseen_faults(const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
