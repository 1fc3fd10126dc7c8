// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/feed_controller.hpp"
#include "estimation/cut_estimate.hpp"
#include "estimation/cutting/cutting_law.hpp"
#include "estimation/drives/feed_drive.hpp"
#include "estimation/drives/spindle_drive.hpp"
#include "estimation/force_drop/force_drop_law.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/surface/roughness.hpp"
#include "hal/drive_wiring.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

/// The parameters of a machine and a tool: plain structures with their defaults, each once, here or in the structures
/// of drives, laws and control that they hold. What is worked out from them has none of its own. Keys and ranges:
/// parameter_fields.hpp. On a host: parameter_table.hpp of the program, with units and sentences.

namespace millforce::firmware {

/// The CNC and its override input.
template <typename Scalar>
struct CncParameters {
    Scalar override_min{estimation::literal<Scalar>(0.1L)};
    Scalar override_max{estimation::literal<Scalar>(1.5L)};
    Scalar override_latency_s{estimation::literal<Scalar>(0.01L)};
    Scalar acceleration_mm_s2{2000};
    Scalar stale_s{estimation::literal<Scalar>(0.05L)};
    Scalar sample_rate_hz{1000};
};

using hal::CurrentBasis;
using hal::CurrentSource;
using hal::VelocitySource;
enum class BusRole : std::uint8_t { listener, master };

/// One drive on the bus. Which objects its PDOs carry is text in machine.toml, and no part of this.
template <typename Scalar>
struct BusDriveParameters {
    std::uint8_t node_id{0};  ///< 0: not on the bus
    CurrentSource current_source{CurrentSource::current};
    CurrentBasis current_basis{CurrentBasis::rms};
    bool current_reversed{false};
    Scalar rated_torque_Nm{0};
    Scalar torque_constant_Nm_per_A{0};
    Scalar largest_share_of_rated{4};
    VelocitySource velocity_source{VelocitySource::velocity};
    Scalar velocity_mm_s_per_unit{0};
    Scalar position_mm_per_unit{0};
    Scalar largest_velocity_mm_s{2000};
    std::uint32_t count_modulus{0};
    std::uint32_t largest_count_step{1048576};
    bool count_reversed{false};
    Scalar heartbeat_timeout_ms{0};
    Scalar heartbeat_period_ms{0};
    bool write_mapping{false};
    Scalar stale_ms{20};
    std::array<std::uint16_t, 4> tpdo_id{};              ///< 0: 0x180 + node_id, 0x280 + node_id …
    std::array<std::uint8_t, 4> tpdo_every{1, 1, 1, 1};  ///< SYNCs; 0: when something changes
};

/// The bus that drives and CNC are on. A machine without one has no drive with a node id.
template <typename Scalar>
struct BusParameters {
    BusRole role{BusRole::listener};
    bool produces_sync{false};
    std::uint16_t sync_id{hal::default_sync_id};
    Scalar sync_period_ms{1};
    Scalar collect_time_ms{estimation::literal<Scalar>(0.8L)};
    std::uint16_t override_id{hal::default_override_id};
    std::uint8_t override_node_id{hal::default_override_node_id};
    Scalar override_period_ms{2};
    Scalar override_heartbeat_ms{100};
    std::uint16_t program_status_id{hal::default_program_status_id};
    Scalar program_status_timeout_ms{100};
    std::array<BusDriveParameters<Scalar>, 4> drives{};  ///< spindle, x, y, z
};

template <typename Scalar>
struct MachineParameters {
    estimation::SpindleDriveParameters<Scalar> spindle{};
    Scalar spindle_rated_current_A{0};
    Scalar spindle_load_period_s{0};
    Scalar spindle_load_age_s{0};
    std::uint32_t encoder_counts_per_rev{4096};
    std::array<estimation::FeedDriveParameters<Scalar>, 3> axes{};
    std::array<Scalar, 3> axis_rated_current_A{};
    CncParameters<Scalar> cnc{};
    BusParameters<Scalar> bus{};
};

/// What happens between the force and the samples of a force sensor.
template <typename Scalar>
struct ForceSensorParameters {
    Scalar low_pass_hz{0};
    Scalar zero_drift_sd_N{0};
};

/// Radial immersion from force drops. The law's `valid` is set by the user of this struct: no largest immersion, no
/// law.
template <typename Scalar>
struct ForceDropParameters {
    estimation::ForceDropLaw<Scalar> law{};
    std::uint16_t revolutions{4};
};

/// Depths of cut from the shape of the force.
template <typename Scalar>
struct DepthShapeParameters {
    Scalar nominal_axial_depth_mm{0};
    Scalar nominal_radial_width_mm{0};
    Scalar feed_per_tooth_mm{0};
    std::uint16_t revolutions{20};
    Scalar tip_angle_deg{0};
    Scalar tip_angle_sd_deg{0};
};

template <typename Scalar>
struct ToolParameters {
    std::uint8_t teeth{4};
    Scalar diameter_mm{10};
    Scalar helix_deg{30};
    Scalar flute_length_mm{20};
    Scalar runout_um{0};
    estimation::CutSide side{estimation::CutSide::unknown};
    Scalar centre_offset_mm{0};
    Scalar tooth_force_limit_N{0};
    Scalar break_share{estimation::literal<Scalar>(1.5L)};
    Scalar declared_axial_depth_mm{0};
    Scalar law_relative_sd{estimation::literal<Scalar>(0.02L)};
    estimation::CuttingLaw<Scalar> law{};
    control::FeedControllerParameters<Scalar> control{};
    bool monitor_only{false};
    estimation::RoughnessModel<Scalar> roughness{};
    ForceSensorParameters<Scalar> force_sensor{};
    ForceDropParameters<Scalar> force_drop{};
    DepthShapeParameters<Scalar> depth_shape{};
};

template <typename Scalar>
struct Parameters {
    MachineParameters<Scalar> machine{};
    ToolParameters<Scalar> tool{};
};

/// What the spindle estimator knows of its drive. A current that comes seldom is the same one for many samples: their
/// mean is no better known than one of them.
template <typename Scalar>
estimation::SpindleDriveParameters<Scalar> spindle_parameters(const MachineParameters<Scalar>& machine) {
    using std::sqrt;
    estimation::SpindleDriveParameters<Scalar> spindle = machine.spindle;
    const Scalar samples = machine.spindle_load_period_s * machine.cnc.sample_rate_hz;
    spindle.current_sd_A *= samples > Scalar(1) ? sqrt(samples) : Scalar(1);
    return spindle;
}

/// How late a spindle current that comes seldom shows a change at the latest.
template <typename Scalar>
Scalar load_delay_s(const MachineParameters<Scalar>& machine) {
    return machine.spindle_load_age_s + machine.spindle_load_period_s;
}

/// From a change of the cut to the first change of the commanded velocity, beside the estimator's own window.
template <typename Scalar>
Scalar reaction_s(const MachineParameters<Scalar>& machine) {
    return machine.cnc.override_latency_s + load_delay_s(machine);
}

/// The tool's law as the estimator takes it. Thin chips cost more: by edge forces, or by a negative exponent. A law
/// that has neither is of constant coefficients, and is given the doubt of what it leaves out. In published linear edge
/// laws of aluminium alloys K_te/K_tc is 0.01…0.036 mm (Chin. J. Mech. Eng. 34 (2021), milling force model for aviation
/// aluminium, Table 5): at chips of 0.1 mm K_s is 10…30 % and r_1 some 40 % larger than without edges, at thinner ones
/// more.
template <typename Scalar>
estimation::CuttingLaw<Scalar> estimator_law(const ToolParameters<Scalar>& tool) {
    using estimation::literal;
    estimation::CuttingLaw<Scalar> law = tool.law;
    const bool is_constant = law.p_s == Scalar(0) && law.p_1 == Scalar(0) && law.K_te_N_per_mm == Scalar(0) &&
                             law.K_re_N_per_mm == Scalar(0);
    const auto raise = [](Scalar& sd, Scalar least) { sd = sd < least ? least : sd; };
    if (is_constant) {
        raise(law.K_s_relative_sd, literal<Scalar>(0.2L));
        raise(law.K_s_exponent_sd, literal<Scalar>(0.4L));
        raise(law.r_1_relative_sd, literal<Scalar>(0.3L));
        raise(law.r_1_exponent_sd, literal<Scalar>(0.5L));
        law.reference_chip_thickness_mm = literal<Scalar>(0.1L);
    }
    return law;
}

/// The spindle's acceleration costs torque, and the encoder's counts leave it open: in a window of T by some
/// 4 (2π/counts)/T². A small tool in a heavy spindle needs a longer window, so that this stays a small share of what
/// its tooth carries. The samples of that window.
template <typename Scalar>
Scalar least_samples(const Parameters<Scalar>& p) {
    using std::sqrt;
    constexpr Scalar share_of_limit = estimation::literal<Scalar>(0.04L);
    constexpr Scalar mm_per_m{1000};
    const Scalar counts = Scalar(static_cast<int>(p.machine.encoder_counts_per_rev));
    const Scalar radius_mm = estimation::halved(p.tool.diameter_mm);
    const Scalar tolerated_N = share_of_limit * p.tool.tooth_force_limit_N;
    if (!(counts > Scalar(0)) || !(radius_mm > Scalar(0)) || !(tolerated_N > Scalar(0))) {
        return Scalar(0);
    }
    const Scalar inertia_kg_m = p.machine.spindle.inertia_kg_m2 * mm_per_m / radius_mm;
    return p.machine.cnc.sample_rate_hz *
           sqrt(inertia_kg_m * (Scalar(4) * estimation::turn_rad<Scalar> / counts) / tolerated_N);
}

/// Settings of the estimator, worked out from the parameters.
template <typename Scalar>
estimation::CutEstimatorSettings<Scalar> estimator_settings(const Parameters<Scalar>& p) {
    estimation::CutEstimatorSettings<Scalar> s;
    const Scalar radius_mm = p.tool.diameter_mm * Scalar(0.5F);
    s.teeth = Scalar(p.tool.teeth);
    s.cutter_radius_mm = radius_mm;
    s.helix_rad = p.tool.helix_deg * estimation::pi<Scalar> / Scalar(180);
    s.runout_mm = p.tool.runout_um * estimation::literal<Scalar>(0.001L);
    s.side = p.tool.side;
    s.centre_offset_in_radii = p.tool.centre_offset_mm / radius_mm;
    s.largest_depth_mm = p.tool.flute_length_mm;
    s.nominal_feed_per_tooth_mm = p.tool.control.entry_feed_per_tooth_mm;
    s.surge_immersion = p.tool.control.surge_radial_immersion;
    s.turn_immersion = p.tool.control.turn_radial_immersion;
    s.tooth_force_limit_N = p.tool.tooth_force_limit_N;
    s.declared_depth_mm = p.tool.declared_axial_depth_mm;
    s.law_relative_sd = p.tool.law_relative_sd;
    s.encoder_counts_per_rev = p.machine.encoder_counts_per_rev;
    s.load_is_held = p.machine.spindle_load_period_s > Scalar(0);
    const Scalar samples = least_samples(p);
    s.min_samples = samples > s.min_samples ? samples : s.min_samples;
    return s;
}

/// Parameters of the controller: the tool's, with the machine's limits.
template <typename Scalar>
control::FeedControllerParameters<Scalar> controller_parameters(const Parameters<Scalar>& p) {
    control::FeedControllerParameters<Scalar> c = p.tool.control;
    c.tooth_force_limit_N = p.tool.tooth_force_limit_N;
    c.teeth = Scalar(p.tool.teeth);
    c.override_min = p.machine.cnc.override_min;
    c.override_max = p.machine.cnc.override_max;
    c.stale_s = p.machine.cnc.stale_s;
    c.reaction_s = reaction_s(p.machine);
    c.monitor_only = p.tool.monitor_only;
    if (p.tool.declared_axial_depth_mm > Scalar(0)) {
        c.depth_step_ratio = Scalar(1);
    }
    return c;
}

}  // namespace millforce::firmware
