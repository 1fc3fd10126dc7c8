// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cutting/cutting_coefficients.hpp"

namespace millforce::sim {

/// What oblique cutting needs to know about material and edge. Angles in rad, all in the plane normal to the edge where
/// the field measures them there (shear, rake); friction on the rake face; inclination i = helix angle.
/// Valid: shear stress > 0, 0 < φ_n < 90°, 0 ≤ β_a < 85°, |α_n| < 60°, 0 ≤ i ≤ 70°, φ_n + β_n − α_n < 90°.
struct ObliqueCut {
    double shear_stress_N_mm2 = 0.0;  ///< τ_s
    double shear_angle_rad = 0.0;     ///< φ_n
    double friction_angle_rad = 0.0;  ///< β_a
    double rake_rad = 0.0;            ///< α_n
    double inclination_rad = 0.0;     ///< i
};

/// K_tc, K_rc, K_ac in closed form, chip flow by Stabler's rule (chip flow angle η = i), tan β_n = tan β_a cos η:
///   K_tc = τ_s [cos(β_n − α_n) + tan i tan η sin β_n] / (c sin φ_n)
///   K_rc = τ_s sin(β_n − α_n) / (c sin φ_n cos i)
///   K_ac = τ_s [cos(β_n − α_n) tan i − tan η sin β_n] / (c sin φ_n),  c² = cos²(φ_n + β_n − α_n) + tan²η sin²β_n,
/// per axial width of cut (edge length times cos i). The edge coefficients stay 0. Throws InputError outside the
/// ranges above.
CuttingCoefficients oblique_cutting(const ObliqueCut& cut);

/// The directions of the resultant (θ_n in the normal plane, θ_i out of it) and of shear (φ_i out of the normal plane).
struct ObliqueAngles {
    double theta_n_rad = 0.0;
    double theta_i_rad = 0.0;
    double phi_i_rad = 0.0;
};

/// The angles that Guan et al. leave open. θ_n = β_n − α_n and sin θ_i = sin β_a sin η, with η = i (Stabler), follow
/// from friction on the rake face; shear runs along the force in the shear plane, tan φ_i = tan θ_i / cos(θ_n + φ_n).
ObliqueAngles oblique_angles(const ObliqueCut& cut);

/// Components of the force on one edge element: dF_c along the cutting velocity, dF_f normal to the machined surface,
/// dF_p along the axis. Guan et al.'s dF_p is the force on the TOOL along +z: on the workpiece it is −dF_p.
struct ObliqueForce {
    double cutting_N = 0.0;
    double feed_N = 0.0;
    double passive_N = 0.0;
};

/// Guan et al. Eqs. 1–4: the resultant
///   F = τ_s b h / {[cos(θ_n + φ_n) cos θ_i cos φ_i + sin θ_i sin φ_i] cos i sin φ_n}
/// and its components. The paper's text under Eq. 1 mixes up the names: i is the inclination of the edge, θ_i the
/// inclination of the resultant out of the normal plane. b the axial width, h the chip thickness.
ObliqueForce oblique_force(const ObliqueCut& cut, const ObliqueAngles& angles, double width_mm,
                           double chip_thickness_mm);

}  // namespace millforce::sim
