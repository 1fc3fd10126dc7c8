// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The cutting force of a helical end mill a second time, by brute force: the judge of the plant (sim/cutting), of
/// which it uses nothing. It is slow and simple on purpose.
///
/// - The chip is where the ray from the axis meets the path of the tooth before, found on that path by bisection.
/// - The force on an edge element comes from vectors: the tool pushes along the normal of its rake face and rubs along
///   the chip's flow (Stabler: as inclined as the edge); its part in the shear plane is τ_s times the sheared area.
/// - Each edge is clipped to the arc [φ_st, φ_ex] and summed in equal steps; the average over a tooth pitch is a sum in
///   equal steps between the angles where an edge's end enters or leaves.
///
/// Straight cut, equal teeth, no runout, no edge forces. Angles as everywhere: from +y, clockwise, x = feed; forces on
/// the workpiece.

namespace millforce::sim {

/// Shear of a material on an edge. All angles in rad, in the plane normal to the edge; friction on the rake face.
struct ShearedEdge {
    double shear_stress_N_mm2;
    double shear_angle_rad;
    double friction_angle_rad;
    double rake_rad;
};

struct FineCut {
    int teeth;
    double radius_mm;
    double helix_rad;
    double axial_depth_mm;
    double feed_per_tooth_mm;
    double entry_rad;  ///< φ_st
    double exit_rad;   ///< φ_ex
    ShearedEdge flank;
    ShearedEdge bottom;
    double bottom_width_mm;  ///< length of bottom edge in cut; 0: none
};

struct FineForce {
    double fx_N = 0.0;
    double fy_N = 0.0;
    double fz_N = 0.0;
    double torque_Nm = 0.0;
};

/// h of a tooth at φ behind its predecessor's true path, in mm; never negative.
double fine_chip_mm(const FineCut& cut, double phi_rad);

/// At one angle of tooth 0's tip; each edge in `axial_steps` elements.
FineForce fine_force(const FineCut& cut, double spindle_angle_rad, int axial_steps);

/// Over a tooth pitch; `angle_steps` between two angles at which an end of an edge enters or leaves.
FineForce fine_average(const FineCut& cut, int angle_steps, int axial_steps);

/// φ_c of an orthogonal cut whose chip is `compression` times as thick as it was, from the velocities' triangle by
/// bisection.
double fine_shear_angle_rad(double rake_rad, double compression);

}  // namespace millforce::sim
