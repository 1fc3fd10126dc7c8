// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters.hpp"

#include <cstddef>
#include <cstdint>
#include <type_traits>

/// Every parameter once: its file, table and key as in TOML, its field, its range. Host and target walk through the
/// parameters by this list; units and sentences are the host's alone (parameters/parameter_table.cpp). Defaults stand
/// in parameters.hpp.

namespace millforce::firmware {

enum class ParameterFile : unsigned char { machine, tool };

/// Where a parameter stands in its file.
struct ParameterName {
    ParameterFile file;
    const char* table;      ///< "axis" stands for "x", "y" and "z", "bus.drive" for "bus.spindle", "bus.x" …
    const char* key;        ///< within the table
    std::size_t place = 0;  ///< which of them: x, y, z, or spindle, x, y, z
};

/// How many fields for_each_parameter visits.
inline constexpr std::size_t machine_parameter_count = 194;
inline constexpr std::size_t tool_parameter_count = 129;
inline constexpr std::size_t parameter_count = machine_parameter_count + tool_parameter_count;

/// A field's value out of a float within the field's range.
template <typename Field>
Field field_of(float value) {
    if constexpr (std::is_same_v<Field, bool>) {
        return value > 0.5F;
    } else if constexpr (std::is_enum_v<Field>) {
        return static_cast<Field>(static_cast<std::uint8_t>(value));
    } else {
        return static_cast<Field>(value);
    }
}

namespace detail {

/// The fields of one table, in the order of their calls. The type of the field says what it holds: a number, a whole
/// number, a flag or a choice.
template <typename Visit>
struct FieldsOfTable {
    Visit& visit;
    ParameterFile file;
    const char* table;
    std::size_t place = 0;

