// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "import/import_map.hpp"
#include "import/recording_statistics.hpp"

namespace millforce::host {

/// What cannot be right in an imported column, each as one line with the likely mistake: an axis above 2 m/s, a current
/// above 500 A, a force above 100 kN, an override above 3, a spindle that turns backwards, begins again, stands still
/// or exceeds 100 000 rpm, a column without any value. `duration_s`: of the recording.
[[nodiscard]] std::vector<std::string> doubts_about(const ColumnMap& column, const ColumnStatistics& statistics,
                                                    double duration_s);

/// The same of the times: below 20 Hz or above 1 MHz.
[[nodiscard]] std::vector<std::string> doubts_about_times(const StepStatistics& steps);

}  // namespace millforce::host
