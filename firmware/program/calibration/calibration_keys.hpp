// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

/// Keys of the TOML files that `millforce calibrate` writes. They are looked up in the parameter tables, so that what
/// is written can be read as machine.toml or tool.toml. Each fitted key has a companion KEY_se, its standard error.

namespace millforce::host {

/// A key, its unit for the printed table, and the range that the parameter files allow.
struct CalibrationKey {
    std::string_view name;
    std::string_view unit;
    float minimum = -1e12F;
    float maximum = 1e12F;
};

/// Ends the program at its start where neither table has the key.
CalibrationKey key_of(std::string_view table, std::string_view name) noexcept;

/// Table [x], [y] or [z], from position and motor force; order of estimation::SymmetricFrictionIndex.
inline const std::array<CalibrationKey, 4> symmetric_friction_keys{{
    key_of("axis", "mass_kg"),
    key_of("axis", "viscous_N_s_per_m"),
    key_of("axis", "coulomb_N"),
    key_of("axis", "offset_N"),
}};

/// The same tables, in the order of estimation::DirectionalFrictionIndex. The mass is that of symmetric_friction_keys.
inline const std::array<CalibrationKey, 5> directional_friction_keys{{
    key_of("axis", "directional_mass_kg"),
    key_of("axis", "positive_viscous_N_s_per_m"),
    key_of("axis", "negative_viscous_N_s_per_m"),
    key_of("axis", "positive_coulomb_N"),
    key_of("axis", "negative_coulomb_N"),
}};

inline const CalibrationKey friction_force_residual_key = key_of("axis", "residual_rms_N");

/// Table [x], [y] or [z], from recorded currents in air; order of estimation::FeedCurrentIndex. K_x3 is one for both
/// directions: see estimation_calibration/friction_fit.hpp.
inline const std::array<CalibrationKey, 6> feed_current_keys{{
    key_of("axis", "K_x1_positive_A_min2_per_m2"),
    key_of("axis", "K_x2_positive_A_min_per_m"),
    key_of("axis", "K_x1_negative_A_min2_per_m2"),
    key_of("axis", "K_x2_negative_A_min_per_m"),
    key_of("axis", "K_x3_A"),
    key_of("axis", "gravity_A"),
}};

/// Range of the feeds, and what they leave open beyond it.
inline const CalibrationKey slowest_friction_feed_key = key_of("axis", "friction_speed_min_m_per_min");
inline const CalibrationKey fastest_friction_feed_key = key_of("axis", "friction_speed_max_m_per_min");
inline const CalibrationKey friction_curvature_sd_key = key_of("axis", "K_x1_sd_A_min2_per_m2");

inline const CalibrationKey feed_gain_key = key_of("axis", "K_x4_N_per_A");

inline const CalibrationKey friction_current_residual_key = key_of("axis", "friction_residual_rms_A");

/// Table [spindle]; order of estimation::SpindleFitIndex.
inline const std::array<CalibrationKey, 5> spindle_keys{{
    key_of("spindle", "K_t1_Nm_per_A"),
    key_of("spindle", "K_t2_Nm"),
    key_of("spindle", "idle_torque_slope_Nm_s"),
    key_of("spindle", "inertia_kg_m2"),
    key_of("spindle", "base_speed_rad_s"),
}};

inline const CalibrationKey torque_residual_key = key_of("spindle", "torque_residual_rms_Nm");

/// Table [cutting]: the law's coefficients.
inline const std::array<CalibrationKey, 6> cutting_coefficient_keys{{
    key_of("cutting", "k_s_N_per_mm2"),
    key_of("cutting", "p_s"),
    key_of("cutting", "k_1"),
    key_of("cutting", "p_1"),
    key_of("cutting", "K_te_N_per_mm"),
    key_of("cutting", "K_re_N_per_mm"),
}};

/// Table [cutting]: the keys that state the law's uncertainty and range. No KEY_se.
inline const std::array<CalibrationKey, 9> cutting_doubt_keys{{
    key_of("cutting", "K_s_relative_sd"),
    key_of("cutting", "K_s_exponent_sd"),
    key_of("cutting", "r_1_relative_sd"),
    key_of("cutting", "r_1_exponent_sd"),
    key_of("cutting", "reference_chip_thickness_mm"),
    key_of("cutting", "minimum_chip_thickness_mm"),
    key_of("cutting", "maximum_chip_thickness_mm"),
    key_of("cutting", "minimum_feed_per_tooth_mm"),
    key_of("cutting", "maximum_feed_per_tooth_mm"),
}};

/// Table [depth_shape].
inline const CalibrationKey tip_angle_key = key_of("depth_shape", "tip_angle_deg");
inline const CalibrationKey tip_angle_doubt_key = key_of("depth_shape", "tip_angle_sd_deg");

/// Table [cutting]: "down" or "up".
inline const CalibrationKey cut_side_key = key_of("cutting", "cut_side");

}  // namespace millforce::host