    template <typename Field>
    void operator()(const char* key, Field& field, float minimum, float maximum) const {
        visit(ParameterName{file, table, key, place}, field, minimum, maximum);
    }
    template <typename Choice>
    void operator()(const char* key, Choice& choice, std::remove_const_t<Choice> last) const {
        (*this)(key, choice, 0.0F, static_cast<float>(last));
    }
    template <typename Flag>
    void operator()(const char* key, Flag& flag) const {
        static_assert(std::is_same_v<std::remove_const_t<Flag>, bool>);
        (*this)(key, flag, 0.0F, 1.0F);
    }
};
template <typename Visit>
FieldsOfTable(Visit&, ParameterFile, const char*, std::size_t = 0) -> FieldsOfTable<Visit>;

template <typename Machine, typename Visit>
void visit_spindle(Machine& machine, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::machine, "spindle"};
    field("K_t1_Nm_per_A", machine.spindle.K_t1_Nm_per_A, 1e-4F, 1e4F);
    field("K_t2_Nm", machine.spindle.K_t2_Nm, -1e4F, 1e4F);
    field("idle_torque_slope_Nm_s", machine.spindle.idle_torque_slope_Nm_s, -10.0F, 10.0F);
    field("inertia_kg_m2", machine.spindle.inertia_kg_m2, 0.0F, 100.0F);
    field("base_speed_rad_s", machine.spindle.base_speed_rad_s, 0.0F, 2e4F);
    field("gain_relative_sd", machine.spindle.gain_relative_sd, 0.0F, 1.0F);
    field("idle_torque_sd_Nm", machine.spindle.idle_torque_sd_Nm, 0.0F, 1e3F);
    field("idle_walk_Nm_per_sqrt_s", machine.spindle.idle_walk_Nm_per_sqrt_s, 0.0F, 1e2F);
    field("warm_up_torque_Nm", machine.spindle.warm_up_torque_Nm, -1e3F, 1e3F);
    field("warm_up_torque_sd_Nm", machine.spindle.warm_up_torque_sd_Nm, 0.0F, 1e3F);
    field("warm_up_time_s", machine.spindle.warm_up_time_s, 0.0F, 1e5F);
    field("current_sd_A", machine.spindle.current_sd_A, 0.0F, 1e3F);
    field("rated_current_A", machine.spindle_rated_current_A, 0.0F, 1e4F);
    field("load_period_s", machine.spindle_load_period_s, 0.0F, 1.0F);
    field("load_age_s", machine.spindle_load_age_s, 0.0F, 1.0F);
    field("encoder_counts_per_rev", machine.encoder_counts_per_rev, 16, 1048576);
}

template <typename Machine, typename Visit>
void visit_axis(Machine& machine, std::size_t place, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::machine, "axis", place};
    auto& axis = machine.axes[place];
    field("K_x1_positive_A_min2_per_m2", axis.positive.K_x1_A_min2_per_m2, -1e3F, 1e3F);
    field("K_x2_positive_A_min_per_m", axis.positive.K_x2_A_min_per_m, -1e3F, 1e3F);
    field("K_x1_negative_A_min2_per_m2", axis.negative.K_x1_A_min2_per_m2, -1e3F, 1e3F);
    field("K_x2_negative_A_min_per_m", axis.negative.K_x2_A_min_per_m, -1e3F, 1e3F);
    field("K_x3_A", axis.K_x3_A, -1e3F, 1e3F);
    field("gravity_A", axis.gravity_A, -1e3F, 1e3F);
    field("K_x4_N_per_A", axis.K_x4_N_per_A, 0.0F, 1e5F);
    field("K_x5_N_m_per_min", axis.K_x5_N_m_per_min, -1e5F, 1e5F);
    field("mass_kg", axis.mass_kg, 0.0F, 1e5F);
    field("velocity_floor_mm_s", axis.velocity_floor_mm_s, 0.01F, 1e3F);
    field("gain_relative_sd", axis.gain_relative_sd, 0.0F, 1.0F);
    field("friction_relative_sd", axis.friction_relative_sd, 0.0F, 2.0F);
    field("friction_speed_min_m_per_min", axis.friction_speed_min_m_per_min, 0.0F, 1e3F);
    field("friction_speed_max_m_per_min", axis.friction_speed_max_m_per_min, 0.0F, 1e3F);
    field("K_x1_sd_A_min2_per_m2", axis.K_x1_sd_A_min2_per_m2, 0.0F, 1e3F);
    field("friction_walk_per_sqrt_s", axis.friction_walk_per_sqrt_s, 0.0F, 1.0F);
    field("friction_ripple_A", axis.friction_ripple_A, 0.0F, 1e2F);
    field("current_sd_A", axis.current_sd_A, 0.0F, 1e3F);
    field("rated_current_A", machine.axis_rated_current_A[place], 0.0F, 1e4F);
}

template <typename Cnc, typename Visit>
void visit_cnc(Cnc& cnc, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::machine, "cnc"};
    field("override_min", cnc.override_min, 0.0F, 1.0F);
    field("override_max", cnc.override_max, 0.1F, 9.0F);
    field("override_latency_s", cnc.override_latency_s, 0.0F, 1.0F);
    field("acceleration_mm_s2", cnc.acceleration_mm_s2, 1.0F, 1e6F);
    field("stale_s", cnc.stale_s, 0.001F, 10.0F);
    field("sample_rate_hz", cnc.sample_rate_hz, 10.0F, 1e5F);
}

template <typename Bus, typename Visit>
void visit_bus(Bus& bus, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::machine, "bus"};
    field("role", bus.role, BusRole::master);
    field("produces_sync", bus.produces_sync);
    field("sync_id", bus.sync_id, 1, 2047);
    field("sync_period_ms", bus.sync_period_ms, 0.1F, 1000.0F);
    field("collect_time_ms", bus.collect_time_ms, 0.01F, 1000.0F);
    field("override_id", bus.override_id, 1, 2047);
    field("override_node_id", bus.override_node_id, 1, 127);
    field("override_period_ms", bus.override_period_ms, 0.5F, 1000.0F);
    field("override_heartbeat_ms", bus.override_heartbeat_ms, 1.0F, 10000.0F);
    field("program_status_id", bus.program_status_id, 0, 2047);
    field("program_status_timeout_ms", bus.program_status_timeout_ms, 1.0F, 10000.0F);
}

