// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace millforce::sim {

/// The bottom ("chisel") edge of a flat mill: orthogonal cutting (Guan et al., section 3.2).
///
/// The paper prints the section as a_p a_e, and neither τ_s nor the section of its example. Here the section is the
/// chip thickness at the tip times `width_mm`, the length of bottom edge behind the corner that cuts.
struct BottomEdge {
    double shear_stress_N_mm2 = 0.0;  ///< τ_s > 0
    double chip_compression = 1.8;    ///< Λ, chip thickness over uncut thickness, 1…10
    double friction_angle_rad = 0.0;  ///< β_f, 0…60°
    double rake_rad = 0.0;            ///< γ, −30°…45°
    double width_mm = 0.0;            ///< > 0, at most the radius
};

/// Force of a bottom edge along the cutting velocity, and along the axis downwards on the workpiece.
struct BottomEdgeForce {
    double cutting_N = 0.0;
    double thrust_N = 0.0;
};

/// Throws InputError with one line that names the field, its value and what was expected.
void validate(const BottomEdge& edge, double cutter_radius_mm);

/// φ_c from the compression of the chip: cot φ_c = −tan γ + Λ/cos γ.
double orthogonal_shear_angle_rad(double rake_rad, double chip_compression);

/// F = τ_s A / (sin φ_c cos(φ_c + β_f − γ)), A the uncut section.
double orthogonal_resultant_N(const BottomEdge& edge, double section_mm2);

/// The resultant's components: F cos(β_f − γ) along the cutting velocity, F sin(β_f − γ) along the axis.
BottomEdgeForce orthogonal_components(const BottomEdge& edge, double resultant_N);

}  // namespace millforce::sim
