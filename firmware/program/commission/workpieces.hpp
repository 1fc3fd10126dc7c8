// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace millforce::host {

/// Specific cutting force of a group of workpiece materials, k_c = k_c1.1 h^(-m_c): what the law K_s = k_s t_a^p_s
/// begins with where nothing was measured yet.
///
/// Source: ISCAR, "Material groups", based on ISO 513 and VDI 3323, in its catalogues of 2017 and 2022 (the titanium
/// alloys: 2022). They are for a rake angle of 0° and scatter with batch, rake and wear: K_s is then known to 25 %.
struct Workpiece {
    const char* name;
    const char* meaning;
    double k_s_N_per_mm2;
    double p_s;
};

std::span<const Workpiece> workpieces();
std::vector<std::string> workpiece_names();
/// `name` is one of workpiece_names().
const Workpiece& workpiece_of(const std::string& name);

inline constexpr double table_K_s_relative_sd = 0.25;

/// r_1 = F_r/F_t = k_1 t_a^p_1. No maker's table has it; this is Kim & Chung's for carbide in SM45C (Table 2), taken
/// for all materials, and known to 30 % then.
inline constexpr double table_k_1 = 0.2242;
inline constexpr double table_p_1 = -0.1546;
inline constexpr double table_r_1_relative_sd = 0.3;

}  // namespace millforce::host
