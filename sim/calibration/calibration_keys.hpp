#pragma once

#include <array>
#include <string_view>

/// Keys of the TOML files that `millforce calibrate` writes. Each fitted key has a companion KEY_se, its standard
/// error.

namespace millforce::sim {

/// A key, and its unit for the printed table.
struct CalibrationKey {
    std::string_view name;
    std::string_view unit;
};

/// Table [x], [y] or [z], from position and motor force; order of estimation::SymmetricFrictionIndex …
inline constexpr std::array<CalibrationKey, 4> symmetric_friction_keys{{
    {"mass_kg", "kg"},
    {"viscous_N_s_per_m", "N·s/m"},
    {"coulomb_N", "N"},
    {"offset_N", "N"},
}};

/// … and of estimation::DirectionalFrictionIndex. The mass is the one above.
inline constexpr std::array<CalibrationKey, 5> directional_friction_keys{{
    {"directional_mass_kg", "kg"},
    {"positive_viscous_N_s_per_m", "N·s/m"},
    {"negative_viscous_N_s_per_m", "N·s/m"},
    {"positive_coulomb_N", "N"},
    {"negative_coulomb_N", "N"},
}};

/// Table [x], [y] or [z], from recorded currents in air; order of estimation::FeedCurrentIndex. K_x3 is one for both
/// directions: see estimation/friction_fit.hpp.
inline constexpr std::array<CalibrationKey, 6> feed_current_keys{{
    {"friction_positive_K_x1_A_min2_per_m2", "A·min²/m²"},
    {"friction_positive_K_x2_A_min_per_m", "A·min/m"},
    {"friction_negative_K_x1_A_min2_per_m2", "A·min²/m²"},
    {"friction_negative_K_x2_A_min_per_m", "A·min/m"},
    {"friction_K_x3_A", "A"},
    {"gravity_A", "A"},
}};

/// Table [spindle]; order of estimation::SpindleFitIndex.
inline constexpr std::array<CalibrationKey, 5> spindle_keys{{
    {"K_t1_Nm_per_A", "N·m/A"},
    {"K_t2_Nm", "N·m"},
    {"idle_torque_slope_Nm_s", "N·m·s"},
    {"inertia_kg_m2", "kg·m²"},
    {"base_speed_rad_s", "rad/s"},
}};

/// Table [cutting]: the law's coefficients.
inline constexpr std::array<CalibrationKey, 6> cutting_coefficient_keys{{
    {"k_s_N_per_mm2", "N/mm²"},
    {"p_s", ""},
    {"k_1", ""},
    {"p_1", ""},
    {"K_te_N_per_mm", "N/mm"},
    {"K_re_N_per_mm", "N/mm"},
}};

/// Table [cutting]: what the law's doubt and range are made of. No KEY_se.
inline constexpr std::array<CalibrationKey, 9> cutting_doubt_keys{{
    {"K_s_relative_sd", ""},
    {"K_s_exponent_sd", ""},
    {"r_1_relative_sd", ""},
    {"r_1_exponent_sd", ""},
    {"reference_chip_thickness_mm", "mm"},
    {"minimum_chip_thickness_mm", "mm"},
    {"maximum_chip_thickness_mm", "mm"},
    {"minimum_feed_per_tooth_mm", "mm"},
    {"maximum_feed_per_tooth_mm", "mm"},
}};

/// Table [cutting]: "down" or "up".
inline constexpr std::string_view cut_side_key = "cut_side";

}  // namespace millforce::sim
