// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace millforce::sim {

enum class ChipModel : unsigned char {
    circular,       ///< the path as a circle, h = f sin φ
    offset_circle,  ///< two circles a feed apart (Guan et al., section 3.1.1)
    trochoidal,     ///< the true path: the axis moves on while the tooth turns
};

/// An edge element and the earlier pass of another edge (or its own) over the same ground. All lengths in mm.
/// The ray at angle φ from the present axis meets the earlier pass at a distance d; the chip is h = r − d in the plane
/// normal to the axis, negative where the earlier pass went deeper.
struct EdgePass {
    double radius_mm;              ///< r of the element, runout included
    double earlier_radius_mm;      ///< r' of the earlier pass
    double advance_per_radian_mm;  ///< ρ: how far the axis moves while the cutter turns by one radian, N f_z / 2π
    double gap_rad;                ///< angle from this edge to the earlier one, > 0

    /// f = ρ · gap: the feed between the two passes; f_z for neighbours of equal pitch.
    double advance_mm() const { return advance_per_radian_mm * gap_rad; }
};

/// h = r − r' + f sin φ.
inline double circular_chip_mm(const EdgePass& pass, double sin_phi) {
    return pass.radius_mm - pass.earlier_radius_mm + pass.advance_mm() * sin_phi;
}

/// h = r + f sin φ − √(r'² − f² cos² φ). With r' = r this is Guan et al.'s law of cosines, |BC|² = R² + f² −
/// 2 R f cos ∠BOC, ∠BOC = acos(f cos φ/R) − φ; their print has lost a "+" and the "cos".
/// Where the earlier circle does not reach the ray (a ball's tip), the chip reaches to the axis: h = r.
inline double offset_circle_chip_mm(const EdgePass& pass, double sin_phi, double cos_phi) {
    const double across_mm = pass.advance_mm() * cos_phi;
    const double square = pass.earlier_radius_mm * pass.earlier_radius_mm - across_mm * across_mm;
    if (square <= 0.0) {
        return pass.radius_mm;
    }
    const double distance_mm = std::sqrt(square) - pass.advance_mm() * sin_phi;
    return pass.radius_mm - std::max(0.0, distance_mm);
}

/// The true trochoid. With v the angle by which the earlier edge, seen from its own axis of that moment, stood past φ
/// when it crossed the ray:
///   r' sin v = ρ (gap − v) cos φ,  d = r' cos v − ρ (gap − v) sin φ,  h = r − d.
/// v is of the order f/r'. It is solved with the slope at v = 0, which takes a factor v²/2 off the error with each
/// step; the steps end where less than 1e-10 rad remains. To first order h − f sin φ = f²/r [½ cos²φ − sin φ cos φ /
/// gap]. Where f exceeds 0.4 of the radius, or ρ a quarter of it (a ball's tip: the feed is no longer slow compared
/// with the edge), the path is no longer a wall, and the offset circle is used instead.
inline double trochoidal_chip_mm(const EdgePass& pass, double sin_phi, double cos_phi) {
    constexpr double largest_advance_in_radii = 0.4;
    constexpr double largest_rho_in_radii = 0.25;
    const double radius_mm = pass.earlier_radius_mm;
    const double rho_mm = pass.advance_per_radian_mm;
    if (pass.advance_mm() > largest_advance_in_radii * radius_mm || rho_mm > largest_rho_in_radii * radius_mm) {
        return offset_circle_chip_mm(pass, sin_phi, cos_phi);
    }
    const double across_mm = pass.advance_mm() * cos_phi;
    const double inverse_slope = 1.0 / (radius_mm + rho_mm * cos_phi);
    double v = across_mm * inverse_slope;
    double cos_v = 1.0;
    constexpr int most_steps = 16;
    for (int step = 0; step < most_steps; ++step) {
        const double square = v * v;  // below 0.3: the first terms lost of both series are below 1e-10
        const double sin_v =
            v * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0))));
        cos_v = 1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)));
        const double change = (across_mm - rho_mm * v * cos_phi - radius_mm * sin_v) * inverse_slope;
        v += change;
        cos_v -= change * sin_v;
        if (std::abs(change) * square < 1e-10) {
            break;
        }
    }
    return pass.radius_mm - radius_mm * cos_v + rho_mm * (pass.gap_rad - v) * sin_phi;
}

inline double chip_thickness_mm(ChipModel model, const EdgePass& pass, double sin_phi, double cos_phi) {
    switch (model) {
        case ChipModel::offset_circle:
            return offset_circle_chip_mm(pass, sin_phi, cos_phi);
        case ChipModel::trochoidal:
            return trochoidal_chip_mm(pass, sin_phi, cos_phi);
        case ChipModel::circular:
            break;
    }
    return circular_chip_mm(pass, sin_phi);
}

}  // namespace millforce::sim
