// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters.hpp"

/// Parameters with which a tick runs at once: a three-axis machining centre whose spindle current alone is read, and a
/// carbide end mill Ø10 mm with four teeth in the steel SM45C. They are those of sim/scenarios/machines/vmc.toml and
/// sim/scenarios/tools/endmill_10mm.toml, without feed drives and bus. To try the library and to begin with: another
/// machine needs its own `spindle`, another tool its own geometry, limit and law. `monitor_only` is true, so that the
/// override stays the operator's until it is set to false.

namespace millforce::firmware {

template <typename Scalar>
estimation::SpindleDriveParameters<Scalar> default_spindle() {
    using estimation::literal;
    estimation::SpindleDriveParameters<Scalar> spindle;
    spindle.K_t1_Nm_per_A = literal<Scalar>(0.7L);
    spindle.K_t2_Nm = literal<Scalar>(-0.953L);
    spindle.inertia_kg_m2 = literal<Scalar>(0.004L);
    spindle.base_speed_rad_s = literal<Scalar>(628.3L);
    spindle.idle_torque_sd_Nm = literal<Scalar>(0.4L);
    spindle.idle_walk_Nm_per_sqrt_s = literal<Scalar>(0.004L);
    spindle.warm_up_torque_Nm = literal<Scalar>(0.3329L);
    spindle.warm_up_torque_sd_Nm = literal<Scalar>(0.111L);
    spindle.warm_up_time_s = literal<Scalar>(239.3L);
    spindle.current_sd_A = literal<Scalar>(0.12L);
    return spindle;
}

template <typename Scalar>
estimation::CuttingLaw<Scalar> default_law() {
    using estimation::literal;
    estimation::CuttingLaw<Scalar> law;
    law.k_s_N_per_mm2 = literal<Scalar>(1688.3L);
    law.k_1 = literal<Scalar>(0.4012L);
    law.K_te_N_per_mm = literal<Scalar>(21.73L);
    law.K_re_N_per_mm = literal<Scalar>(27.73L);
    law.K_s_relative_sd = literal<Scalar>(0.15L);
    law.K_s_exponent_sd = literal<Scalar>(0.0386L);
    law.r_1_exponent_sd = literal<Scalar>(0.0443L);
    law.reference_chip_thickness_mm = literal<Scalar>(0.4335L);
    law.minimum_chip_thickness_mm = literal<Scalar>(0.007L);
    law.maximum_chip_thickness_mm = literal<Scalar>(0.1445L);
    return law;
}

template <typename Scalar>
Parameters<Scalar> default_parameters() {
    using estimation::literal;
    Parameters<Scalar> parameters;
    MachineParameters<Scalar>& machine = parameters.machine;
    machine.spindle = default_spindle<Scalar>();
    machine.spindle_rated_current_A = Scalar(12);
    machine.encoder_counts_per_rev = 8192;
    machine.cnc.override_max = Scalar(2);

    ToolParameters<Scalar>& tool = parameters.tool;
    tool.flute_length_mm = Scalar(22);
    tool.side = estimation::CutSide::down;
    tool.runout_um = Scalar(6);
    tool.tooth_force_limit_N = Scalar(700);
    tool.law = default_law<Scalar>();
    tool.control.setpoint_share = literal<Scalar>(0.95L);
    tool.control.entry_feed_per_tooth_mm = literal<Scalar>(0.018L);
    tool.control.air_feed_per_tooth_mm = literal<Scalar>(0.018L);
    tool.control.max_feed_per_tooth_mm = literal<Scalar>(0.2L);
    tool.control.highest_programmed_feed_mm_s = Scalar(25);
    tool.monitor_only = true;
    return parameters;
}

}  // namespace millforce::firmware
