// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters.hpp"

#include <array>
#include <limits>

/// One description of every parameter: file, table and key as in TOML, unit, default, range, one sentence.
/// The TOML reader, the documentation and a target's flash block are made from it, in this order.

namespace millforce::firmware {

enum class ParameterFile : unsigned char { machine, tool };

/// A default of `required` means that there is none: the file must give the value.
inline constexpr float required = std::numeric_limits<float>::quiet_NaN();

template <typename Scalar>
struct ParameterRow {
    ParameterFile file;
    const char* table;  ///< "axis" stands for each of "x", "y", "z"; "bus.drive" for each of "bus.spindle", "bus.x" …
    const char* key;
    const char* unit;
    float default_value;
    float minimum;
    float maximum;
    const char* sentence;
    Scalar& (*field)(Parameters<Scalar>&, std::size_t axis);
    const char* choices = nullptr;  ///< names for the values 0, 1, … in place of numbers, separated by '|'
};

inline constexpr std::array<const char*, 3> axis_tables{"x", "y", "z"};
inline constexpr std::array<const char*, 4> drive_tables{"bus.spindle", "bus.x", "bus.y", "bus.z"};

// The rows are data; one row a line keeps them readable as the table that they are.
// clang-format off
// NOLINTBEGIN(bugprone-macro-parentheses): a lambda is one expression already
#define MILLFORCE_FIELD(member) [](Parameters<Scalar>& p, std::size_t) -> Scalar& { return p.member; }
#define MILLFORCE_AXIS(member) [](Parameters<Scalar>& p, std::size_t axis) -> Scalar& { return p.machine.axes[axis].member; }
#define MILLFORCE_DRIVE(member) [](Parameters<Scalar>& p, std::size_t drive) -> Scalar& { return p.machine.bus.drives[drive].member; }

// NOLINTEND(bugprone-macro-parentheses)

template <typename Scalar>
inline constexpr auto parameter_table = std::to_array<ParameterRow<Scalar>>({
    {ParameterFile::machine, "spindle", "K_t1_Nm_per_A", "N·m/A", required, 1e-4F, 1e4F, "Spindle torque per ampere below base speed: the paper's K_t1 times the cutter radius.", MILLFORCE_FIELD(machine.spindle.K_t1_Nm_per_A)},
    {ParameterFile::machine, "spindle", "K_t2_Nm", "N·m", 0.0F, -1e4F, 1e4F, "Torque at zero current, minus K_t1 times the idle current; re-zeroed in air.", MILLFORCE_FIELD(machine.spindle.K_t2_Nm)},
    {ParameterFile::machine, "spindle", "idle_torque_slope_Nm_s", "N·m·s/rad", 0.0F, -10.0F, 10.0F, "Growth of the idle torque with speed.", MILLFORCE_FIELD(machine.spindle.idle_torque_slope_Nm_s)},
    {ParameterFile::machine, "spindle", "inertia_kg_m2", "kg·m²", 0.0F, 0.0F, 100.0F, "Inertia of spindle, rotor and tool.", MILLFORCE_FIELD(machine.spindle.inertia_kg_m2)},
    {ParameterFile::machine, "spindle", "base_speed_rad_s", "rad/s", 0.0F, 0.0F, 2e4F, "Speed above which the torque constant falls as 1/speed (field weakening); 0: never.", MILLFORCE_FIELD(machine.spindle.base_speed_rad_s)},
    {ParameterFile::machine, "spindle", "gain_relative_sd", "1", 0.02F, 0.0F, 1.0F, "Relative standard deviation of K_t1 from its calibration.", MILLFORCE_FIELD(machine.spindle.gain_relative_sd)},
    {ParameterFile::machine, "spindle", "idle_torque_sd_Nm", "N·m", 0.2F, 0.0F, 1e3F, "Standard deviation of the idle torque before the first re-zeroing in air.", MILLFORCE_FIELD(machine.spindle.idle_torque_sd_Nm)},
    {ParameterFile::machine, "spindle", "idle_walk_Nm_per_sqrt_s", "N·m/√s", 0.01F, 0.0F, 1e2F, "Drift of the idle torque beside the warm-up, as a random walk.", MILLFORCE_FIELD(machine.spindle.idle_walk_Nm_per_sqrt_s)},
    {ParameterFile::machine, "spindle", "warm_up_torque_Nm", "N·m", 0.0F, -1e3F, 1e3F, "Idle torque of the cold spindle above that of the warm one, at working speed.", MILLFORCE_FIELD(machine.spindle.warm_up_torque_Nm)},
    {ParameterFile::machine, "spindle", "warm_up_torque_sd_Nm", "N·m", 0.0F, 0.0F, 1e3F, "Its standard deviation; the spindle may be half warm when the controller starts.", MILLFORCE_FIELD(machine.spindle.warm_up_torque_sd_Nm)},
    {ParameterFile::machine, "spindle", "warm_up_time_s", "s", 0.0F, 0.0F, 1e5F, "Time constant with which the spindle warms up; 0: not known.", MILLFORCE_FIELD(machine.spindle.warm_up_time_s)},
    {ParameterFile::machine, "spindle", "current_sd_A", "A", 0.1F, 0.0F, 1e3F, "Noise of one sample of the spindle current.", MILLFORCE_FIELD(machine.spindle.current_sd_A)},
    {ParameterFile::machine, "spindle", "rated_current_A", "A", 0.0F, 0.0F, 1e4F, "Rated current, the unit of CiA 402 object 0x6078; 0: not known.", MILLFORCE_FIELD(machine.spindle_rated_current_A)},
    {ParameterFile::machine, "spindle", "encoder_counts_per_rev", "1", 4096.0F, 16.0F, 1048576.0F, "Counts of the spindle encoder per revolution, after quadrature.", MILLFORCE_FIELD(machine.encoder_counts_per_rev)},

    {ParameterFile::machine, "axis", "K_x1_positive_A_min2_per_m2", "A/(m/min)²", 0.0F, -1e3F, 1e3F, "Friction current travelling in + direction, quadratic term.", MILLFORCE_AXIS(positive.K_x1_A_min2_per_m2)},
    {ParameterFile::machine, "axis", "K_x2_positive_A_min_per_m", "A/(m/min)", 0.0F, -1e3F, 1e3F, "Friction current travelling in + direction, linear term.", MILLFORCE_AXIS(positive.K_x2_A_min_per_m)},
    {ParameterFile::machine, "axis", "K_x1_negative_A_min2_per_m2", "A/(m/min)²", 0.0F, -1e3F, 1e3F, "Magnitude of the friction current travelling in - direction, quadratic term.", MILLFORCE_AXIS(negative.K_x1_A_min2_per_m2)},
    {ParameterFile::machine, "axis", "K_x2_negative_A_min_per_m", "A/(m/min)", 0.0F, -1e3F, 1e3F, "Magnitude of the friction current travelling in - direction, linear term.", MILLFORCE_AXIS(negative.K_x2_A_min_per_m)},
    {ParameterFile::machine, "axis", "K_x3_A", "A", 0.0F, -1e3F, 1e3F, "Friction current, constant term, of both directions.", MILLFORCE_AXIS(K_x3_A)},
    {ParameterFile::machine, "axis", "gravity_A", "A", 0.0F, -1e3F, 1e3F, "Current that holds the axis against its weight, with half the difference of the directions' constant friction.", MILLFORCE_AXIS(gravity_A)},
    {ParameterFile::machine, "axis", "K_x4_N_per_A", "N/A", 0.0F, 0.0F, 1e5F, "Force per ampere of feed motor current; 0: this axis gives no force.", MILLFORCE_AXIS(K_x4_N_per_A)},
    {ParameterFile::machine, "axis", "K_x5_N_m_per_min", "N·m/min", 0.0F, -1e5F, 1e5F, "Force term K_x5/w of the feed drive (Kim & Chung Eq. 10).", MILLFORCE_AXIS(K_x5_N_m_per_min)},
    {ParameterFile::machine, "axis", "mass_kg", "kg", 0.0F, 0.0F, 1e5F, "Moved mass, with the motor's inertia reflected.", MILLFORCE_AXIS(mass_kg)},
    {ParameterFile::machine, "axis", "velocity_floor_mm_s", "mm/s", 1.0F, 0.01F, 1e3F, "Below it the axis gives no estimate: friction is undefined at rest.", MILLFORCE_AXIS(velocity_floor_mm_s)},
    {ParameterFile::machine, "axis", "gain_relative_sd", "1", 0.03F, 0.0F, 1.0F, "Relative standard deviation of K_x4 from its calibration.", MILLFORCE_AXIS(gain_relative_sd)},
    {ParameterFile::machine, "axis", "friction_relative_sd", "1", 0.2F, 0.0F, 2.0F, "Relative standard deviation of the friction before the first re-zeroing in air.", MILLFORCE_AXIS(friction_relative_sd)},
    {ParameterFile::machine, "axis", "friction_walk_per_sqrt_s", "1/√s", 0.002F, 0.0F, 1.0F, "Drift of the friction, relative, as a random walk.", MILLFORCE_AXIS(friction_walk_per_sqrt_s)},
    {ParameterFile::machine, "axis", "friction_ripple_A", "A", 0.05F, 0.0F, 1e2F, "Part of the friction that depends on position and that no average removes.", MILLFORCE_AXIS(friction_ripple_A)},
    {ParameterFile::machine, "axis", "current_sd_A", "A", 0.1F, 0.0F, 1e3F, "Noise of one sample of the motor current.", MILLFORCE_AXIS(current_sd_A)},
    {ParameterFile::machine, "axis", "rated_current_A", "A", 0.0F, 0.0F, 1e4F, "Rated current, the unit of CiA 402 object 0x6078; 0: not known.", [](Parameters<Scalar>& p, std::size_t axis) -> Scalar& { return p.machine.axis_rated_current_A[axis]; }},

    {ParameterFile::machine, "cnc", "override_min", "1", 0.1F, 0.0F, 1.0F, "Smallest feed override that the controller commands.", MILLFORCE_FIELD(machine.cnc.override_min)},
    {ParameterFile::machine, "cnc", "override_max", "1", 1.5F, 0.1F, 9.0F, "Largest feed override that the CNC accepts.", MILLFORCE_FIELD(machine.cnc.override_max)},
    {ParameterFile::machine, "cnc", "override_latency_s", "s", 0.01F, 0.0F, 1.0F, "Time from an override to the first change of the commanded velocity.", MILLFORCE_FIELD(machine.cnc.override_latency_s)},
    {ParameterFile::machine, "cnc", "acceleration_mm_s2", "mm/s²", 2000.0F, 1.0F, 1e6F, "Acceleration limit of the path velocity.", MILLFORCE_FIELD(machine.cnc.acceleration_mm_s2)},
    {ParameterFile::machine, "cnc", "stale_s", "s", 0.05F, 0.001F, 10.0F, "Without a drive sample for longer the controller faults and holds the feed.", MILLFORCE_FIELD(machine.cnc.stale_s)},
    {ParameterFile::machine, "cnc", "sample_rate_hz", "Hz", 1000.0F, 10.0F, 1e5F, "Rate of the drive samples.", MILLFORCE_FIELD(machine.cnc.sample_rate_hz)},

    {ParameterFile::machine, "bus", "role", "", 0.0F, 0.0F, 1.0F, "Master: reads rated values, writes what is asked to and starts the drives (SDO, NMT). Listener: sends none of it, the CNC is the master.", MILLFORCE_FIELD(machine.bus.role), "listener|master"},
    {ParameterFile::machine, "bus", "produces_sync", "", 0.0F, 0.0F, 1.0F, "Send SYNC; else the CNC or a drive does.", MILLFORCE_FIELD(machine.bus.produces_sync), "false|true"},
    {ParameterFile::machine, "bus", "sync_id", "", 128.0F, 1.0F, 2047.0F, "CAN id of SYNC.", MILLFORCE_FIELD(machine.bus.sync_id)},
    {ParameterFile::machine, "bus", "sync_period_ms", "ms", 1.0F, 0.1F, 1000.0F, "Time between two SYNCs, and so between two samples.", MILLFORCE_FIELD(machine.bus.sync_period_ms)},
    {ParameterFile::machine, "bus", "collect_time_ms", "ms", 0.8F, 0.01F, 1000.0F, "What has not come by then after a SYNC is missing in its sample; at most the period.", MILLFORCE_FIELD(machine.bus.collect_time_ms)},
    {ParameterFile::machine, "bus", "override_id", "", 510.0F, 1.0F, 2047.0F, "CAN id of the override frame.", MILLFORCE_FIELD(machine.bus.override_id)},
    {ParameterFile::machine, "bus", "override_node_id", "", 126.0F, 1.0F, 127.0F, "CANopen node as which this controller gives its heartbeat.", MILLFORCE_FIELD(machine.bus.override_node_id)},
    {ParameterFile::machine, "bus", "override_period_ms", "ms", 2.0F, 0.5F, 1000.0F, "Time between two override frames.", MILLFORCE_FIELD(machine.bus.override_period_ms)},
    {ParameterFile::machine, "bus", "override_heartbeat_ms", "ms", 100.0F, 1.0F, 10000.0F, "Time between two of its heartbeats.", MILLFORCE_FIELD(machine.bus.override_heartbeat_ms)},
    {ParameterFile::machine, "bus", "program_status_id", "", 509.0F, 0.0F, 2047.0F, "CAN id of the frame in which the CNC tells F, rapid and hold; 0: the CNC tells nothing, and the override stays at its minimum.", MILLFORCE_FIELD(machine.bus.program_status_id)},
    {ParameterFile::machine, "bus", "program_status_timeout_ms", "ms", 100.0F, 1.0F, 10000.0F, "A CNC that told its status and is silent for longer has the feed held.", MILLFORCE_FIELD(machine.bus.program_status_timeout_ms)},

    {ParameterFile::machine, "bus.drive", "node_id", "", 0.0F, 0.0F, 127.0F, "CANopen node of the drive; 0: this drive is not on the bus.", MILLFORCE_DRIVE(node_id)},
    {ParameterFile::machine, "bus.drive", "current_source", "", 0.0F, 0.0F, 1.0F, "What the current is worked out of: 0x6078 (current), or 0x6077 (torque) over the torque constant.", MILLFORCE_DRIVE(current_source), "current|torque"},
    {ParameterFile::machine, "bus.drive", "current_basis", "", 0.0F, 0.0F, 1.0F, "What the drive means by its rated current.", MILLFORCE_DRIVE(current_basis), "rms|peak"},
    {ParameterFile::machine, "bus.drive", "current_reversed", "", 0.0F, 0.0F, 1.0F, "The drive counts the current against the machine axis.", MILLFORCE_DRIVE(current_reversed), "false|true"},
    {ParameterFile::machine, "bus.drive", "rated_torque_Nm", "N·m", 0.0F, 0.0F, 1e6F, "Unit of 0x6077; 0: read from 0x6076. Of the current: rated_current_A in the drive's own table; 0 there: read from 0x6075.", MILLFORCE_DRIVE(rated_torque_Nm)},
    {ParameterFile::machine, "bus.drive", "torque_constant_Nm_per_A", "N·m/A", 0.0F, 0.0F, 1e4F, "Of the motor, for current_source = \"torque\".", MILLFORCE_DRIVE(torque_constant_Nm_per_A)},
    {ParameterFile::machine, "bus.drive", "largest_share_of_rated", "1", 4.0F, 0.01F, 32.0F, "Current or torque beyond it, over the rated one, is not used.", MILLFORCE_DRIVE(largest_share_of_rated)},
    {ParameterFile::machine, "bus.drive", "velocity_source", "", 0.0F, 0.0F, 1.0F, "Axes: 0x606C (velocity), or the difference of 0x6064 between two SYNCs (position).", MILLFORCE_DRIVE(velocity_source), "velocity|position"},
    {ParameterFile::machine, "bus.drive", "velocity_mm_s_per_unit", "mm/s", 0.0F, -1e4F, 1e4F, "Unit of 0x606C; negative: the drive counts against the machine axis.", MILLFORCE_DRIVE(velocity_mm_s_per_unit)},
    {ParameterFile::machine, "bus.drive", "position_mm_per_unit", "mm", 0.0F, -1e4F, 1e4F, "Unit of 0x6064; with both units the two are compared. 0: not told.", MILLFORCE_DRIVE(position_mm_per_unit)},
    {ParameterFile::machine, "bus.drive", "largest_velocity_mm_s", "mm/s", 2000.0F, 0.1F, 1e5F, "A velocity beyond it is not used.", MILLFORCE_DRIVE(largest_velocity_mm_s)},
    {ParameterFile::machine, "bus.drive", "count_modulus", "1", 0.0F, 0.0F, 16777216.0F, "Spindle: counts after which the object begins again at 0; 0: the object's width.", MILLFORCE_DRIVE(count_modulus)},
    {ParameterFile::machine, "bus.drive", "largest_count_step", "1", 1048576.0F, 1.0F, 16777216.0F, "Spindle: a step of more counts per SYNC is not used.", MILLFORCE_DRIVE(largest_count_step)},
    {ParameterFile::machine, "bus.drive", "count_reversed", "", 0.0F, 0.0F, 1.0F, "Spindle: the count falls in the cutting direction (M3).", MILLFORCE_DRIVE(count_reversed), "false|true"},
    {ParameterFile::machine, "bus.drive", "heartbeat_timeout_ms", "ms", 0.0F, 0.0F, 60000.0F, "A drive silent for longer is lost; 0: its heartbeat is not watched.", MILLFORCE_DRIVE(heartbeat_timeout_ms)},
    {ParameterFile::machine, "bus.drive", "heartbeat_period_ms", "ms", 0.0F, 0.0F, 60000.0F, "A master writes it to 0x1017; 0: left as it is.", MILLFORCE_DRIVE(heartbeat_period_ms)},
    {ParameterFile::machine, "bus.drive", "write_mapping", "", 0.0F, 0.0F, 1.0F, "A master writes tpdo1 … tpdo4 to the drive; else it is mapped so already.", MILLFORCE_DRIVE(write_mapping), "false|true"},
    {ParameterFile::machine, "bus.drive", "stale_ms", "ms", 20.0F, 0.0F, 10000.0F, "Age up to which a PDO that does not come at every SYNC is used.", MILLFORCE_DRIVE(stale_ms)},
    {ParameterFile::machine, "bus.drive", "tpdo1_id", "", 0.0F, 0.0F, 1407.0F, "CAN id of TPDO 1; 0: 0x180 + node_id.", MILLFORCE_DRIVE(tpdo_id[0])},
    {ParameterFile::machine, "bus.drive", "tpdo2_id", "", 0.0F, 0.0F, 1407.0F, "CAN id of TPDO 2; 0: 0x280 + node_id.", MILLFORCE_DRIVE(tpdo_id[1])},
    {ParameterFile::machine, "bus.drive", "tpdo3_id", "", 0.0F, 0.0F, 1407.0F, "CAN id of TPDO 3; 0: 0x380 + node_id.", MILLFORCE_DRIVE(tpdo_id[2])},
    {ParameterFile::machine, "bus.drive", "tpdo4_id", "", 0.0F, 0.0F, 1407.0F, "CAN id of TPDO 4; 0: 0x480 + node_id.", MILLFORCE_DRIVE(tpdo_id[3])},
    {ParameterFile::machine, "bus.drive", "tpdo1_every", "", 1.0F, 0.0F, 240.0F, "TPDO 1 comes at every so-many-th SYNC; 0: when something changes.", MILLFORCE_DRIVE(tpdo_every[0])},
    {ParameterFile::machine, "bus.drive", "tpdo2_every", "", 1.0F, 0.0F, 240.0F, "TPDO 2 comes at every so-many-th SYNC; 0: when something changes.", MILLFORCE_DRIVE(tpdo_every[1])},
    {ParameterFile::machine, "bus.drive", "tpdo3_every", "", 1.0F, 0.0F, 240.0F, "TPDO 3 comes at every so-many-th SYNC; 0: when something changes.", MILLFORCE_DRIVE(tpdo_every[2])},
    {ParameterFile::machine, "bus.drive", "tpdo4_every", "", 1.0F, 0.0F, 240.0F, "TPDO 4 comes at every so-many-th SYNC; 0: when something changes.", MILLFORCE_DRIVE(tpdo_every[3])},

    {ParameterFile::tool, "tool", "teeth", "1", required, 1.0F, 12.0F, "Number of teeth or inserts.", MILLFORCE_FIELD(tool.teeth)},
    {ParameterFile::tool, "tool", "diameter_mm", "mm", required, 0.1F, 1000.0F, "Cutting diameter.", MILLFORCE_FIELD(tool.diameter_mm)},
    {ParameterFile::tool, "tool", "helix_deg", "°", 30.0F, 0.0F, 60.0F, "Helix angle of the flutes; 0 for inserts.", MILLFORCE_FIELD(tool.helix_deg)},
    {ParameterFile::tool, "tool", "flute_length_mm", "mm", required, 0.1F, 300.0F, "Longest axial depth that the tool can cut.", MILLFORCE_FIELD(tool.flute_length_mm)},
    {ParameterFile::tool, "tool", "runout_um", "µm", 0.0F, 0.0F, 500.0F, "Largest difference between the radii of two teeth.", MILLFORCE_FIELD(tool.runout_um)},
    {ParameterFile::tool, "tool", "side", "", 3.0F, 0.0F, 3.0F, "Which edge of the cut is fixed while its width varies; unknown: inferred from the forces.", MILLFORCE_FIELD(tool.side), "down|up|centred|unknown"},
    {ParameterFile::tool, "tool", "centre_offset_mm", "mm", 0.0F, -500.0F, 500.0F, "Offset of the workpiece's centre line from the cutter's axis, for side = \"centred\".", MILLFORCE_FIELD(tool.centre_offset_mm)},
    {ParameterFile::tool, "tool", "tooth_force_limit_N", "N", required, 0.1F, 1e6F, "F_tooth,max: the largest in-plane force that one tooth may carry.", MILLFORCE_FIELD(tool.tooth_force_limit_N)},
    {ParameterFile::tool, "tool", "break_share", "1", 1.5F, 1.0F, 10.0F, "A tooth breaks at this multiple of its limit (simulation).", MILLFORCE_FIELD(tool.break_share)},

    {ParameterFile::tool, "cutting", "k_s_N_per_mm2", "N/mm²", required, 1.0F, 1e6F, "K_s at a mean chip thickness of 1 mm: K_s = k_s t_a^p_s.", MILLFORCE_FIELD(tool.law.k_s_N_per_mm2)},
    {ParameterFile::tool, "cutting", "p_s", "1", 0.0F, -0.95F, 0.5F, "Exponent of K_s over the mean chip thickness.", MILLFORCE_FIELD(tool.law.p_s)},
    {ParameterFile::tool, "cutting", "k_1", "1", required, -10.0F, 10.0F, "r_1 = F_r/F_t at a mean chip thickness of 1 mm: r_1 = k_1 t_a^p_1.", MILLFORCE_FIELD(tool.law.k_1)},
    {ParameterFile::tool, "cutting", "p_1", "1", 0.0F, -2.0F, 1.0F, "Exponent of r_1 over the mean chip thickness.", MILLFORCE_FIELD(tool.law.p_1)},
    {ParameterFile::tool, "cutting", "K_te_N_per_mm", "N/mm", 0.0F, -1e4F, 1e4F, "Tangential edge force per length of edge.", MILLFORCE_FIELD(tool.law.K_te_N_per_mm)},
    {ParameterFile::tool, "cutting", "K_re_N_per_mm", "N/mm", 0.0F, -1e4F, 1e4F, "Radial edge force per length of edge.", MILLFORCE_FIELD(tool.law.K_re_N_per_mm)},
    {ParameterFile::tool, "cutting", "K_s_relative_sd", "1", 0.05F, 0.0F, 2.0F, "Standard deviation of ln K_s at the reference chip thickness.", MILLFORCE_FIELD(tool.law.K_s_relative_sd)},
    {ParameterFile::tool, "cutting", "K_s_exponent_sd", "1", 0.0F, 0.0F, 2.0F, "Its growth per unit of ln(t_a/t_ref).", MILLFORCE_FIELD(tool.law.K_s_exponent_sd)},
    {ParameterFile::tool, "cutting", "r_1_relative_sd", "1", 0.05F, 0.0F, 2.0F, "Standard deviation of ln r_1 at the reference chip thickness.", MILLFORCE_FIELD(tool.law.r_1_relative_sd)},
    {ParameterFile::tool, "cutting", "r_1_exponent_sd", "1", 0.0F, 0.0F, 2.0F, "Its growth per unit of ln(t_a/t_ref).", MILLFORCE_FIELD(tool.law.r_1_exponent_sd)},
    {ParameterFile::tool, "cutting", "reference_chip_thickness_mm", "mm", 0.0F, 0.0F, 10.0F, "Chip thickness at which the calibration knew most; 0: the doubt does not grow.", MILLFORCE_FIELD(tool.law.reference_chip_thickness_mm)},
    {ParameterFile::tool, "cutting", "minimum_chip_thickness_mm", "mm", 0.0F, 0.0F, 10.0F, "Thinnest mean chip of the calibration cuts.", MILLFORCE_FIELD(tool.law.minimum_chip_thickness_mm)},
    {ParameterFile::tool, "cutting", "maximum_chip_thickness_mm", "mm", 0.0F, 0.0F, 10.0F, "Thickest mean chip of the calibration cuts; 0: not told.", MILLFORCE_FIELD(tool.law.maximum_chip_thickness_mm)},
    {ParameterFile::tool, "cutting", "law_relative_sd", "1", 0.02F, 0.0F, 1.0F, "Misfit of the law itself, relative to the tangential force.", MILLFORCE_FIELD(tool.law_relative_sd)},

    {ParameterFile::tool, "roughness", "measure", "", 0.0F, 0.0F, 1.0F, "Which roughness the model predicts: R_a or R_z.", MILLFORCE_FIELD(tool.roughness.measure), "Ra|Rz"},
    {ParameterFile::tool, "roughness", "constant_um", "µm", 0.0F, 0.0F, 1e30F, "C of R = C V^a f^b φ^c D^d ρ^e (V rpm, f mm/rev, φ and D mm, ρ = F_x/F_z); 0: no model, no prediction.", MILLFORCE_FIELD(tool.roughness.constant_um)},
    {ParameterFile::tool, "roughness", "spindle_speed_exponent", "1", 0.0F, -50.0F, 50.0F, "Exponent of the spindle speed.", MILLFORCE_FIELD(tool.roughness.exponent[0])},
    {ParameterFile::tool, "roughness", "feed_exponent", "1", 0.0F, -50.0F, 50.0F, "Exponent of the feed per revolution.", MILLFORCE_FIELD(tool.roughness.exponent[1])},
    {ParameterFile::tool, "roughness", "tool_diameter_exponent", "1", 0.0F, -50.0F, 50.0F, "Exponent of the tool diameter.", MILLFORCE_FIELD(tool.roughness.exponent[2])},
    {ParameterFile::tool, "roughness", "axial_depth_exponent", "1", 0.0F, -50.0F, 50.0F, "Exponent of the axial depth.", MILLFORCE_FIELD(tool.roughness.exponent[3])},
    {ParameterFile::tool, "roughness", "force_ratio_exponent", "1", 0.0F, -50.0F, 50.0F, "Exponent of the ratio F_x/F_z.", MILLFORCE_FIELD(tool.roughness.exponent[4])},
    {ParameterFile::tool, "roughness", "spindle_speed_minimum_rpm", "1/min", 0.0F, 0.0F, 1e6F, "Smallest spindle speed of the tests.", MILLFORCE_FIELD(tool.roughness.minimum[0])},
    {ParameterFile::tool, "roughness", "spindle_speed_maximum_rpm", "1/min", 0.0F, 0.0F, 1e6F, "Largest spindle speed of the tests; 0: not told.", MILLFORCE_FIELD(tool.roughness.maximum[0])},
    {ParameterFile::tool, "roughness", "spindle_speed_mean_rpm", "1/min", 0.0F, 0.0F, 1e6F, "Geometric mean of the tests' spindle speed; 0: no interval.", MILLFORCE_FIELD(tool.roughness.reference[0])},
    {ParameterFile::tool, "roughness", "feed_minimum_mm_rev", "mm/rev", 0.0F, 0.0F, 1e3F, "Smallest feed per revolution of the tests.", MILLFORCE_FIELD(tool.roughness.minimum[1])},
    {ParameterFile::tool, "roughness", "feed_maximum_mm_rev", "mm/rev", 0.0F, 0.0F, 1e3F, "Largest feed per revolution of the tests; 0: not told.", MILLFORCE_FIELD(tool.roughness.maximum[1])},
    {ParameterFile::tool, "roughness", "feed_mean_mm_rev", "mm/rev", 0.0F, 0.0F, 1e3F, "Geometric mean of the tests' feed per revolution; 0: no interval.", MILLFORCE_FIELD(tool.roughness.reference[1])},
    {ParameterFile::tool, "roughness", "tool_diameter_minimum_mm", "mm", 0.0F, 0.0F, 1e3F, "Smallest tool diameter of the tests.", MILLFORCE_FIELD(tool.roughness.minimum[2])},
    {ParameterFile::tool, "roughness", "tool_diameter_maximum_mm", "mm", 0.0F, 0.0F, 1e3F, "Largest tool diameter of the tests; 0: not told.", MILLFORCE_FIELD(tool.roughness.maximum[2])},
    {ParameterFile::tool, "roughness", "tool_diameter_mean_mm", "mm", 0.0F, 0.0F, 1e3F, "Geometric mean of the tests' tool diameter; 0: no interval.", MILLFORCE_FIELD(tool.roughness.reference[2])},
    {ParameterFile::tool, "roughness", "axial_depth_minimum_mm", "mm", 0.0F, 0.0F, 1e3F, "Smallest axial depth of the tests.", MILLFORCE_FIELD(tool.roughness.minimum[3])},
    {ParameterFile::tool, "roughness", "axial_depth_maximum_mm", "mm", 0.0F, 0.0F, 1e3F, "Largest axial depth of the tests; 0: not told.", MILLFORCE_FIELD(tool.roughness.maximum[3])},
    {ParameterFile::tool, "roughness", "axial_depth_mean_mm", "mm", 0.0F, 0.0F, 1e3F, "Geometric mean of the tests' axial depth; 0: no interval.", MILLFORCE_FIELD(tool.roughness.reference[3])},
    {ParameterFile::tool, "roughness", "force_ratio_minimum", "1", 0.0F, 0.0F, 1e4F, "Smallest ratio F_x/F_z of the tests.", MILLFORCE_FIELD(tool.roughness.minimum[4])},
    {ParameterFile::tool, "roughness", "force_ratio_maximum", "1", 0.0F, 0.0F, 1e4F, "Largest ratio F_x/F_z of the tests; 0: not told.", MILLFORCE_FIELD(tool.roughness.maximum[4])},
    {ParameterFile::tool, "roughness", "force_ratio_mean", "1", 0.0F, 0.0F, 1e4F, "Geometric mean of the tests' ratio F_x/F_z; 0: no interval.", MILLFORCE_FIELD(tool.roughness.reference[4])},
    {ParameterFile::tool, "roughness", "tests", "1", 0.0F, 0.0F, 1e6F, "Number of tests n; 0: no interval.", MILLFORCE_FIELD(tool.roughness.tests)},
    {ParameterFile::tool, "roughness", "degrees_of_freedom", "1", 0.0F, 0.0F, 1e6F, "Tests minus parameters, n − p; 0: no interval.", MILLFORCE_FIELD(tool.roughness.degrees_of_freedom)},
    {ParameterFile::tool, "roughness", "residual_ln_sd", "1", 0.0F, 0.0F, 10.0F, "Standard deviation of ln R about the model; 0: no interval.", MILLFORCE_FIELD(tool.roughness.residual_ln_sd)},
    {ParameterFile::tool, "roughness", "largest_leverage", "1", 0.0F, 0.0F, 1.0F, "Largest leverage of a test; beyond it a cut lies outside of the fitted range. 0: not told.", MILLFORCE_FIELD(tool.roughness.largest_leverage)},
    {ParameterFile::tool, "roughness", "leverage_spindle_speed", "1", 0.0F, 0.0F, 1e9F, "(ZᵀZ)⁻¹ of the tests' centred logarithms: spindle speed.", MILLFORCE_FIELD(tool.roughness.leverage[0])},
    {ParameterFile::tool, "roughness", "leverage_spindle_speed_feed", "1", 0.0F, -1e9F, 1e9F, "… spindle speed and feed per revolution.", MILLFORCE_FIELD(tool.roughness.leverage[1])},
    {ParameterFile::tool, "roughness", "leverage_feed", "1", 0.0F, 0.0F, 1e9F, "(ZᵀZ)⁻¹ of the tests' centred logarithms: feed per revolution.", MILLFORCE_FIELD(tool.roughness.leverage[2])},
    {ParameterFile::tool, "roughness", "leverage_spindle_speed_tool_diameter", "1", 0.0F, -1e9F, 1e9F, "… spindle speed and tool diameter.", MILLFORCE_FIELD(tool.roughness.leverage[3])},
    {ParameterFile::tool, "roughness", "leverage_feed_tool_diameter", "1", 0.0F, -1e9F, 1e9F, "… feed per revolution and tool diameter.", MILLFORCE_FIELD(tool.roughness.leverage[4])},
    {ParameterFile::tool, "roughness", "leverage_tool_diameter", "1", 0.0F, 0.0F, 1e9F, "(ZᵀZ)⁻¹ of the tests' centred logarithms: tool diameter.", MILLFORCE_FIELD(tool.roughness.leverage[5])},
    {ParameterFile::tool, "roughness", "leverage_spindle_speed_axial_depth", "1", 0.0F, -1e9F, 1e9F, "… spindle speed and axial depth.", MILLFORCE_FIELD(tool.roughness.leverage[6])},
    {ParameterFile::tool, "roughness", "leverage_feed_axial_depth", "1", 0.0F, -1e9F, 1e9F, "… feed per revolution and axial depth.", MILLFORCE_FIELD(tool.roughness.leverage[7])},
    {ParameterFile::tool, "roughness", "leverage_tool_diameter_axial_depth", "1", 0.0F, -1e9F, 1e9F, "… tool diameter and axial depth.", MILLFORCE_FIELD(tool.roughness.leverage[8])},
    {ParameterFile::tool, "roughness", "leverage_axial_depth", "1", 0.0F, 0.0F, 1e9F, "(ZᵀZ)⁻¹ of the tests' centred logarithms: axial depth.", MILLFORCE_FIELD(tool.roughness.leverage[9])},
    {ParameterFile::tool, "roughness", "leverage_spindle_speed_force_ratio", "1", 0.0F, -1e9F, 1e9F, "… spindle speed and ratio F_x/F_z.", MILLFORCE_FIELD(tool.roughness.leverage[10])},
    {ParameterFile::tool, "roughness", "leverage_feed_force_ratio", "1", 0.0F, -1e9F, 1e9F, "… feed per revolution and ratio F_x/F_z.", MILLFORCE_FIELD(tool.roughness.leverage[11])},
    {ParameterFile::tool, "roughness", "leverage_tool_diameter_force_ratio", "1", 0.0F, -1e9F, 1e9F, "… tool diameter and ratio F_x/F_z.", MILLFORCE_FIELD(tool.roughness.leverage[12])},
    {ParameterFile::tool, "roughness", "leverage_axial_depth_force_ratio", "1", 0.0F, -1e9F, 1e9F, "… axial depth and ratio F_x/F_z.", MILLFORCE_FIELD(tool.roughness.leverage[13])},
    {ParameterFile::tool, "roughness", "leverage_force_ratio", "1", 0.0F, 0.0F, 1e9F, "(ZᵀZ)⁻¹ of the tests' centred logarithms: ratio F_x/F_z.", MILLFORCE_FIELD(tool.roughness.leverage[14])},

    {ParameterFile::tool, "force_sensor", "low_pass_hz", "Hz", 0.0F, 0.0F, 1e5F, "Corner of the low-pass (two poles, Butterworth) that a recorded force sensor's signal went through; 0: not told.", MILLFORCE_FIELD(tool.force_sensor.low_pass_hz)},
    {ParameterFile::tool, "force_sensor", "zero_drift_sd_N", "N", 0.0F, 0.0F, 1e4F, "Drift of the sensor's zero since its zeroing in air, as a standard deviation.", MILLFORCE_FIELD(tool.force_sensor.zero_drift_sd_N)},

    {ParameterFile::tool, "force_drop", "e_t_mm", "mm", 0.0F, -1.0F, 1.0F, "Tangential edge force over K_tc, a length: F_t = K a (f_z sin φ + e_t).", MILLFORCE_FIELD(tool.force_drop.law.e_t_mm)},
    {ParameterFile::tool, "force_drop", "e_r_mm", "mm", 0.0F, -1.0F, 1.0F, "Radial edge force over K_tc.", MILLFORCE_FIELD(tool.force_drop.law.e_r_mm)},
    {ParameterFile::tool, "force_drop", "e_t_sd_mm", "mm", 0.0F, 0.0F, 1.0F, "Standard deviation of e_t.", MILLFORCE_FIELD(tool.force_drop.law.e_t_sd_mm)},
    {ParameterFile::tool, "force_drop", "e_r_sd_mm", "mm", 0.0F, 0.0F, 1.0F, "Standard deviation of e_r.", MILLFORCE_FIELD(tool.force_drop.law.e_r_sd_mm)},
    {ParameterFile::tool, "force_drop", "a", "1", 1.0F, -10.0F, 10.0F, "r = a r_av + b: force ratio where a tooth leaves, over the average one (Hwang et al. Eq. 12).", MILLFORCE_FIELD(tool.force_drop.law.a)},
    {ParameterFile::tool, "force_drop", "b", "1", 0.0F, -10.0F, 10.0F, "Its constant.", MILLFORCE_FIELD(tool.force_drop.law.b)},
    {ParameterFile::tool, "force_drop", "a_variance", "1", 0.0F, 0.0F, 100.0F, "Variance of a.", MILLFORCE_FIELD(tool.force_drop.law.a_b_covariance(0, 0))},
    {ParameterFile::tool, "force_drop", "a_b_covariance", "1", 0.0F, -100.0F, 100.0F, "Covariance of a and b.", MILLFORCE_FIELD(tool.force_drop.law.a_b_covariance(0, 1))},
    {ParameterFile::tool, "force_drop", "b_variance", "1", 0.0F, 0.0F, 100.0F, "Variance of b.", MILLFORCE_FIELD(tool.force_drop.law.a_b_covariance(1, 1))},
    {ParameterFile::tool, "force_drop", "r_scatter", "1", 0.0F, 0.0F, 10.0F, "Standard deviation of r about the line, cut from cut.", MILLFORCE_FIELD(tool.force_drop.law.r_scatter)},
    {ParameterFile::tool, "force_drop", "r_av_mean", "1", 0.0F, -10.0F, 10.0F, "Mean of r_av over the calibration cuts.", MILLFORCE_FIELD(tool.force_drop.law.r_av_mean)},
    {ParameterFile::tool, "force_drop", "r_av_sd", "1", 0.0F, 0.0F, 10.0F, "How r_av varied among them.", MILLFORCE_FIELD(tool.force_drop.law.r_av_sd)},
    {ParameterFile::tool, "force_drop", "c_0", "1", 0.0F, -10.0F, 10.0F, "ln(K/K_av) = c_0 + c_1 (1 − immersion) + c_2 ln(f_z/0.15 mm): pressure where a tooth leaves, over the average one.", MILLFORCE_FIELD(tool.force_drop.law.c(0))},
    {ParameterFile::tool, "force_drop", "c_1", "1", 0.0F, -10.0F, 10.0F, "… its change with the immersion.", MILLFORCE_FIELD(tool.force_drop.law.c(1))},
    {ParameterFile::tool, "force_drop", "c_2", "1", 0.0F, -10.0F, 10.0F, "… its change with the feed per tooth.", MILLFORCE_FIELD(tool.force_drop.law.c(2))},
    {ParameterFile::tool, "force_drop", "c_0_variance", "1", 0.0F, 0.0F, 100.0F, "Variance of c_0.", MILLFORCE_FIELD(tool.force_drop.law.c_covariance(0, 0))},
    {ParameterFile::tool, "force_drop", "c_0_c_1_covariance", "1", 0.0F, -100.0F, 100.0F, "Covariance of c_0 and c_1.", MILLFORCE_FIELD(tool.force_drop.law.c_covariance(0, 1))},
    {ParameterFile::tool, "force_drop", "c_0_c_2_covariance", "1", 0.0F, -100.0F, 100.0F, "Covariance of c_0 and c_2.", MILLFORCE_FIELD(tool.force_drop.law.c_covariance(0, 2))},
    {ParameterFile::tool, "force_drop", "c_1_variance", "1", 0.0F, 0.0F, 100.0F, "Variance of c_1.", MILLFORCE_FIELD(tool.force_drop.law.c_covariance(1, 1))},
    {ParameterFile::tool, "force_drop", "c_1_c_2_covariance", "1", 0.0F, -100.0F, 100.0F, "Covariance of c_1 and c_2.", MILLFORCE_FIELD(tool.force_drop.law.c_covariance(1, 2))},
    {ParameterFile::tool, "force_drop", "c_2_variance", "1", 0.0F, 0.0F, 100.0F, "Variance of c_2.", MILLFORCE_FIELD(tool.force_drop.law.c_covariance(2, 2))},
    {ParameterFile::tool, "force_drop", "ln_K_scatter", "1", 0.0F, 0.0F, 10.0F, "Standard deviation of ln(K/K_av) about it, cut from cut.", MILLFORCE_FIELD(tool.force_drop.law.ln_K_scatter)},
    {ParameterFile::tool, "force_drop", "other_step_x_mm", "mm", 0.0F, -10.0F, 10.0F, "Step of the force along the feed at the other edge of the cut, over K a.", MILLFORCE_FIELD(tool.force_drop.law.other_step_x_mm)},
    {ParameterFile::tool, "force_drop", "other_step_y_mm", "mm", 0.0F, -10.0F, 10.0F, "… across the feed.", MILLFORCE_FIELD(tool.force_drop.law.other_step_y_mm)},
    {ParameterFile::tool, "force_drop", "other_slope_x", "1", 0.0F, -100.0F, 100.0F, "Growth of the force along the feed after it, over K a f_z, per radian.", MILLFORCE_FIELD(tool.force_drop.law.other_slope_x)},
    {ParameterFile::tool, "force_drop", "other_slope_y", "1", 0.0F, -100.0F, 100.0F, "… across the feed.", MILLFORCE_FIELD(tool.force_drop.law.other_slope_y)},
    {ParameterFile::tool, "force_drop", "smallest_immersion", "1", 0.1F, 0.05F, 0.9F, "Smallest immersion of the calibration cuts; no estimate below.", MILLFORCE_FIELD(tool.force_drop.law.smallest_immersion)},
    {ParameterFile::tool, "force_drop", "largest_immersion", "1", 0.0F, 0.0F, 0.95F, "Largest immersion of the calibration cuts; 0: not calibrated, no estimate.", MILLFORCE_FIELD(tool.force_drop.law.largest_immersion)},
    {ParameterFile::tool, "force_drop", "revolutions", "1", 4.0F, 1.0F, 100.0F, "Revolutions of the spindle per estimate.", MILLFORCE_FIELD(tool.force_drop.revolutions)},

    {ParameterFile::tool, "depth_shape", "nominal_axial_depth_mm", "mm", 0.0F, 0.0F, 300.0F, "Axial depth that the program tells; depths to 55 % on either side are searched. 0: not told, no estimate.", MILLFORCE_FIELD(tool.depth_shape.nominal_axial_depth_mm)},
    {ParameterFile::tool, "depth_shape", "nominal_radial_width_mm", "mm", 0.0F, 0.0F, 1000.0F, "Radial width that the program tells, likewise.", MILLFORCE_FIELD(tool.depth_shape.nominal_radial_width_mm)},
    {ParameterFile::tool, "depth_shape", "feed_per_tooth_mm", "mm", 0.0F, 0.0F, 10.0F, "Feed per tooth, for the shape of the chip; 0: taken as far below the radius.", MILLFORCE_FIELD(tool.depth_shape.feed_per_tooth_mm)},
    {ParameterFile::tool, "depth_shape", "revolutions", "1", 20.0F, 1.0F, 1000.0F, "Revolutions of the spindle per estimate.", MILLFORCE_FIELD(tool.depth_shape.revolutions)},
    {ParameterFile::tool, "depth_shape", "tip_angle_deg", "°", 0.0F, 0.0F, 360.0F, "Angle of a tooth's tip at the encoder's zero, with the feed in +x.", MILLFORCE_FIELD(tool.depth_shape.tip_angle_deg)},
    {ParameterFile::tool, "depth_shape", "tip_angle_sd_deg", "°", 0.0F, 0.0F, 90.0F, "Its standard deviation; 0: not known, found with the depths.", MILLFORCE_FIELD(tool.depth_shape.tip_angle_sd_deg)},

    {ParameterFile::tool, "control", "entry_feed_per_tooth_mm", "mm", required, 1e-4F, 10.0F, "Feed ceiling from contact until the engagement is known.", MILLFORCE_FIELD(tool.control.entry_feed_per_tooth_mm)},
    {ParameterFile::tool, "control", "air_feed_per_tooth_mm", "mm", required, 1e-4F, 10.0F, "Feed ceiling in air: the feed at which the tool may meet the workpiece.", MILLFORCE_FIELD(tool.control.air_feed_per_tooth_mm)},
    {ParameterFile::tool, "control", "max_feed_per_tooth_mm", "mm", required, 1e-4F, 10.0F, "Feed ceiling in cut: what edge and chip space allow.", MILLFORCE_FIELD(tool.control.max_feed_per_tooth_mm)},
    {ParameterFile::tool, "control", "highest_programmed_feed_mm_s", "mm/s", 0.0F, 0.0F, 1e4F, "Highest F of the program, which the ceilings before contact hold for; 0: learnt as blocks come.", MILLFORCE_FIELD(tool.control.highest_programmed_feed_mm_s)},
    {ParameterFile::tool, "control", "setpoint_share", "1", 0.97F, 0.1F, 1.0F, "Share of the tooth's limit that steady cutting is held at.", MILLFORCE_FIELD(tool.control.setpoint_share)},
    {ParameterFile::tool, "control", "caution_sd", "1", 0.75F, 0.0F, 4.0F, "Standard deviations of the tooth's force that are counted on top of it.", MILLFORCE_FIELD(tool.control.caution_sd)},
    {ParameterFile::tool, "control", "recovery_per_rev", "1", 0.25F, 0.001F, 1.0F, "Share of the way up that the override goes in one revolution.", MILLFORCE_FIELD(tool.control.recovery_per_rev)},
    {ParameterFile::tool, "control", "slew_up_per_s", "1/s", 2.0F, 0.001F, 1e3F, "Largest rise of the override per second.", MILLFORCE_FIELD(tool.control.slew_up_per_s)},
    {ParameterFile::tool, "control", "slew_down_per_s", "1/s", 40.0F, 0.001F, 1e4F, "Largest fall of the override per second.", MILLFORCE_FIELD(tool.control.slew_down_per_s)},
    {ParameterFile::tool, "control", "entry_revolutions", "1", 2.0F, 0.0F, 100.0F, "Revolutions after contact before the estimate is trusted to raise the feed.", MILLFORCE_FIELD(tool.control.entry_revolutions)},
    {ParameterFile::tool, "control", "entry_travel_mm", "mm", 5.0F, 0.0F, 1e3F, "Travel after contact before that: while the cutter enters, the engagement grows. About the cutter's radius.", MILLFORCE_FIELD(tool.control.entry_travel_mm)},
    {ParameterFile::tool, "control", "exit_travel_mm", "mm", 2.0F, 0.0F, 1e3F, "Travel without contact before the tool counts as in air.", MILLFORCE_FIELD(tool.control.exit_travel_mm)},
    {ParameterFile::tool, "control", "contact_force_N", "N", 40.0F, 0.01F, 1e5F, "Mean tangential force that counts as contact.", MILLFORCE_FIELD(tool.control.contact_force_N)},
    {ParameterFile::tool, "control", "contact_significance", "1", 4.0F, 0.0F, 100.0F, "… and by how many standard deviations.", MILLFORCE_FIELD(tool.control.contact_significance)},
    {ParameterFile::tool, "control", "declared_axial_depth_mm", "mm", 0.0F, 0.0F, 300.0F, "Axial depth that the program tells, to 5 %; 0: not told, estimated from the forces alone.", MILLFORCE_FIELD(tool.declared_axial_depth_mm)},
    {ParameterFile::tool, "control", "surge_radial_immersion", "1", 0.0F, 0.0F, 2.0F, "Largest immersion that may come without warning; 0: none does.", MILLFORCE_FIELD(tool.control.surge_radial_immersion)},
    {ParameterFile::tool, "control", "surge_share", "1", 1.03F, 0.1F, 2.0F, "Share of the tooth's limit that such a surge may reach.", MILLFORCE_FIELD(tool.control.surge_share)},
    {ParameterFile::tool, "control", "turn_radial_immersion", "1", 2.0F, 0.0F, 2.0F, "Largest immersion that may come after a sharp turn of the path; 0: a turn changes nothing.", MILLFORCE_FIELD(tool.control.turn_radial_immersion)},
    {ParameterFile::tool, "control", "turn_travel_mm", "mm", 2.0F, 0.0F, 1000.0F, "Travel after a sharp turn for which that is expected.", MILLFORCE_FIELD(tool.control.turn_travel_mm)},
    {ParameterFile::tool, "control", "overload_share", "1", 1.35F, 1.0F, 10.0F, "Share of the tooth's limit above which the feed is held and the fault latched.", MILLFORCE_FIELD(tool.control.overload_share)},
    {ParameterFile::tool, "control", "overload_revolutions", "1", 3.0F, 0.0F, 1e3F, "… when it lasts for so many revolutions though the override falls.", MILLFORCE_FIELD(tool.control.overload_revolutions)},
    {ParameterFile::tool, "control", "no_estimate_hold_s", "s", 0.5F, 0.0F, 60.0F, "In cut without an estimate for longer: state hold.", MILLFORCE_FIELD(tool.control.no_estimate_hold_s)},
    {ParameterFile::tool, "control", "Ra_limit_um", "µm", 0.0F, 0.0F, 1e3F, "Upper bound of the predicted R_a (95 %) that the feed is held down for; 0: none. Needs a [roughness] table with an interval.", MILLFORCE_FIELD(tool.control.Ra_limit_um)},
    {ParameterFile::tool, "control", "monitor_only", "", 0.0F, 0.0F, 1.0F, "Estimate and watch, but leave the override to the operator.", MILLFORCE_FIELD(tool.monitor_only), "false|true"},
});

#undef MILLFORCE_FIELD
#undef MILLFORCE_AXIS
#undef MILLFORCE_DRIVE

/// Keys that a calibration writes for the reader of the file, not for the controller: they are checked and ignored.
/// A numeric key of either table may also have a companion KEY_se, the standard error of its fit.
struct InformationRow {
    ParameterFile file;
    const char* table;  ///< as in ParameterRow
    const char* key;
    const char* unit;
    const char* sentence;
    const char* choices = nullptr;  ///< as in ParameterRow
};

inline constexpr auto information_table = std::to_array<InformationRow>({
    {ParameterFile::machine, "spindle", "torque_residual_rms_Nm", "N·m", "Residual of the spindle's calibration."},

    {ParameterFile::machine, "axis", "friction_residual_rms_A", "A", "Residual of the friction current's fit."},
    {ParameterFile::machine, "axis", "viscous_N_s_per_m", "N·s/m", "Viscous friction of both directions, from position and motor force."},
    {ParameterFile::machine, "axis", "coulomb_N", "N", "Coulomb friction of both directions, likewise."},
    {ParameterFile::machine, "axis", "offset_N", "N", "Force at rest: weight, or a sensor's zero."},
    {ParameterFile::machine, "axis", "directional_mass_kg", "kg", "Moved mass by the fit that keeps the directions apart."},
    {ParameterFile::machine, "axis", "positive_viscous_N_s_per_m", "N·s/m", "Viscous friction travelling in + direction."},
    {ParameterFile::machine, "axis", "negative_viscous_N_s_per_m", "N·s/m", "Viscous friction travelling in - direction."},
    {ParameterFile::machine, "axis", "positive_coulomb_N", "N", "Coulomb friction travelling in + direction."},
    {ParameterFile::machine, "axis", "negative_coulomb_N", "N", "Coulomb friction travelling in - direction."},
    {ParameterFile::machine, "axis", "residual_rms_N", "N", "Residual of that fit."},

    {ParameterFile::tool, "cutting", "minimum_feed_per_tooth_mm", "mm", "Smallest feed per tooth of the calibration cuts."},
    {ParameterFile::tool, "cutting", "maximum_feed_per_tooth_mm", "mm", "Largest feed per tooth of the calibration cuts."},
    {ParameterFile::tool, "cutting", "cut_side", "", "Side that the calibration cuts were milled on; `millforce estimate` takes it.", "down|up"},

    {ParameterFile::tool, "roughness", "roughness_at_means_um", "µm", "R at the geometric means of the tests, where the model knows it best."},
    {ParameterFile::tool, "roughness", "determination", "1", "Share of the variance of ln R that the model explains."},
});

/// Keys whose value is no number but names objects of a drive: "INDEX" or "INDEX.SUBINDEX", in a PDO with ":BITS".
struct TextRow {
    ParameterFile file;
    const char* table;  ///< as in ParameterRow
    const char* key;
    const char* default_text;
    const char* form;
    const char* sentence;
};

inline constexpr auto text_table = std::to_array<TextRow>({
    {ParameterFile::machine, "bus.drive", "tpdo1", "not used", "[\"0x6064:32\", …]", "Objects of the drive's TPDO 1 in their order: index, subindex where it is not 0, bits; up to 8 of them and 64 bits."},
    {ParameterFile::machine, "bus.drive", "tpdo2", "not used", "[\"0x6064:32\", …]", "… of TPDO 2."},
    {ParameterFile::machine, "bus.drive", "tpdo3", "not used", "[\"0x6064:32\", …]", "… of TPDO 3."},
    {ParameterFile::machine, "bus.drive", "tpdo4", "not used", "[\"0x6064:32\", …]", "… of TPDO 4."},
    {ParameterFile::machine, "bus.drive", "count_object", "0x6064", "\"0x6064\"", "Spindle: the object with the encoder's count."},
    {ParameterFile::machine, "bus.drive", "index_count_object", "none", "\"0x60BA\"", "Spindle: the object with the count at the last index pulse."},
    {ParameterFile::machine, "bus.drive", "index_number_object", "none", "\"0x60D5\"", "Spindle: the object that counts the index pulses."},
});
// clang-format on

}  // namespace millforce::firmware
