// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cutting_law.hpp"
#include "estimation/number/fixed_point.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"
#include "estimation/number/stored.hpp"

#include <array>
#include <cmath>

/// From averages to peaks, and from one tooth's limit to the limit of the total force.
///
///   κ = max_θ |Σ_k f(θ + kφ_N)| / F_at        peak of the total in-plane force per mean tangential force
///   τ = max_φ |f(φ)| / F_at                   peak of one tooth's in-plane force per mean tangential force
///   g = κ/τ, F_limit = F_tooth,max · g        the total that a rotation may show (Hwang et al., introduction)
///
/// f is the force of one tooth with helix: the disc forces of the cutting law, integrated in closed form over the part
/// of the edge that is in cut (a disc at height z lags by ψ = z tan β/R). At low immersion g = 1; where several teeth
/// share the load g grows.
///
/// F_peak ≤ F_limit says the same as F_at τ ≤ F_tooth,max: κ drops out of the comparison. So the controller needs τ
/// alone. τ depends on the engagement, the sweep α_sw = a_p tan β/R and r_1, hardly on the feed; it is tabulated once
/// per tool, at a nominal feed, and read by interpolation in every tick. κ and g are worked out where they are shown.

namespace millforce::estimation {

template <typename Scalar>
struct PeakFactorSettings {
    Scalar teeth{0};
    Scalar cutter_radius_mm{0};
    Scalar helix_rad{0};
    Scalar nominal_feed_per_tooth_mm{0};
    CutSide side = CutSide::down;
    Scalar centre_offset_in_radii{0};
};

template <typename Scalar>
struct PeakFactors {
    Scalar total{1};  ///< κ
    Scalar tooth{1};  ///< τ
    [[nodiscard]] Scalar threshold_factor() const { return total / tooth; }
};

/// Smallest sweep used; it gives a straight edge its limiting force instead of 0/0.
template <typename Scalar>
inline constexpr Scalar straight_sweep_rad = literal<Scalar>(0.001L);

/// One tooth on its way through a cut. What does not depend on where it stands is worked out once.
template <typename Scalar>
class ToothInCut {
  public:
    /// `sweep_rad`: α_sw.
    ToothInCut(const CuttingLaw<Scalar>& law, Scalar feed_per_tooth_mm, Scalar axial_depth_mm, Scalar sweep_rad,
               EngagementAngles<Scalar> engagement)
        : engagement_(engagement),
          passage_rad_(engagement.exit_rad + sweep_rad - engagement.entry_rad),
          sweep_rad_(sweep_rad > straight_sweep_rad<Scalar> ? sweep_rad : straight_sweep_rad<Scalar>) {
        const Scalar t_a = mean_chip_thickness_mm(feed_per_tooth_mm, engagement);
        const CuttingCoefficients<Scalar> k = cutting_coefficients(law, t_a);
        const Scalar per_rad = axial_depth_mm / sweep_rad_;
        has_chip_ = t_a > Scalar(0);
        r_1_ = k.r_1;
        G_N_ = k.K_s_N_per_mm2 * feed_per_tooth_mm * per_rad;
        E_t_N_ = law.K_te_N_per_mm * per_rad;
        E_r_N_ = law.K_re_N_per_mm * per_rad;
    }

    /// In-plane force where the tip is at θ (the tip leads; the edge above it lags by the helix).
    [[nodiscard]] AverageForces<Scalar> force_at(Scalar tip_angle_rad) const {
        const Scalar end_rad = tip_angle_rad - sweep_rad_;
        const Scalar low = end_rad > engagement_.entry_rad ? end_rad : engagement_.entry_rad;
        const Scalar high = tip_angle_rad < engagement_.exit_rad ? tip_angle_rad : engagement_.exit_rad;
        const EngagementIntegrals<Scalar> in_cut = engagement_integrals(EngagementAngles<Scalar>{low, high});
        if (!(in_cut.delta_rad > Scalar(0)) || !has_chip_) {
            return {};
        }
        return {G_N_ * in_cut.c + E_t_N_ * in_cut.delta_rad,
                G_N_ * (in_cut.s + r_1_ * in_cut.b) + E_t_N_ * in_cut.d + E_r_N_ * in_cut.c,
                G_N_ * (r_1_ * in_cut.s - in_cut.b) - E_t_N_ * in_cut.c + E_r_N_ * in_cut.d};
    }

    /// θ from the first touch to where the whole edge has left.
    [[nodiscard]] Scalar first_rad() const { return engagement_.entry_rad; }
    [[nodiscard]] Scalar passage_rad() const { return passage_rad_; }
    /// Where the edge has just come in whole, or just begins to leave: the force may have a corner there.
    [[nodiscard]] std::array<Scalar, 2> corners_rad() const {
        return {engagement_.entry_rad + sweep_rad_, engagement_.exit_rad};
    }

