// SPDX-License-Identifier: Apache-2.0
#include "parameters/parameter_table.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string_view>

#include "parameters/parameter_choices.hpp"

namespace millforce::host {

namespace {

using firmware::ParameterFile;
using firmware::ParameterName;

/// What a reader needs to know of a key beside its field and range (firmware/parameter_fields.hpp).
struct ParameterText {
    std::string_view table;
    std::string_view key;
    const char* unit;
    const char* sentence;
    bool is_required = false;
    const char* choices = nullptr;  ///< names of the values 0, 1, … of an enumeration, separated by '|'
};

// The rows are data; one row a line keeps them readable as the table that they are.
// clang-format off
constexpr auto parameter_texts = std::to_array<ParameterText>({
    {"spindle", "K_t1_Nm_per_A", "N·m/A", "Spindle torque per ampere below base speed: the paper's K_t1 times the cutter radius.", must_be_given},
    {"spindle", "K_t2_Nm", "N·m", "Torque at zero current, minus K_t1 times the idle current; re-zeroed in air."},
    {"spindle", "idle_torque_slope_Nm_s", "N·m·s/rad", "Growth of the idle torque with speed."},
    {"spindle", "inertia_kg_m2", "kg·m²", "Inertia of spindle, rotor and tool."},
    {"spindle", "base_speed_rad_s", "rad/s", "Speed above which the torque constant falls as 1/speed (field weakening); 0: never."},
    {"spindle", "gain_relative_sd", "1", "Relative standard deviation of K_t1 from its calibration."},
    {"spindle", "idle_torque_sd_Nm", "N·m", "Standard deviation of the idle torque before the first re-zeroing in air."},
    {"spindle", "idle_walk_Nm_per_sqrt_s", "N·m/√s", "Drift of the idle torque, apart from the warm-up, as a random walk."},
    {"spindle", "warm_up_torque_Nm", "N·m", "How much larger the idle torque of the cold spindle is than that of the warm one, at working speed."},
    {"spindle", "warm_up_torque_sd_Nm", "N·m", "Standard deviation of warm_up_torque_Nm; the spindle may be half warm when the controller starts."},
    {"spindle", "warm_up_time_s", "s", "Time constant of the warm-up; 0: not known."},
    {"spindle", "current_sd_A", "A", "Noise of one sample of the spindle current."},
    {"spindle", "rated_current_A", "A", "Rated current, the unit of CiA 402 object 0x6078; 0: not known."},
    {"spindle", "load_period_s", "s", "Period of a spindle current that comes seldom, as a frequency converter gives it over Modbus; 0: with each sample."},
    {"spindle", "load_age_s", "s", "Age of such a current when it arrives, its smoothing included."},
    {"spindle", "encoder_counts_per_rev", "1", "Counts of the spindle encoder per revolution, after quadrature."},

    {"axis", "K_x1_positive_A_min2_per_m2", "A/(m/min)²", "Friction current travelling in + direction, quadratic term."},
    {"axis", "K_x2_positive_A_min_per_m", "A/(m/min)", "Friction current travelling in + direction, linear term."},
    {"axis", "K_x1_negative_A_min2_per_m2", "A/(m/min)²", "Magnitude of the friction current travelling in - direction, quadratic term."},
    {"axis", "K_x2_negative_A_min_per_m", "A/(m/min)", "Magnitude of the friction current travelling in - direction, linear term."},
    {"axis", "K_x3_A", "A", "Friction current, constant term, of both directions."},
    {"axis", "gravity_A", "A", "Current that holds the axis against its weight, with half the difference of the directions' constant friction."},
    {"axis", "K_x4_N_per_A", "N/A", "Force per ampere of feed motor current; 0: no force from this axis."},
    {"axis", "K_x5_N_m_per_min", "N·m/min", "Force term K_x5/w of the feed drive (Kim & Chung Eq. 10)."},
    {"axis", "mass_kg", "kg", "Moved mass, with the motor's inertia reflected."},
    {"axis", "velocity_floor_mm_s", "mm/s", "Below this speed the axis gives no estimate: friction is undefined at rest."},
    {"axis", "gain_relative_sd", "1", "Relative standard deviation of K_x4 from its calibration."},
    {"axis", "friction_relative_sd", "1", "Relative standard deviation of the friction before the first re-zeroing in air."},
    {"axis", "friction_speed_min_m_per_min", "m/min", "Slowest feed of the friction's calibration."},
    {"axis", "friction_speed_max_m_per_min", "m/min", "Fastest feed of the friction's calibration; 0: not known. Beyond both the friction is less certain, by K_x1_sd_A_min2_per_m2."},
    {"axis", "K_x1_sd_A_min2_per_m2", "A/(m/min)²", "Standard deviation of K_x1 from that calibration, also of one that was left out."},
    {"axis", "friction_walk_per_sqrt_s", "1/√s", "Drift of the friction, relative, as a random walk."},
    {"axis", "friction_ripple_A", "A", "Part of the friction that depends on the position and does not average out."},
    {"axis", "current_sd_A", "A", "Noise of one sample of the motor current."},
    {"axis", "rated_current_A", "A", "Rated current, the unit of CiA 402 object 0x6078; 0: not known."},

    {"cnc", "override_min", "1", "Smallest feed override that the controller commands."},
    {"cnc", "override_max", "1", "Largest feed override that the CNC accepts."},
    {"cnc", "override_latency_s", "s", "Time from an override to the first change of the commanded velocity."},
    {"cnc", "acceleration_mm_s2", "mm/s²", "Acceleration limit of the path velocity."},
    {"cnc", "stale_s", "s", "If no drive sample comes for this long, the controller faults and holds the feed."},
    {"cnc", "sample_rate_hz", "Hz", "Rate of the drive samples."},

    {"bus", "role", "", "Master: reads rated values, writes what is asked to and starts the drives (SDO, NMT). Listener: sends none of these, the CNC is the master.", may_be_left_out, "listener|master"},
    {"bus", "produces_sync", "", "This controller sends SYNC; else the CNC or a drive does."},
    {"bus", "sync_id", "", "CAN id of SYNC."},
    {"bus", "sync_period_ms", "ms", "Time between two SYNCs, and so between two samples."},
    {"bus", "collect_time_ms", "ms", "What arrives later than this after a SYNC is missing from its sample; at most the period."},
    {"bus", "override_id", "", "CAN id of the override frame."},
    {"bus", "override_node_id", "", "CANopen node id of this controller's heartbeat."},
    {"bus", "override_period_ms", "ms", "Time between two override frames."},
    {"bus", "override_heartbeat_ms", "ms", "Time between two heartbeats of this controller."},
    {"bus", "program_status_id", "", "CAN id of the frame in which the CNC reports F, rapid and hold; 0: it reports nothing, and the override stays at its minimum."},
    {"bus", "program_status_timeout_ms", "ms", "The feed is held when a CNC that has reported its status is silent for longer."},

    {"bus.drive", "node_id", "", "CANopen node of the drive; 0: this drive is not on the bus."},
    {"bus.drive", "current_source", "", "Source of the current: 0x6078 (current), or 0x6077 (torque) over the torque constant.", may_be_left_out, "current|torque"},
    {"bus.drive", "current_basis", "", "Whether the drive's rated current is an rms or a peak value.", may_be_left_out, "rms|peak"},
    {"bus.drive", "current_reversed", "", "The drive counts the current against the machine axis."},
    {"bus.drive", "rated_torque_Nm", "N·m", "Rated torque, the unit of 0x6077; 0: read from 0x6076. For the current see rated_current_A in the drive's table; if that is 0: read from 0x6075."},
    {"bus.drive", "torque_constant_Nm_per_A", "N·m/A", "Torque constant of the motor, for current_source = \"torque\"."},
    {"bus.drive", "largest_share_of_rated", "1", "A current or torque of more than this multiple of the rated one is not used; best below the drive's limit."},
    {"bus.drive", "velocity_source", "", "Axes: 0x606C (velocity), or the difference of 0x6064 between two SYNCs (position).", may_be_left_out, "velocity|position"},
    {"bus.drive", "velocity_mm_s_per_unit", "mm/s", "Unit of 0x606C; negative: the drive counts against the machine axis."},
    {"bus.drive", "position_mm_per_unit", "mm", "Unit of 0x6064; with both units the two are compared. 0: not known."},
    {"bus.drive", "largest_velocity_mm_s", "mm/s", "A larger velocity is not used."},
    {"bus.drive", "count_modulus", "1", "Spindle: counts after which the object starts again at 0; 0: the object's width."},
    {"bus.drive", "largest_count_step", "1", "Spindle: a step of more counts per SYNC is not used."},
    {"bus.drive", "count_reversed", "", "Spindle: the count falls in the cutting direction (M3)."},
    {"bus.drive", "heartbeat_timeout_ms", "ms", "A drive whose heartbeat is missing for longer counts as lost; 0: not watched."},
    {"bus.drive", "heartbeat_period_ms", "ms", "Heartbeat period that a master writes to 0x1017; 0: left unchanged."},
    {"bus.drive", "write_mapping", "", "A master writes tpdo1 … tpdo4 to the drive; else the drive has this mapping already."},
    {"bus.drive", "stale_ms", "ms", "Largest age at which a PDO that does not come at every SYNC is used."},
    {"bus.drive", "tpdo1_id", "", "CAN id of TPDO 1; 0: 0x180 + node_id."},
    {"bus.drive", "tpdo2_id", "", "CAN id of TPDO 2; 0: 0x280 + node_id."},
    {"bus.drive", "tpdo3_id", "", "CAN id of TPDO 3; 0: 0x380 + node_id."},
    {"bus.drive", "tpdo4_id", "", "CAN id of TPDO 4; 0: 0x480 + node_id."},
    {"bus.drive", "tpdo1_every", "", "TPDO 1 comes at every n-th SYNC; 0: when something changes."},
    {"bus.drive", "tpdo2_every", "", "TPDO 2 comes at every n-th SYNC; 0: when something changes."},
    {"bus.drive", "tpdo3_every", "", "TPDO 3 comes at every n-th SYNC; 0: when something changes."},
    {"bus.drive", "tpdo4_every", "", "TPDO 4 comes at every n-th SYNC; 0: when something changes."},

    {"tool", "teeth", "1", "Number of teeth or inserts.", must_be_given},
    {"tool", "diameter_mm", "mm", "Cutting diameter.", must_be_given},
    {"tool", "helix_deg", "°", "Helix angle of the flutes; 0 for inserts."},
    {"tool", "flute_length_mm", "mm", "Longest axial depth that the tool can cut.", must_be_given},
    {"tool", "runout_um", "µm", "Largest difference between the radii of two teeth, until a cut shows it; half of it always stays. 0, as where it is left out: none, and no cut will show one."},
    {"tool", "side", "", "Which edge of the cut is fixed while its width varies: a hint that the forces may refute; unknown: inferred from them.", may_be_left_out, "down|up|centred|unknown"},
    {"tool", "centre_offset_mm", "mm", "Offset of the workpiece's centre line from the cutter's axis, for side = \"centred\"."},
    {"tool", "tooth_force_limit_N", "N", "F_tooth,max: the largest in-plane force that one tooth may carry.", must_be_given},
    {"tool", "break_share", "1", "Multiple of its limit at which a tooth breaks (simulation)."},

    {"cutting", "k_s_N_per_mm2", "N/mm²", "K_s at a mean chip thickness of 1 mm: K_s = k_s t_a^p_s.", must_be_given},
    {"cutting", "p_s", "1", "Exponent of K_s over the mean chip thickness."},
    {"cutting", "k_1", "1", "r_1 = F_r/F_t at a mean chip thickness of 1 mm: r_1 = k_1 t_a^p_1.", must_be_given},
    {"cutting", "p_1", "1", "Exponent of r_1 over the mean chip thickness."},
    {"cutting", "K_te_N_per_mm", "N/mm", "Tangential edge force per length of edge."},
    {"cutting", "K_re_N_per_mm", "N/mm", "Radial edge force per length of edge."},
    {"cutting", "K_s_relative_sd", "1", "Standard deviation of ln K_s at the reference chip thickness."},
    {"cutting", "K_s_exponent_sd", "1", "Growth of this standard deviation per unit of ln(t_a/t_ref)."},
    {"cutting", "r_1_relative_sd", "1", "Standard deviation of ln r_1 at the reference chip thickness."},
    {"cutting", "r_1_exponent_sd", "1", "Growth of this standard deviation per unit of ln(t_a/t_ref)."},
    {"cutting", "reference_chip_thickness_mm", "mm", "Chip thickness t_ref at which the calibration is most certain; 0: the standard deviations do not grow."},
    {"cutting", "minimum_chip_thickness_mm", "mm", "Thinnest mean chip of the calibration cuts."},
    {"cutting", "maximum_chip_thickness_mm", "mm", "Thickest mean chip of the calibration cuts; 0: not known."},
    {"cutting", "law_relative_sd", "1", "Misfit of the law itself, relative to the tangential force."},

    {"roughness", "measure", "", "Which roughness the model predicts: R_a or R_z.", may_be_left_out, "Ra|Rz"},
    {"roughness", "constant_um", "µm", "C of R = C V^a f^b φ^c D^d ρ^e (V rpm, f mm/rev, φ and D mm, ρ = F_x/F_z); 0: no model, no prediction."},
    {"roughness", "spindle_speed_exponent", "1", "Exponent of the spindle speed."},
    {"roughness", "feed_exponent", "1", "Exponent of the feed per revolution."},
    {"roughness", "tool_diameter_exponent", "1", "Exponent of the tool diameter."},
    {"roughness", "axial_depth_exponent", "1", "Exponent of the axial depth."},
    {"roughness", "force_ratio_exponent", "1", "Exponent of the ratio F_x/F_z."},
    {"roughness", "spindle_speed_minimum_rpm", "1/min", "Smallest spindle speed of the tests."},
    {"roughness", "spindle_speed_maximum_rpm", "1/min", "Largest spindle speed of the tests; 0: not known."},
    {"roughness", "spindle_speed_mean_rpm", "1/min", "Geometric mean of the tests' spindle speed; 0: no interval."},
    {"roughness", "feed_minimum_mm_rev", "mm/rev", "Smallest feed per revolution of the tests."},
    {"roughness", "feed_maximum_mm_rev", "mm/rev", "Largest feed per revolution of the tests; 0: not known."},
    {"roughness", "feed_mean_mm_rev", "mm/rev", "Geometric mean of the tests' feed per revolution; 0: no interval."},
    {"roughness", "tool_diameter_minimum_mm", "mm", "Smallest tool diameter of the tests."},
    {"roughness", "tool_diameter_maximum_mm", "mm", "Largest tool diameter of the tests; 0: not known."},
    {"roughness", "tool_diameter_mean_mm", "mm", "Geometric mean of the tests' tool diameter; 0: no interval."},
    {"roughness", "axial_depth_minimum_mm", "mm", "Smallest axial depth of the tests."},
    {"roughness", "axial_depth_maximum_mm", "mm", "Largest axial depth of the tests; 0: not known."},
    {"roughness", "axial_depth_mean_mm", "mm", "Geometric mean of the tests' axial depth; 0: no interval."},
    {"roughness", "force_ratio_minimum", "1", "Smallest ratio F_x/F_z of the tests."},
    {"roughness", "force_ratio_maximum", "1", "Largest ratio F_x/F_z of the tests; 0: not known."},
    {"roughness", "force_ratio_mean", "1", "Geometric mean of the tests' ratio F_x/F_z; 0: no interval."},
    {"roughness", "tests", "1", "Number of tests n; 0: no interval."},
    {"roughness", "degrees_of_freedom", "1", "Tests minus parameters, n − p; 0: no interval."},
    {"roughness", "residual_ln_sd", "1", "Standard deviation of ln R about the model; 0: no interval."},
    {"roughness", "largest_leverage", "1", "Largest leverage of a test; beyond it a cut lies outside of the fitted range. 0: not known."},
    {"roughness", "leverage_spindle_speed", "1", "(ZᵀZ)⁻¹ of the tests' centred logarithms: spindle speed."},
    {"roughness", "leverage_spindle_speed_feed", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: spindle speed and feed per revolution."},
    {"roughness", "leverage_feed", "1", "(ZᵀZ)⁻¹ of the tests' centred logarithms: feed per revolution."},
    {"roughness", "leverage_spindle_speed_tool_diameter", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: spindle speed and tool diameter."},
    {"roughness", "leverage_feed_tool_diameter", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: feed per revolution and tool diameter."},
    {"roughness", "leverage_tool_diameter", "1", "(ZᵀZ)⁻¹ of the tests' centred logarithms: tool diameter."},
    {"roughness", "leverage_spindle_speed_axial_depth", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: spindle speed and axial depth."},
    {"roughness", "leverage_feed_axial_depth", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: feed per revolution and axial depth."},
    {"roughness", "leverage_tool_diameter_axial_depth", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: tool diameter and axial depth."},
    {"roughness", "leverage_axial_depth", "1", "(ZᵀZ)⁻¹ of the tests' centred logarithms: axial depth."},
    {"roughness", "leverage_spindle_speed_force_ratio", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: spindle speed and ratio F_x/F_z."},
    {"roughness", "leverage_feed_force_ratio", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: feed per revolution and ratio F_x/F_z."},
    {"roughness", "leverage_tool_diameter_force_ratio", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: tool diameter and ratio F_x/F_z."},
    {"roughness", "leverage_axial_depth_force_ratio", "1", "(ZᵀZ)⁻¹ of the tests\' centred logarithms: axial depth and ratio F_x/F_z."},
    {"roughness", "leverage_force_ratio", "1", "(ZᵀZ)⁻¹ of the tests' centred logarithms: ratio F_x/F_z."},

    {"force_sensor", "low_pass_hz", "Hz", "Corner of the low-pass (two poles, Butterworth) that a recorded force sensor's signal went through; 0: not known."},
    {"force_sensor", "zero_drift_sd_N", "N", "Drift of the sensor's zero since its zeroing in air, as a standard deviation."},

    {"force_drop", "e_t_mm", "mm", "Tangential edge force over K_tc, a length: F_t = K a (f_z sin φ + e_t)."},
    {"force_drop", "e_r_mm", "mm", "Radial edge force over K_tc."},
    {"force_drop", "e_t_sd_mm", "mm", "Standard deviation of e_t."},
    {"force_drop", "e_r_sd_mm", "mm", "Standard deviation of e_r."},
    {"force_drop", "a", "1", "r = a r_av + b: force ratio where a tooth leaves, over the average one (Hwang et al. Eq. 12)."},
    {"force_drop", "b", "1", "Constant of the same line."},
    {"force_drop", "a_variance", "1", "Variance of a."},
    {"force_drop", "a_b_covariance", "1", "Covariance of a and b."},
    {"force_drop", "b_variance", "1", "Variance of b."},
    {"force_drop", "r_scatter", "1", "Standard deviation of r about the line, from cut to cut."},
    {"force_drop", "r_av_mean", "1", "Mean of r_av over the calibration cuts."},
    {"force_drop", "r_av_sd", "1", "Standard deviation of r_av over the calibration cuts."},
    {"force_drop", "c_0", "1", "ln(K/K_av) = c_0 + c_1 (1 − immersion) + c_2 ln(f_z/0.15 mm): pressure where a tooth leaves, over the average one."},
    {"force_drop", "c_1", "1", "Change of that ratio with the immersion."},
    {"force_drop", "c_2", "1", "Change of that ratio with the feed per tooth."},
    {"force_drop", "c_0_variance", "1", "Variance of c_0."},
    {"force_drop", "c_0_c_1_covariance", "1", "Covariance of c_0 and c_1."},
    {"force_drop", "c_0_c_2_covariance", "1", "Covariance of c_0 and c_2."},
    {"force_drop", "c_1_variance", "1", "Variance of c_1."},
    {"force_drop", "c_1_c_2_covariance", "1", "Covariance of c_1 and c_2."},
    {"force_drop", "c_2_variance", "1", "Variance of c_2."},
    {"force_drop", "ln_K_scatter", "1", "Standard deviation of ln(K/K_av) about this law, from cut to cut."},
    {"force_drop", "other_step_x_mm", "mm", "Step of the force along the feed at the other edge of the cut, over K a."},
    {"force_drop", "other_step_y_mm", "mm", "Step of the force across the feed at the other edge of the cut, over K a."},
    {"force_drop", "other_slope_x", "1", "Growth of the force along the feed after that step, over K a f_z, per radian."},
    {"force_drop", "other_slope_y", "1", "Growth of the force across the feed after that step, over K a f_z, per radian."},
    {"force_drop", "smallest_immersion", "1", "Smallest immersion of the calibration cuts; no estimate below."},
    {"force_drop", "largest_immersion", "1", "Largest immersion of the calibration cuts; 0: not calibrated, no estimate."},
    {"force_drop", "revolutions", "1", "Revolutions of the spindle per estimate."},

    {"depth_shape", "nominal_axial_depth_mm", "mm", "Axial depth given by the program; depths to 55 % on either side are searched. 0: not known, no estimate."},
    {"depth_shape", "nominal_radial_width_mm", "mm", "Radial width given by the program, used in the same way."},
    {"depth_shape", "feed_per_tooth_mm", "mm", "Feed per tooth, for the shape of the chip; 0: assumed to be far smaller than the radius."},
    {"depth_shape", "revolutions", "1", "Revolutions of the spindle per estimate."},
    {"depth_shape", "tip_angle_deg", "°", "Angle of a tooth's tip at the encoder's zero, with the feed in +x."},
    {"depth_shape", "tip_angle_sd_deg", "°", "Standard deviation of tip_angle_deg; 0: not known, estimated with the depths."},

    {"control", "entry_feed_per_tooth_mm", "mm", "Feed ceiling from contact until the engagement is known.", must_be_given},
    {"control", "air_feed_per_tooth_mm", "mm", "Feed ceiling in air: the feed at which the tool may meet the workpiece.", must_be_given},
    {"control", "max_feed_per_tooth_mm", "mm", "Feed ceiling in cut: what edge and chip space allow.", must_be_given},
    {"control", "highest_programmed_feed_mm_s", "mm/s", "Highest F of the program, which the ceilings before contact hold for; 0: learned as blocks come."},
    {"control", "setpoint_share", "1", "Share of the tooth's limit that steady cutting is held at."},
    {"control", "caution_sd", "1", "Number of standard deviations added to the estimated force on the tooth."},
    {"control", "recovery_per_rev", "1", "Share of the remaining rise that the override makes in one revolution."},
    {"control", "slew_up_per_s", "1/s", "Largest rise of the override per second."},
    {"control", "slew_down_per_s", "1/s", "Largest fall of the override per second."},
    {"control", "entry_revolutions", "1", "Revolutions after contact before the estimate is trusted to raise the feed."},
    {"control", "entry_travel_mm", "mm", "Travel after contact before the estimate is trusted to raise the feed: while the cutter enters, the engagement grows. About the cutter's radius."},
    {"control", "exit_travel_mm", "mm", "Travel without contact before the tool counts as in air."},
    {"control", "contact_force_N", "N", "Smallest mean tangential force that counts as contact; its noise may ask for more."},
    {"control", "contact_significance", "1", "Standard deviations by which the force must also differ from zero to count as contact."},
    {"control", "declared_axial_depth_mm", "mm", "Axial depth given by the program, to 5 %; 0: not known, estimated from the forces alone."},
    {"control", "surge_radial_immersion", "1", "Largest immersion that may come without warning; 0: none does."},
    {"control", "surge_share", "1", "Share of the tooth's limit that an immersion without warning may reach."},
    {"control", "depth_step_ratio", "1", "Largest ratio of two axial depths that may follow each other without warning; 1: the depth never steps. With declared_axial_depth_mm it is 1."},
    {"control", "depth_step_share", "1", "Share of the tooth's limit that such a step may reach: below break_share."},
    {"control", "proven_override", "1", "Override at which this program has run before without breaking a tooth at any contact: what may come without warning holds the feed no lower. 0: not known."},
    {"control", "safe_override", "1", "Override at which no tooth of this program exceeds its limit, in the hardest batch of its material: 1 where its F is such a feed. What may come without warning holds the feed no lower than depth_step_share times that. 0: not known."},
    {"control", "turn_radial_immersion", "1", "Largest immersion that may come after a sharp turn of the path; 0: a turn changes nothing."},
    {"control", "turn_travel_mm", "mm", "Travel after a sharp turn for which turn_radial_immersion is expected."},
    {"control", "overload_share", "1", "Share of the tooth's limit above which a tooth is overloaded: the feed is held and the fault latched."},
    {"control", "overload_revolutions", "1", "Revolutions for which an overload may last, from when a lower override acts on, before the fault latches."},
    {"control", "no_estimate_hold_s", "s", "In cut without an estimate for longer: state hold."},
    {"control", "Ra_limit_um", "µm", "Largest allowed upper bound of the predicted R_a (95 %); the feed is kept low enough for it. 0: none. Needs a [roughness] table with an interval."},
    {"control", "monitor_only", "", "Estimate and watch, but leave the override to the operator."},
});

constexpr auto information_rows = std::to_array<InformationRow>({
    {ParameterFile::machine, "spindle", "torque_residual_rms_Nm", "N·m", "Residual of the spindle's calibration."},

    {ParameterFile::machine, "axis", "friction_residual_rms_A", "A", "Residual of the friction current's fit."},
    {ParameterFile::machine, "axis", "viscous_N_s_per_m", "N·s/m", "Viscous friction of both directions, from position and motor force."},
    {ParameterFile::machine, "axis", "coulomb_N", "N", "Coulomb friction of both directions, from position and motor force."},
    {ParameterFile::machine, "axis", "offset_N", "N", "Force at rest: weight, or a sensor's zero."},
    {ParameterFile::machine, "axis", "directional_mass_kg", "kg", "Moved mass by the fit that keeps the directions apart."},
    {ParameterFile::machine, "axis", "positive_viscous_N_s_per_m", "N·s/m", "Viscous friction travelling in + direction."},
    {ParameterFile::machine, "axis", "negative_viscous_N_s_per_m", "N·s/m", "Viscous friction travelling in - direction."},
    {ParameterFile::machine, "axis", "positive_coulomb_N", "N", "Coulomb friction travelling in + direction."},
    {ParameterFile::machine, "axis", "negative_coulomb_N", "N", "Coulomb friction travelling in - direction."},
    {ParameterFile::machine, "axis", "residual_rms_N", "N", "Residual of the fit of both directions."},

    {ParameterFile::tool, "cutting", "minimum_feed_per_tooth_mm", "mm", "Smallest feed per tooth of the calibration cuts."},
    {ParameterFile::tool, "cutting", "maximum_feed_per_tooth_mm", "mm", "Largest feed per tooth of the calibration cuts."},
    {ParameterFile::tool, "cutting", "cut_side", "", "Side of the calibration cuts; used by `millforce estimate`.", "down|up"},

    {ParameterFile::tool, "roughness", "roughness_at_means_um", "µm", "R at the geometric means of the tests, where the model is most certain."},
    {ParameterFile::tool, "roughness", "determination", "1", "Share of the variance of ln R that the model explains."},
});

constexpr auto text_rows = std::to_array<TextRow>({
    {ParameterFile::machine, "bus.drive", "tpdo1", "not used", "[\"0x6064:32\", …]", "Objects of the drive's TPDO 1 in their order: index, subindex if not 0, bits; up to 8 objects and 64 bits."},
    {ParameterFile::machine, "bus.drive", "tpdo2", "not used", "[\"0x6064:32\", …]", "As tpdo1, of TPDO 2."},
    {ParameterFile::machine, "bus.drive", "tpdo3", "not used", "[\"0x6064:32\", …]", "As tpdo1, of TPDO 3."},
    {ParameterFile::machine, "bus.drive", "tpdo4", "not used", "[\"0x6064:32\", …]", "As tpdo1, of TPDO 4."},
    {ParameterFile::machine, "bus.drive", "count_object", "0x6064", "\"0x6064\"", "Spindle: the object with the encoder's count."},
    {ParameterFile::machine, "bus.drive", "index_count_object", "none", "\"0x60BA\"", "Spindle: the object with the count at the last index pulse."},
    {ParameterFile::machine, "bus.drive", "index_number_object", "none", "\"0x60D5\"", "Spindle: the object that counts the index pulses."},
});
// clang-format on

const ParameterText& text_of(const ParameterName& name) {
    for (const ParameterText& text : parameter_texts) {
        if (text.table == name.table && text.key == name.key) {
            return text;
        }
    }
    throw std::logic_error(fmt::format("{}.{} has no row in the parameter table", name.table, name.key));
}

using Rows = std::array<ParameterRow, parameter_texts.size()>;

Rows complete_rows() {
    Rows rows{};
    std::size_t next = 0;
    const firmware::Parameters<float> defaults;
    firmware::for_each_parameter(
        defaults, [&]<typename Field>(const ParameterName& name, const Field& field, float minimum, float maximum) {
            if (name.place == 0) {
                const ParameterText& text = text_of(name);
                rows.at(next++) = {name.file,     name.table,       name.key,         text.unit,
                                   text.sentence, type_of<Field>(), text.is_required, static_cast<float>(field),
                                   minimum,       maximum,          text.choices};
            }
        });
    if (next != rows.size()) {
        throw std::logic_error("a row of the parameter table has no field");
    }
    return rows;
}

}  // namespace

std::span<const ParameterRow> parameter_table() {
    static const Rows rows = complete_rows();
    return rows;
}

const ParameterRow& row_of(const ParameterName& name) {
    for (const ParameterRow& row : parameter_table()) {
        if (std::string_view(row.table) == name.table && std::string_view(row.key) == name.key) {
            return row;
        }
    }
    throw std::logic_error(fmt::format("no parameter {}.{}", name.table, name.key));
}

std::span<const InformationRow> information_table() {
    return information_rows;
}

std::span<const TextRow> text_table() {
    return text_rows;
}

std::span<const char* const> tables_in_file(const char* const& table) {
    const std::string_view name = table;
    if (name == "axis") {
        return axis_tables;
    }
    return name == "bus.drive" ? std::span<const char* const>(drive_tables) : std::span(&table, 1);
}

}  // namespace millforce::host