template <typename Drive, typename Visit>
void visit_drive(Drive& drive, std::size_t place, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::machine, "bus.drive", place};
    field("node_id", drive.node_id, 0, 127);
    field("current_source", drive.current_source, CurrentSource::torque);
    field("current_basis", drive.current_basis, CurrentBasis::peak);
    field("current_reversed", drive.current_reversed);
    field("rated_torque_Nm", drive.rated_torque_Nm, 0.0F, 1e6F);
    field("torque_constant_Nm_per_A", drive.torque_constant_Nm_per_A, 0.0F, 1e4F);
    field("largest_share_of_rated", drive.largest_share_of_rated, 0.01F, 32.0F);
    field("velocity_source", drive.velocity_source, VelocitySource::position);
    field("velocity_mm_s_per_unit", drive.velocity_mm_s_per_unit, -1e4F, 1e4F);
    field("position_mm_per_unit", drive.position_mm_per_unit, -1e4F, 1e4F);
    field("largest_velocity_mm_s", drive.largest_velocity_mm_s, 0.1F, 1e5F);
    field("count_modulus", drive.count_modulus, 0, 16777216);
    field("largest_count_step", drive.largest_count_step, 1, 16777216);
    field("count_reversed", drive.count_reversed);
    field("heartbeat_timeout_ms", drive.heartbeat_timeout_ms, 0.0F, 60000.0F);
    field("heartbeat_period_ms", drive.heartbeat_period_ms, 0.0F, 60000.0F);
    field("write_mapping", drive.write_mapping);
    field("stale_ms", drive.stale_ms, 0.0F, 10000.0F);
    field("tpdo1_id", drive.tpdo_id[0], 0, 1407);
    field("tpdo2_id", drive.tpdo_id[1], 0, 1407);
    field("tpdo3_id", drive.tpdo_id[2], 0, 1407);
    field("tpdo4_id", drive.tpdo_id[3], 0, 1407);
    field("tpdo1_every", drive.tpdo_every[0], 0, 240);
    field("tpdo2_every", drive.tpdo_every[1], 0, 240);
    field("tpdo3_every", drive.tpdo_every[2], 0, 240);
    field("tpdo4_every", drive.tpdo_every[3], 0, 240);
}

template <typename Tool, typename Visit>
void visit_geometry(Tool& tool, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "tool"};
    field("teeth", tool.teeth, 1, 12);
    field("diameter_mm", tool.diameter_mm, 0.1F, 1000.0F);
    field("helix_deg", tool.helix_deg, 0.0F, 60.0F);
    field("flute_length_mm", tool.flute_length_mm, 0.1F, 300.0F);
    field("runout_um", tool.runout_um, 0.0F, 500.0F);
    field("side", tool.side, estimation::CutSide::unknown);
    field("centre_offset_mm", tool.centre_offset_mm, -500.0F, 500.0F);
    field("tooth_force_limit_N", tool.tooth_force_limit_N, 0.1F, 1e6F);
    field("break_share", tool.break_share, 1.0F, 10.0F);
}

template <typename Tool, typename Visit>
void visit_cutting(Tool& tool, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "cutting"};
    field("k_s_N_per_mm2", tool.law.k_s_N_per_mm2, 1.0F, 1e6F);
    field("p_s", tool.law.p_s, -0.95F, 0.5F);
    field("k_1", tool.law.k_1, -10.0F, 10.0F);
    field("p_1", tool.law.p_1, -2.0F, 1.0F);
    field("K_te_N_per_mm", tool.law.K_te_N_per_mm, -1e4F, 1e4F);
    field("K_re_N_per_mm", tool.law.K_re_N_per_mm, -1e4F, 1e4F);
    field("K_s_relative_sd", tool.law.K_s_relative_sd, 0.0F, 2.0F);
    field("K_s_exponent_sd", tool.law.K_s_exponent_sd, 0.0F, 2.0F);
    field("r_1_relative_sd", tool.law.r_1_relative_sd, 0.0F, 2.0F);
    field("r_1_exponent_sd", tool.law.r_1_exponent_sd, 0.0F, 2.0F);
    field("reference_chip_thickness_mm", tool.law.reference_chip_thickness_mm, 0.0F, 10.0F);
    field("minimum_chip_thickness_mm", tool.law.minimum_chip_thickness_mm, 0.0F, 10.0F);
    field("maximum_chip_thickness_mm", tool.law.maximum_chip_thickness_mm, 0.0F, 10.0F);
    field("law_relative_sd", tool.law_relative_sd, 0.0F, 1.0F);
}

