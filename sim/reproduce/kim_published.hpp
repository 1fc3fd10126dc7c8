// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cutting/cutting_coefficients.hpp"

#include <array>

/// What Kim & Chung print of their machine and tools. The unit of current is not printed.

namespace millforce::sim {

/// Coefficients by forces (Tables 2 and 4) and pressure by motor currents (Table 5).
struct KimPublishedTool {
    const char* name;
    const char* table;
    AverageChipLaw law;
    double k_s_by_currents;
    double p_s_by_currents;
};

inline constexpr std::array<KimPublishedTool, 2> kim_tools{{
    {"carbide", "Table 2", {1007.59, -0.2557, 0.2242, -0.1546}, 1052.96, -0.2403},
    {"HSS", "Table 4", {831.16, -0.2749, 0.1526, -0.2227}, 703.26, -0.3176},
}};

/// Eq. 8 and Table 3.
struct KimPublishedDrives {
    static constexpr double K_t1 = 196.61;
    static constexpr double K_t2_N = -1911.0;
    static constexpr double K_x1 = 3.5788;
    static constexpr double K_x2 = -7.2469;
    static constexpr double K_x3 = 19.7252;
    static constexpr double K_x4 = 196.61;
    static constexpr double K_x5 = -1911.0;

    /// Eq. 9; w in m/min.
    static constexpr double friction_current(double w) { return (K_x1 * w + K_x2) * w + K_x3; }
};

}  // namespace millforce::sim
