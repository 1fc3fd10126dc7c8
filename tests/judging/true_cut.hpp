// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

/// The force of a straight cut, by integration of the law along the cutting edges: the truth that the estimates are
/// held against. It shares no code and no equation with `estimation` (closed averages) or `sim` (oblique cutting): in
/// double, slice by slice, from the geometry alone.
///
/// A tool that turns clockwise (M3) travels along +t; +l is to its left. A point of the edge at the angle φ from +l,
/// clockwise, moves along (cos φ, −sin φ) in (t, l), presses the workpiece with F_t that way and with F_r outwards
/// along (sin φ, cos φ). Its chip is h = f_z sin φ + (radius now − radius of the tooth before); F_t = K_s h + K_te and
/// F_r = r_1 K_s h + K_re per length of edge, with K_s and r_1 powers of h. Up milling engages φ = 0…Θ, down milling π
/// − Θ…π, cos Θ = 1 − R_r.

namespace millforce::judging {

struct TrueLaw {
    double reference_chip_mm = 0.1;
    double K_s_N_per_mm2 = 0.0;  ///< at the reference chip
    double K_s_exponent = 0.0;   ///< of the chip's thickness
    double r_1 = 0.0;            ///< at the reference chip
    double r_1_exponent = 0.0;
    double K_te_N_per_mm = 0.0;
    double K_re_N_per_mm = 0.0;
};

struct TrueCut {
    TrueLaw law;
    int teeth = 4;
    double radius_mm = 5.0;
    double helix_rad = 0.0;
    double eccentricity_mm = 0.0;  ///< of the tool's axis: the teeth's radii differ by it
    bool is_up = false;
    double radial_immersion = 1.0;  ///< a_e/R, 0…2
    double axial_depth_mm = 1.0;
    double feed_per_tooth_mm = 0.05;
};

/// At one angle of the tool.
struct MomentaryForce {
    double torque_Nm = 0.0;
    double feed_N = 0.0;  ///< on the workpiece, along the travel
    double left_N = 0.0;
    double largest_tooth_N = 0.0;  ///< in-plane force of the tooth that carries most
};

/// `ahead_mm`: from the tool's axis to the face of the workpiece that it enters; far negative: it is all inside.
MomentaryForce momentary_force(const TrueCut& cut, double tool_angle_rad, double ahead_mm);

/// Largest in-plane force of one tooth over a revolution.
double peak_tooth_force_N(const TrueCut& cut);

/// The feed per tooth at which the peak is `limit_N`, up to `most_mm`.
double feed_per_tooth_at_limit_mm(TrueCut cut, double limit_N, double most_mm);

}  // namespace millforce::judging