template <typename Model, typename Visit>
void visit_roughness(Model& model, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "roughness"};
    field("measure", model.measure, estimation::RoughnessMeasure::Rz);
    field("constant_um", model.constant_um, 0.0F, 1e30F);
    field("spindle_speed_exponent", model.exponent[0], -50.0F, 50.0F);
    field("feed_exponent", model.exponent[1], -50.0F, 50.0F);
    field("tool_diameter_exponent", model.exponent[2], -50.0F, 50.0F);
    field("axial_depth_exponent", model.exponent[3], -50.0F, 50.0F);
    field("force_ratio_exponent", model.exponent[4], -50.0F, 50.0F);
    field("spindle_speed_minimum_rpm", model.minimum[0], 0.0F, 1e6F);
    field("spindle_speed_maximum_rpm", model.maximum[0], 0.0F, 1e6F);
    field("spindle_speed_mean_rpm", model.reference[0], 0.0F, 1e6F);
    field("feed_minimum_mm_rev", model.minimum[1], 0.0F, 1e3F);
    field("feed_maximum_mm_rev", model.maximum[1], 0.0F, 1e3F);
    field("feed_mean_mm_rev", model.reference[1], 0.0F, 1e3F);
    field("tool_diameter_minimum_mm", model.minimum[2], 0.0F, 1e3F);
    field("tool_diameter_maximum_mm", model.maximum[2], 0.0F, 1e3F);
    field("tool_diameter_mean_mm", model.reference[2], 0.0F, 1e3F);
    field("axial_depth_minimum_mm", model.minimum[3], 0.0F, 1e3F);
    field("axial_depth_maximum_mm", model.maximum[3], 0.0F, 1e3F);
    field("axial_depth_mean_mm", model.reference[3], 0.0F, 1e3F);
    field("force_ratio_minimum", model.minimum[4], 0.0F, 1e4F);
    field("force_ratio_maximum", model.maximum[4], 0.0F, 1e4F);
    field("force_ratio_mean", model.reference[4], 0.0F, 1e4F);
    field("tests", model.tests, 0.0F, 1e6F);
    field("degrees_of_freedom", model.degrees_of_freedom, 0.0F, 1e6F);
    field("residual_ln_sd", model.residual_ln_sd, 0.0F, 10.0F);
    field("largest_leverage", model.largest_leverage, 0.0F, 1.0F);
}

template <typename Model, typename Visit>
void visit_leverage(Model& model, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "roughness"};
    field("leverage_spindle_speed", model.leverage[0], 0.0F, 1e9F);
    field("leverage_spindle_speed_feed", model.leverage[1], -1e9F, 1e9F);
    field("leverage_feed", model.leverage[2], 0.0F, 1e9F);
    field("leverage_spindle_speed_tool_diameter", model.leverage[3], -1e9F, 1e9F);
    field("leverage_feed_tool_diameter", model.leverage[4], -1e9F, 1e9F);
    field("leverage_tool_diameter", model.leverage[5], 0.0F, 1e9F);
    field("leverage_spindle_speed_axial_depth", model.leverage[6], -1e9F, 1e9F);
    field("leverage_feed_axial_depth", model.leverage[7], -1e9F, 1e9F);
    field("leverage_tool_diameter_axial_depth", model.leverage[8], -1e9F, 1e9F);
    field("leverage_axial_depth", model.leverage[9], 0.0F, 1e9F);
    field("leverage_spindle_speed_force_ratio", model.leverage[10], -1e9F, 1e9F);
    field("leverage_feed_force_ratio", model.leverage[11], -1e9F, 1e9F);
    field("leverage_tool_diameter_force_ratio", model.leverage[12], -1e9F, 1e9F);
    field("leverage_axial_depth_force_ratio", model.leverage[13], -1e9F, 1e9F);
    field("leverage_force_ratio", model.leverage[14], 0.0F, 1e9F);
}

