// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/circle.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/number/measurement.hpp"

/// Engagement of a milling cutter as two angles, and the one-parameter families that a radial width selects.
///
/// Angles φ are measured from the normal to the feed (+y), clockwise, x = feed direction. A tooth at φ cuts where φ_st
/// ≤ φ ≤ φ_ex, and is at y = R cos φ from the cutter's axis. Tooth pitch φ_N = 2π/N.
/// The radial immersion is R_r = a_e/R, 0…2.

namespace millforce::estimation {

/// Which edge of the cut is fixed while its width varies.
enum class CutSide : unsigned char {
    down,     ///< φ_ex = π: the tooth leaves at the machined wall (climb milling).
    up,       ///< φ_st = 0: the tooth enters at the machined wall (conventional milling).
    centred,  ///< the workpiece's centre line has a fixed offset from the cutter's axis (face milling).
    unknown,  ///< not given: inferred from the forces where they allow it.
};
inline constexpr unsigned cut_side_count = static_cast<unsigned>(CutSide::unknown) + 1U;

constexpr const char* name(CutSide side) {
    constexpr const char* names[cut_side_count] = {"down", "up", "centred", "unknown"};
    return names[static_cast<unsigned>(side) % cut_side_count];
}

/// Entry and exit angle of a tooth, 0 ≤ φ_st ≤ φ_ex ≤ π.
template <typename Scalar>
struct EngagementAngles {
    Scalar entry_rad{0};
    Scalar exit_rad{0};
};

/// Engagement angles of a cut of the given radial immersion.
/// Up: φ_st = 0, φ_ex = acos(1 − R_r). Down: φ_st = π − acos(1 − R_r), φ_ex = π. Centred: both edges at
/// centre_offset ± R_r/2 (in cutter radii, positive on the φ = 0 side), clipped to the cutter.
/// `unknown` is treated as down. Immersion outside 0…2 is clipped.
template <typename Scalar>
EngagementAngles<Scalar> engagement_angles(CutSide side, Scalar radial_immersion, Scalar centre_offset_in_radii = 0) {
    using elementary::acos;
    const Scalar immersion = clamp(radial_immersion, Scalar(0), Scalar(2));
    switch (side) {
        case CutSide::up:
            return {Scalar(0), acos(Scalar(1) - immersion)};
        case CutSide::centred: {
            const Scalar half = halved(immersion);
            return {acos(clamp(centre_offset_in_radii + half, Scalar(-1), Scalar(1))),
                    acos(clamp(centre_offset_in_radii - half, Scalar(-1), Scalar(1)))};
        }
        case CutSide::down:
        case CutSide::unknown:
            break;
    }
    return {pi<Scalar> - acos(Scalar(1) - immersion), pi<Scalar>};
}

}  // namespace millforce::estimation
