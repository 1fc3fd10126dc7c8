// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

namespace millforce::sim {

enum class CutterType : unsigned char {
    end_mill,       ///< edges on a cylinder
    face_mill,      ///< straight inserts under the lead angle κ; κ = 90° is a shoulder mill
    ball_end_mill,  ///< edges on a half sphere, then on a cylinder above it
};

/// A milling cutter's geometry. Right-hand rotation (clockwise seen from the spindle), right-hand helix.
///
/// Tooth 0 is at the spindle's angle; tooth k follows it at `tooth_position_rad`. At height z an edge lags its own tip
/// by ψ(z) = z tan β / R (Guan et al., section 3), on a ball end as well (constant lead).
struct Cutter {
    static constexpr std::size_t max_teeth = 12;

    CutterType type = CutterType::end_mill;
    std::size_t teeth = 4;          ///< N, 1…12
    double diameter_mm = 10.0;      ///< D, at the tip for a face mill; 0.1…1000
    double flute_length_mm = 20.0;  ///< no force is counted above this height; 0.01…500
    double helix_rad = 0.0;         ///< β, 0…70°; for a face mill the insert's axial inclination
    double rake_rad = 0.0;  ///< normal rake, −60°…60°; data for `oblique_cutting`, the force does not use it
    double lead_angle_rad = std::numbers::pi / 2.0;  ///< κ of face-mill inserts, 10°…90°; 90° for the others
    double runout_mm = 0.0;  ///< e ≥ 0, distance of the cutter's axis from the spindle's (parallel eccentricity); < R/2
    double runout_angle_rad = 0.0;  ///< from tooth 0's tip to the eccentricity, towards tooth 1 (against the rotation)
    /// Angle from tooth k to tooth k + 1, the last one back to tooth 0; together 2π. All zero: equal pitch 2π/N.
    std::array<double, max_teeth> tooth_pitch_rad{};
};

/// Throws InputError with one line that names the field, its value and what was expected.
void validate(const Cutter& cutter);

/// Whether all teeth have the pitch 2π/N.
bool has_equal_pitch(const Cutter& cutter);

/// Angle by which tooth k follows tooth 0, 0…2π.
double tooth_position_rad(const Cutter& cutter, std::size_t tooth);

/// ψ(z) = z tan β / R.
double helix_lag_rad(const Cutter& cutter, double height_mm);

/// Radius of the cutter's body at a height, without runout: R; R + z cot κ; √(R² − (R − z)²) below a ball's equator.
double local_radius_mm(const Cutter& cutter, double height_mm);

/// Angle between the axis-normal plane and the chip's width: 90° on a cylinder, κ on inserts, acos(1 − z/R) on a ball.
double local_lead_angle_rad(const Cutter& cutter, double height_mm);

/// What runout adds to the radius of tooth k at a height: e cos(runout angle − position of tooth k − ψ(z)).
double runout_offset_mm(const Cutter& cutter, std::size_t tooth, double height_mm);

}  // namespace millforce::sim
