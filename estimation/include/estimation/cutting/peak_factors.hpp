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

/// In-plane force of one tooth whose tip is at θ (the tip leads; the edge above it lags by the helix).
template <typename Scalar>
AverageForces<Scalar> single_tooth_force(const CuttingLaw<Scalar>& law, Scalar feed_per_tooth_mm, Scalar axial_depth_mm,
                                         Scalar sweep_rad, EngagementAngles<Scalar> engagement, Scalar tip_angle_rad) {
    const Scalar sweep = sweep_rad > straight_sweep_rad<Scalar> ? sweep_rad : straight_sweep_rad<Scalar>;
    const Scalar low = tip_angle_rad - sweep > engagement.entry_rad ? tip_angle_rad - sweep : engagement.entry_rad;
    const Scalar high = tip_angle_rad < engagement.exit_rad ? tip_angle_rad : engagement.exit_rad;
    const EngagementIntegrals<Scalar> in_cut = engagement_integrals(EngagementAngles<Scalar>{low, high});
    const Scalar t_a = mean_chip_thickness_mm(feed_per_tooth_mm, engagement);
    if (!(in_cut.delta_rad > Scalar(0)) || !(t_a > Scalar(0))) {
        return {};
    }
    const CuttingCoefficients<Scalar> k = cutting_coefficients(law, t_a);
    const Scalar per_rad = axial_depth_mm / sweep;
    const Scalar G = k.K_s_N_per_mm2 * feed_per_tooth_mm * per_rad;
    const Scalar E_t = law.K_te_N_per_mm * per_rad;
    const Scalar E_r = law.K_re_N_per_mm * per_rad;
    return {G * in_cut.c + E_t * in_cut.delta_rad, G * (in_cut.s + k.r_1 * in_cut.b) + E_t * in_cut.d + E_r * in_cut.c,
            G * (k.r_1 * in_cut.s - in_cut.b) - E_t * in_cut.c + E_r * in_cut.d};
}

/// κ and τ by search over one pitch and one tooth's passage (Steps values each). About Steps·(N + 1) single-tooth
/// forces: for set-up, not for the tick.
template <typename Scalar, int Steps = 72>
PeakFactors<Scalar> peak_factors(const CuttingLaw<Scalar>& law, const PeakFactorSettings<Scalar>& settings,
                                 Scalar radial_immersion, Scalar axial_depth_mm) {
    using elementary::tan;
    using std::sqrt;
    const EngagementAngles<Scalar> engagement =
        engagement_angles(settings.side, radial_immersion, settings.centre_offset_in_radii);
    const Scalar sweep = axial_depth_mm * tan(settings.helix_rad) / settings.cutter_radius_mm;
    const Scalar feed = settings.nominal_feed_per_tooth_mm;
    // Forces per mm of depth, which is common to both: their squares stay within the range of fixed point.
    constexpr Scalar depth_mm{1};
    const Scalar F_at =
        average_forces(law, CutConditions<Scalar>{feed, depth_mm, engagement, settings.teeth}).tangential_N;
    const auto tooth_at = [&](Scalar tip) { return single_tooth_force(law, feed, depth_mm, sweep, engagement, tip); };
    const Scalar first = engagement.entry_rad;
    const Scalar passage = engagement.exit_rad + sweep - first;
    const Scalar pitch = turn_rad<Scalar> / settings.teeth;
    const int behind = static_cast<int>(passage / pitch) + 1;
    Scalar tooth_squared{0};
    Scalar total_squared{0};
    const auto look_at_tooth = [&](Scalar tip) {
        const auto f = tooth_at(tip);
        const Scalar magnitude = square(f.feed_N) + square(f.normal_N);
        tooth_squared = magnitude > tooth_squared ? magnitude : tooth_squared;
    };
    const auto look_at_total = [&](Scalar tip) {
        Scalar x{0};
        Scalar y{0};
        for (int tooth = 0; tooth < behind; ++tooth) {
            const auto f = tooth_at(tip + pitch * Scalar(tooth));
            x += f.feed_N;
            y += f.normal_N;
        }
        const Scalar magnitude = square(x) + square(y);
        total_squared = magnitude > total_squared ? magnitude : total_squared;
    };
    for (int k = 0; k <= Steps; ++k) {
        look_at_tooth(first + passage * Scalar(k) / Scalar(Steps));
        look_at_total(first + pitch * Scalar(k) / Scalar(Steps));
    }
    // Where an edge has just come in whole, or just begins to leave, the force may have a corner between two steps.
    const Scalar whole = first + (sweep > straight_sweep_rad<Scalar> ? sweep : straight_sweep_rad<Scalar>);
    for (const Scalar corner : {whole, engagement.exit_rad}) {
        look_at_tooth(corner);
        const auto pitches = static_cast<int>((corner - first) / pitch);
        look_at_total(corner - pitch * Scalar(pitches));
    }
    total_squared = total_squared > tooth_squared ? total_squared : tooth_squared;
    PeakFactors<Scalar> result;
    if (F_at > Scalar(0)) {
        result.total = sqrt(total_squared) / F_at;
        result.tooth = sqrt(tooth_squared) / F_at;
    }
    return result;
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