  private:
    EngagementAngles<Scalar> engagement_;
    Scalar passage_rad_;
    Scalar sweep_rad_;
    bool has_chip_ = false;
    Scalar r_1_{0};
    Scalar G_N_{0};
    Scalar E_t_N_{0};
    Scalar E_r_N_{0};
};

/// The cut whose peaks are sought, per mm of depth, which is common to all: the squares of the forces stay within the
/// range of fixed point.
template <typename Scalar>
struct CutOfPeaks {
    CutOfPeaks(const CuttingLaw<Scalar>& law, const PeakFactorSettings<Scalar>& settings, Scalar radial_immersion,
               Scalar axial_depth_mm)
        : CutOfPeaks(law, settings, engagement_angles(settings.side, radial_immersion, settings.centre_offset_in_radii),
                     sweep_rad(settings, axial_depth_mm)) {}

    ToothInCut<Scalar> tooth;
    Scalar tangential_N;  ///< F_at

  private:
    CutOfPeaks(const CuttingLaw<Scalar>& law, const PeakFactorSettings<Scalar>& settings,
               EngagementAngles<Scalar> engagement, Scalar sweep)
        : tooth(law, settings.nominal_feed_per_tooth_mm, Scalar(1), sweep, engagement),
          tangential_N(average_forces(law, CutConditions<Scalar>{settings.nominal_feed_per_tooth_mm, Scalar(1),
                                                                 engagement, settings.teeth})
                           .tangential_N) {}

    [[nodiscard]] static Scalar sweep_rad(const PeakFactorSettings<Scalar>& settings, Scalar axial_depth_mm) {
        using elementary::tan;
        return axial_depth_mm * tan(settings.helix_rad) / settings.cutter_radius_mm;
    }
};

/// Square of the largest in-plane force of one tooth: Steps values over its passage, and the corners.
template <typename Scalar, int Steps>
Scalar largest_tooth_N2(const ToothInCut<Scalar>& tooth) {
    Scalar largest{0};
    const auto look_at = [&](Scalar tip) {
        const AverageForces<Scalar> f = tooth.force_at(tip);
        const Scalar magnitude = square(f.feed_N) + square(f.normal_N);
        largest = magnitude > largest ? magnitude : largest;
    };
    for (int k = 0; k <= Steps; ++k) {
        look_at(tooth.first_rad() + tooth.passage_rad() * Scalar(k) / Scalar(Steps));
    }
    for (const Scalar corner : tooth.corners_rad()) {
        look_at(corner);
    }
    return largest;
}

/// The same for the sum of all teeth, over one pitch.
template <typename Scalar, int Steps>
Scalar largest_total_N2(const ToothInCut<Scalar>& tooth, Scalar pitch_rad) {
    const int behind = static_cast<int>(tooth.passage_rad() / pitch_rad) + 1;
    Scalar largest{0};
    const auto look_at = [&](Scalar tip) {
        Scalar x{0};
        Scalar y{0};
        for (int k = 0; k < behind; ++k) {
            const AverageForces<Scalar> f = tooth.force_at(tip + pitch_rad * Scalar(k));
            x += f.feed_N;
            y += f.normal_N;
        }
        const Scalar magnitude = square(x) + square(y);
        largest = magnitude > largest ? magnitude : largest;
    };
    for (int k = 0; k <= Steps; ++k) {
        look_at(tooth.first_rad() + pitch_rad * Scalar(k) / Scalar(Steps));
    }
    for (const Scalar corner : tooth.corners_rad()) {
        const auto pitches = static_cast<int>((corner - tooth.first_rad()) / pitch_rad);
        look_at(corner - pitch_rad * Scalar(pitches));
    }
    return largest;
}

inline constexpr int peak_search_steps = 72;

/// τ by search. About 72 single-tooth forces: for set-up, not for the tick.
template <typename Scalar>
Scalar tooth_peak_factor(const CuttingLaw<Scalar>& law, const PeakFactorSettings<Scalar>& settings,
                         Scalar radial_immersion, Scalar axial_depth_mm) {
    using std::sqrt;
    const CutOfPeaks<Scalar> cut(law, settings, radial_immersion, axial_depth_mm);
    return cut.tangential_N > Scalar(0)
               ? sqrt(largest_tooth_N2<Scalar, peak_search_steps>(cut.tooth)) / cut.tangential_N
               : Scalar(1);
}

/// κ and τ by search. About 72 (N + 1) single-tooth forces, with N teeth in the cut: for a display.
template <typename Scalar>
PeakFactors<Scalar> peak_factors(const CuttingLaw<Scalar>& law, const PeakFactorSettings<Scalar>& settings,
                                 Scalar radial_immersion, Scalar axial_depth_mm) {
    using std::sqrt;
    const CutOfPeaks<Scalar> cut(law, settings, radial_immersion, axial_depth_mm);
    if (!(cut.tangential_N > Scalar(0))) {
        return {};
    }
    const Scalar tooth_N2 = largest_tooth_N2<Scalar, peak_search_steps>(cut.tooth);
    const Scalar total_N2 = largest_total_N2<Scalar, peak_search_steps>(cut.tooth, turn_rad<Scalar> / settings.teeth);
    return {sqrt(total_N2 > tooth_N2 ? total_N2 : tooth_N2) / cut.tangential_N, sqrt(tooth_N2) / cut.tangential_N};
}

/// τ over immersion and sweep, read by bilinear interpolation. ImmersionNodes × SweepNodes scalars of RAM. Bodies:
/// peak_table_impl.hpp.
///
/// The table stores what varies little: τ grows as 1/R_r for narrow cuts, and as 1/a_p once the edge is longer than the
/// engagement; both factors are divided out before the table and multiplied back after it. The second axis is the
/// number of engagements that the edge sweeps, q = α_sw/(φ_ex − φ_st): linear in q up to 1, in 1/q above, so that the
/// corner at q = 1, where the edge outgrows the engagement, is a node.
template <typename Scalar, int ImmersionNodes = 28, int SweepNodes = 13>
class ToothPeakTable {
  public:
    ToothPeakTable() = default;

