// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "check/finding.hpp"
#include "firmware/parameters.hpp"

namespace millforce::host {

/// Values of the two files that no machine or tool has, and that a wrong unit explains: 1/min for rad/s, mm/min for
/// mm/s, mA for A, g for kg, µm for mm.
Findings check_units_of_files(const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