template <typename Sensor, typename Visit>
void visit_force_sensor(Sensor& sensor, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "force_sensor"};
    field("low_pass_hz", sensor.low_pass_hz, 0.0F, 1e5F);
    field("zero_drift_sd_N", sensor.zero_drift_sd_N, 0.0F, 1e4F);
}

template <typename ForceDrop, typename Visit>
void visit_force_drop(ForceDrop& force_drop, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "force_drop"};
    auto& law = force_drop.law;
    field("e_t_mm", law.e_t_mm, -1.0F, 1.0F);
    field("e_r_mm", law.e_r_mm, -1.0F, 1.0F);
    field("e_t_sd_mm", law.e_t_sd_mm, 0.0F, 1.0F);
    field("e_r_sd_mm", law.e_r_sd_mm, 0.0F, 1.0F);
    field("a", law.a, -10.0F, 10.0F);
    field("b", law.b, -10.0F, 10.0F);
    field("a_variance", law.a_b_covariance(0, 0), 0.0F, 100.0F);
    field("a_b_covariance", law.a_b_covariance(0, 1), -100.0F, 100.0F);
    field("b_variance", law.a_b_covariance(1, 1), 0.0F, 100.0F);
    field("r_scatter", law.r_scatter, 0.0F, 10.0F);
    field("r_av_mean", law.r_av_mean, -10.0F, 10.0F);
    field("r_av_sd", law.r_av_sd, 0.0F, 10.0F);
    field("c_0", law.c(0), -10.0F, 10.0F);
    field("c_1", law.c(1), -10.0F, 10.0F);
    field("c_2", law.c(2), -10.0F, 10.0F);
    field("c_0_variance", law.c_covariance(0, 0), 0.0F, 100.0F);
    field("c_0_c_1_covariance", law.c_covariance(0, 1), -100.0F, 100.0F);
    field("c_0_c_2_covariance", law.c_covariance(0, 2), -100.0F, 100.0F);
    field("c_1_variance", law.c_covariance(1, 1), 0.0F, 100.0F);
    field("c_1_c_2_covariance", law.c_covariance(1, 2), -100.0F, 100.0F);
    field("c_2_variance", law.c_covariance(2, 2), 0.0F, 100.0F);
    field("ln_K_scatter", law.ln_K_scatter, 0.0F, 10.0F);
    field("other_step_x_mm", law.other_step_x_mm, -10.0F, 10.0F);
    field("other_step_y_mm", law.other_step_y_mm, -10.0F, 10.0F);
    field("other_slope_x", law.other_slope_x, -100.0F, 100.0F);
    field("other_slope_y", law.other_slope_y, -100.0F, 100.0F);
    field("smallest_immersion", law.smallest_immersion, 0.05F, 0.9F);
    field("largest_immersion", law.largest_immersion, 0.0F, 0.95F);
    field("revolutions", force_drop.revolutions, 1, 100);
}

template <typename DepthShape, typename Visit>
void visit_depth_shape(DepthShape& depths, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "depth_shape"};
    field("nominal_axial_depth_mm", depths.nominal_axial_depth_mm, 0.0F, 300.0F);
    field("nominal_radial_width_mm", depths.nominal_radial_width_mm, 0.0F, 1000.0F);
    field("feed_per_tooth_mm", depths.feed_per_tooth_mm, 0.0F, 10.0F);
    field("revolutions", depths.revolutions, 1, 1000);
    field("tip_angle_deg", depths.tip_angle_deg, 0.0F, 360.0F);
    field("tip_angle_sd_deg", depths.tip_angle_sd_deg, 0.0F, 90.0F);
}