    void build(const CuttingLaw<Scalar>& law, const PeakFactorSettings<Scalar>& settings);

    /// Immersion is clipped to 0.02…2. Any depth ≥ 0.
    [[nodiscard]] Scalar at(Scalar radial_immersion, Scalar axial_depth_mm) const {
        using elementary::acos;
        return at_angle(acos(Scalar(1) - clamp(radial_immersion, Scalar(0), Scalar(2))), radial_immersion,
                        axial_depth_mm);
    }

    /// The same where θ is known as well, R_r = 1 − cos θ. Some 40 operations but for CutSide::centred, which takes two
    /// arc cosines.
    [[nodiscard]] Scalar at_angle(Scalar theta_rad, Scalar radial_immersion, Scalar axial_depth_mm) const;

  private:
    struct Place {
        std::size_t node;
        Scalar share;
    };

    /// The first node's engagement: of a narrower cut τ R_r hardly changes.
    static constexpr Scalar first_rad = literal<Scalar>(0.2L);
    static constexpr Scalar least_immersion = literal<Scalar>(0.0199334222L);  // 1 − cos 0.2
    static constexpr Scalar step_rad = (pi<Scalar> - first_rad) / static_cast<Scalar>(ImmersionNodes - 1);
    static constexpr Scalar steps_per_rad = Scalar(1) / step_rad;
    static constexpr int corner_index = (SweepNodes - 1) / 2;
    static constexpr Scalar corner_node = static_cast<Scalar>(corner_index);
    /// The last node's q: of a longer edge τ q hardly changes.
    static constexpr Scalar most_sweeps = Scalar(20);
    static constexpr Scalar least_inverse = Scalar(1) / most_sweeps;
    static constexpr Scalar nodes_per_inverse = corner_node / (Scalar(1) - least_inverse);

    [[nodiscard]] static Scalar immersion_of(Scalar node) {
        using elementary::cos;
        return Scalar(1) - cos(first_rad + step_rad * node);
    }
    [[nodiscard]] static Scalar sweeps_of(Scalar node) {
        if (node <= corner_node) {
            constexpr Scalar shallowest = literal<Scalar>(0.001L);  // in place of 0: no depth, no force
            return node > Scalar(0) ? node / corner_node : shallowest;
        }
        const Scalar beyond = (node - corner_node) / corner_node;
        return Scalar(1) / (Scalar(1) - beyond * (Scalar(1) - least_inverse));
    }
    [[nodiscard]] static Scalar node_of(Scalar sweeps) {
        if (sweeps <= Scalar(1)) {
            return sweeps * corner_node;
        }
        const Scalar inverse = sweeps < most_sweeps ? Scalar(1) / sweeps : least_inverse;
        return corner_node + (Scalar(1) - inverse) * nodes_per_inverse;
    }
    [[nodiscard]] static Place place(Scalar node, int nodes) {
        const Scalar inside = clamp(node, Scalar(0), Scalar(nodes - 1));
        const int low = inside < Scalar(nodes - 2) ? static_cast<int>(inside) : nodes - 2;
        return {static_cast<std::size_t>(low), inside - Scalar(low)};
    }
    [[nodiscard]] Scalar engagement_at(Scalar immersion) const {
        const EngagementAngles<Scalar> cut = engagement_angles(side_, immersion, centre_offset_in_radii_);
        return cut.exit_rad - cut.entry_rad;
    }
    [[nodiscard]] static Scalar scale_at(Scalar immersion, Scalar sweeps) {
        return sweeps > Scalar(1) ? immersion * sweeps : immersion;
    }
    [[nodiscard]] static std::size_t index(int i) { return static_cast<std::size_t>(i); }

    std::array<std::array<Stored<Scalar>, static_cast<std::size_t>(SweepNodes)>,
               static_cast<std::size_t>(ImmersionNodes)>
        nodes_{};
    Scalar sweep_rad_per_mm_{0};
    Scalar centre_offset_in_radii_{0};
    CutSide side_ = CutSide::down;
};

extern template class ToothPeakTable<float>;
extern template class ToothPeakTable<Fixed>;

}  // namespace millforce::estimation
