// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/measurement.hpp"

#include <cmath>

/// The twelve force shapes of a helical end mill (Yang, DeVor & Kapoor, section 2): three types of one flute's force,
/// times four degrees by which flutes overlap. Angles: α_en engagement, α_sw = a_p tan β/R sweep, α_T = 2π/N pitch.
/// Up milling mirrors the shapes; types and overlap are the same.
///
/// Misprints: the second form of Eq. 3 has ADOC_c in place of the actual ADOC (it is (π + α_sw)/2 for the depth that is
/// classified). Eq. 6's first line needs α_en + α_sw < α_T, not α_sw < α_T, or it covers the second line's cuts too.
/// All functions: no state, a few operations.

namespace millforce::estimation {

enum class FluteForceType : unsigned char {
    I,    ///< rises over α_sw, falls over α_en: the whole edge is in cut, the chip gets thinner
    II,   ///< rises over α_en, flat top, falls: the edge is longer than the cut
    III,  ///< wide cut: the peak lies where the edge's middle passes half immersion
};

enum class FluteOverlap : unsigned char {
    none,    ///< NO: one flute at a time
    low,     ///< LO: a flute rises while the one before falls
    medium,  ///< MO: it also begins to fall during that
    high,    ///< HO: it rises while the one before rises
};

template <typename Scalar>
struct FluteAngles {
    Scalar engagement_rad{0};  ///< α_en
    Scalar sweep_rad{0};       ///< α_sw
    Scalar pitch_rad{0};       ///< α_T
};

struct CutCategory {
    FluteForceType type = FluteForceType::I;
    FluteOverlap overlap = FluteOverlap::none;
    friend constexpr bool operator==(const CutCategory&, const CutCategory&) = default;
};

/// α_enc = (π + α_sw)/2 (Eq. 3): from this engagement on, one flute's force peaks inside the cut.
template <typename Scalar>
constexpr Scalar critical_engagement_rad(Scalar sweep_rad) {
    return Scalar(0.5F) * (pi<Scalar> + sweep_rad);
}

template <typename Scalar>
constexpr CutCategory cut_category(const FluteAngles<Scalar>& angles) {
    const Scalar critical = critical_engagement_rad(angles.sweep_rad);
    CutCategory category;
    Scalar rise = angles.sweep_rad;
    Scalar fall = angles.engagement_rad;
    if (angles.engagement_rad >= critical) {
        category.type = FluteForceType::III;
        rise = angles.sweep_rad + angles.engagement_rad - critical;
        fall = critical;
    } else if (angles.sweep_rad >= angles.engagement_rad) {
        category.type = FluteForceType::II;
        rise = angles.engagement_rad;
        fall = angles.sweep_rad;
    }
    if (rise >= angles.pitch_rad) {
        category.overlap = FluteOverlap::high;
    } else if (fall >= angles.pitch_rad) {
        category.overlap = FluteOverlap::medium;
    } else if (rise + fall >= angles.pitch_rad) {
        category.overlap = FluteOverlap::low;
    }
    return category;
}

/// PT_doc of Table 1 (Eqs. 5–7), the angle from a valley of the force to the next peak (with a flat top, from its end
/// to the next valley), as printed. Holds for flute forces that add as scalars and fall slower than the next one
/// rises; estimation/depth_shape/depth_variation.hpp says where a measured force shows another angle.
template <typename Scalar>
Scalar published_peak_angle_rad(const FluteAngles<Scalar>& angles) {
    const CutCategory category = cut_category(angles);
    const auto modulo_pitch = [&](Scalar angle) {
        using std::floor;
        return category.overlap == FluteOverlap::high ? angle - floor(angle / angles.pitch_rad) * angles.pitch_rad
                                                      : angle;
    };
    switch (category.type) {
        case FluteForceType::I:
            return modulo_pitch(angles.sweep_rad);
        case FluteForceType::III:
            return modulo_pitch(angles.engagement_rad + Scalar(0.5F) * (angles.sweep_rad - pi<Scalar>));
        case FluteForceType::II:
            break;
    }
    switch (category.overlap) {
        case FluteOverlap::low:
            return angles.pitch_rad - angles.sweep_rad;
        case FluteOverlap::medium:
            return angles.sweep_rad - angles.pitch_rad;
        case FluteOverlap::none:
        case FluteOverlap::high:
            break;
    }
    return modulo_pitch(angles.engagement_rad);
}

template <typename Scalar>
struct DepthsOfCut {
    Scalar axial_mm{0};   ///< ADOC, a_p
    Scalar radial_mm{0};  ///< RDOC, a_e
};

template <typename Scalar>
struct FluteGeometry {
    int teeth = 4;  ///< N of equal pitch, 1…12
    Scalar cutter_radius_mm{5};
    Scalar helix_rad{0};  ///< β, 5…65°: without helix the force's shape does not know the axial depth
};

template <typename Scalar>
FluteAngles<Scalar> flute_angles(const FluteGeometry<Scalar>& cutter, const DepthsOfCut<Scalar>& depths) {
    using std::acos;
    using std::tan;
    const Scalar immersion = clamp(depths.radial_mm / cutter.cutter_radius_mm, Scalar(0), Scalar(2));
    return {acos(Scalar(1) - immersion), depths.axial_mm * tan(cutter.helix_rad) / cutter.cutter_radius_mm,
            Scalar(2) * pi<Scalar> / Scalar(cutter.teeth)};
}

/// Eq. 8.
template <typename Scalar>
DepthsOfCut<Scalar> depths_of_cut(const FluteGeometry<Scalar>& cutter, const FluteAngles<Scalar>& angles) {
    using std::cos;
    using std::tan;
    return {angles.sweep_rad * cutter.cutter_radius_mm / tan(cutter.helix_rad),
            cutter.cutter_radius_mm * (Scalar(1) - cos(angles.engagement_rad))};
}

/// Eq. 13: samples per revolution that a relative resolution b of both depths needs.
template <typename Scalar>
Scalar samples_per_revolution(const FluteGeometry<Scalar>& cutter, const DepthsOfCut<Scalar>& nominal,
                              Scalar resolution) {
    using std::sqrt;
    using std::tan;
    const Scalar R = cutter.cutter_radius_mm;
    const Scalar immersion = nominal.radial_mm / R;
    const Scalar by_axial = Scalar(2) * pi<Scalar> * R / (resolution * nominal.axial_mm * tan(cutter.helix_rad));
    const Scalar by_radial = Scalar(2) * pi<Scalar> * R * sqrt(Scalar(2) * immersion - immersion * immersion) /
                             (resolution * nominal.radial_mm);
    return by_axial > by_radial ? by_axial : by_radial;
}

}  // namespace millforce::estimation