template <typename Tool, typename Visit>
void visit_control(Tool& tool, Visit& visit) {
    const FieldsOfTable field{visit, ParameterFile::tool, "control"};
    auto& control = tool.control;
    field("entry_feed_per_tooth_mm", control.entry_feed_per_tooth_mm, 1e-4F, 10.0F);
    field("air_feed_per_tooth_mm", control.air_feed_per_tooth_mm, 1e-4F, 10.0F);
    field("max_feed_per_tooth_mm", control.max_feed_per_tooth_mm, 1e-4F, 10.0F);
    field("highest_programmed_feed_mm_s", control.highest_programmed_feed_mm_s, 0.0F, 1e4F);
    field("setpoint_share", control.setpoint_share, 0.1F, 1.0F);
    field("caution_sd", control.caution_sd, 0.0F, 4.0F);
    field("recovery_per_rev", control.recovery_per_rev, 0.001F, 1.0F);
    field("slew_up_per_s", control.slew_up_per_s, 0.001F, 1e3F);
    field("slew_down_per_s", control.slew_down_per_s, 0.001F, 1e4F);
    field("entry_revolutions", control.entry_revolutions, 0.0F, 100.0F);
    field("entry_travel_mm", control.entry_travel_mm, 0.0F, 1e3F);
    field("exit_travel_mm", control.exit_travel_mm, 0.0F, 1e3F);
    field("contact_force_N", control.contact_force_N, 0.01F, 1e5F);
    field("contact_significance", control.contact_significance, 0.0F, 100.0F);
    field("declared_axial_depth_mm", tool.declared_axial_depth_mm, 0.0F, 300.0F);
    field("surge_radial_immersion", control.surge_radial_immersion, 0.0F, 2.0F);
    field("surge_share", control.surge_share, 0.1F, 2.0F);
    field("depth_step_ratio", control.depth_step_ratio, 1.0F, 10.0F);
    field("depth_step_share", control.depth_step_share, 0.1F, 10.0F);
    field("proven_override", control.proven_override, 0.0F, 10.0F);
    field("safe_override", control.safe_override, 0.0F, 10.0F);
    field("turn_radial_immersion", control.turn_radial_immersion, 0.0F, 2.0F);
    field("turn_travel_mm", control.turn_travel_mm, 0.0F, 1000.0F);
    field("overload_share", control.overload_share, 1.0F, 10.0F);
    field("overload_revolutions", control.overload_revolutions, 0.0F, 1e3F);
    field("no_estimate_hold_s", control.no_estimate_hold_s, 0.0F, 60.0F);
    field("Ra_limit_um", control.Ra_limit_um, 0.0F, 1e3F);
    field("monitor_only", tool.monitor_only);
}

}  // namespace detail

/// Calls visit(name, field, minimum, maximum) for each parameter of a machine. `machine` may be const.
template <typename Machine, typename Visit>
void for_each_machine_parameter(Machine& machine, Visit& visit) {
    detail::visit_spindle(machine, visit);
    for (std::size_t k = 0; k < machine.axes.size(); ++k) {
        detail::visit_axis(machine, k, visit);
    }
    detail::visit_cnc(machine.cnc, visit);
    detail::visit_bus(machine.bus, visit);
    for (std::size_t k = 0; k < machine.bus.drives.size(); ++k) {
        detail::visit_drive(machine.bus.drives[k], k, visit);
    }
}

/// The same for a tool.
template <typename Tool, typename Visit>
void for_each_tool_parameter(Tool& tool, Visit& visit) {
    detail::visit_geometry(tool, visit);
    detail::visit_cutting(tool, visit);
    detail::visit_roughness(tool.roughness, visit);
    detail::visit_leverage(tool.roughness, visit);
    detail::visit_force_sensor(tool.force_sensor, visit);
    detail::visit_force_drop(tool.force_drop, visit);
    detail::visit_depth_shape(tool.depth_shape, visit);
    detail::visit_control(tool, visit);
}

/// Those of the machine, then those of the tool.
template <typename AnyParameters, typename Visit>
void for_each_parameter(AnyParameters& parameters, Visit visit) {
    for_each_machine_parameter(parameters.machine, visit);
    for_each_tool_parameter(parameters.tool, visit);
}

}  // namespace millforce::firmware
