// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/force_drop/force_drop_law.hpp"
#include "estimation/number/elementary.hpp"
#include "estimation/number/fixed_point.hpp"
#include "estimation/number/literal.hpp"

#include <array>
#include <cstddef>

/// Radial immersion from a force drop and the average forces (Hwang et al., section 2), solved by bracketing.
///
/// Two equations in the one unknown, θ with immersion = 1 − cos θ (Eq. 7; θ is φ_s in up milling, π − φ_st in down
/// milling), both from force_drop_law.hpp:
///
///   direction:  atan r(θ) − atan(a r_av(θ) + b) = 0        Eqs. 6, 11, 12 of the paper
///   magnitude:  ln K(θ)/K_av(θ) − c_0 − c_1 cos θ − c_2 ln(f_z/0.15 mm) = 0      ours
///
/// The paper iterates r → φ_s → r_av → r from any r in 0…1, which contracts only where a < 1 and takes some 25 steps at
/// a = 0.96; Eq. 6's arctangent fails past 90°. Here each equation is tabulated over the valid range, every change of
/// sign is a bracket, and a bracket is closed by the Illinois variant of regula falsi, whatever a is. Where an equation
/// has several roots, the other one decides (likeliest()); where neither has one, there is no estimate.
///
/// The direction equation amplifies: at small immersion jump and average differ in direction by a third of θ only, so
/// that 0.3° of force direction make 1° of θ. The magnitude equation has F_at/F_t(φ_s) = N/2π tan(θ/2): 1 % of force is
/// 1 % of θ. Each root gets its variance, by moving every input by its standard deviation; the roots are joined with
/// the weights of least variance, their correlation counted. Roots that differ by more than `largest_disagreement`
/// standard deviations mean that the law does not describe the force: no estimate.
///
/// Valid for up and down milling, immersion within the law's range (0.1…0.95 at most). Cost: 24 + 2 · 12 + 30
/// evaluations of force_drop_ratios (4 trigonometric calls each). No state, no heap. Stack: below 1 KB.
/// Bodies: force_drop_immersion_impl.hpp.

namespace millforce::estimation {

template <typename Scalar>
struct ForceDropImmersionSettings {
    Scalar largest_disagreement{4};             ///< largest difference of the two roots, in standard deviations
    Scalar largest_sd{literal<Scalar>(0.15L)};  ///< immersion known less well than this is no estimate
    Scalar largest_relative_sd{literal<Scalar>(0.2L)};
};

/// A root of one of the equations.
template <typename Scalar>
struct ForceDropRoot {
    bool valid = false;
    Scalar theta_rad{0};
    Scalar variance{0};
    [[nodiscard]] Scalar immersion() const {
        using elementary::cos;
        return Scalar(1) - cos(theta_rad);
    }
};

template <typename Scalar>
struct ForceDropEstimate {
    enum class Reason : unsigned char {
        estimated,
        no_drop,       ///< no significant jump, or no forces
        too_fast,      ///< the tooth passes too quickly for the low-pass
        other_filter,  ///< the low-pass is not as told: another corner explains the signal clearly better
        no_law,        ///< not calibrated
        side_unknown,  ///< neither up nor down milling
        no_root,       ///< no immersion in the valid range explains the forces
        disagreement,  ///< direction and magnitude give different immersions
        ambiguous,     ///< the other edge of the cut lies at the jump, and several immersions explain both
        too_uncertain
    } reason = Reason::no_drop;
    [[nodiscard]] bool valid() const { return reason == Reason::estimated; }

    Scalar radial_immersion{0};  ///< a_e/R, 0…2
    Scalar radial_immersion_sd{0};
    Scalar theta_rad{0};  ///< 0 if there is no root at all; also given when the estimate is refused
    CutSide side = CutSide::unknown;
    Scalar r{0};
    Scalar r_av{0};
    Scalar pressure_N_per_mm{0};           ///< K a at the jump
    ForceDropRoot<Scalar> by_direction{};  ///< the paper's equations alone
    ForceDropRoot<Scalar> by_magnitude{};
};

template <typename Scalar, int Nodes = 24>
class ForceDropImmersion {
  public:
    explicit ForceDropImmersion(const ForceDropLaw<Scalar>& law = {},
                                const ForceDropImmersionSettings<Scalar>& settings = {});

    [[nodiscard]] const ForceDropLaw<Scalar>& law() const { return law_; }

    [[nodiscard]] ForceDropEstimate<Scalar> solve(const ForceDropMeasurement<Scalar>& m) const;

    /// What the averages alone say about the cut, if this were θ: K a at the jump by c_0 and c_1.
    [[nodiscard]] Scalar pressure_by_averages_N_per_mm(const ForceDropMeasurement<Scalar>& m, Scalar theta_rad) const;

  private:
    enum class Equation : unsigned char { direction, magnitude };
    static constexpr std::size_t input_count = 6;
    static constexpr int most_roots = 3;

    struct Roots;
    struct Value;
    /// Change of a root per standard deviation of each input.
    using Changes = std::array<Scalar, input_count>;
    struct Propagation;
    struct Point;

    [[nodiscard]] typename ForceDropEstimate<Scalar>::Reason reason_against(
        const ForceDropMeasurement<Scalar>& m) const;
    [[nodiscard]] bool is_known(const ForceDropEstimate<Scalar>& estimate) const;
    [[nodiscard]] ForceDropInputs<Scalar> inputs_of(const ForceDropMeasurement<Scalar>& m) const;
    [[nodiscard]] static ForceDropRatios<Scalar> ratios_at(const ForceDropInputs<Scalar>& in,
                                                           const ForceDropMeasurement<Scalar>& m, Scalar theta_rad);
    [[nodiscard]] Value residual(Equation equation, const ForceDropInputs<Scalar>& in,
                                 const ForceDropMeasurement<Scalar>& m, Scalar theta_rad) const;
    [[nodiscard]] Roots roots_of(Equation equation, const ForceDropMeasurement<Scalar>& m) const;
    [[nodiscard]] Scalar close_bracket(Equation equation, const ForceDropInputs<Scalar>& in,
                                       const ForceDropMeasurement<Scalar>& m, Point low, Point high) const;
    [[nodiscard]] ForceDropRoot<Scalar> likeliest(const Roots& roots, Equation other,
                                                  const ForceDropMeasurement<Scalar>& m) const;
    void propagate(const ForceDropMeasurement<Scalar>& m, ForceDropRoot<Scalar>& root, Equation equation,
                   Changes& changes) const;
    [[nodiscard]] static ForceDropInputs<Scalar> moved(ForceDropInputs<Scalar> in, std::size_t k, Scalar by);
    [[nodiscard]] Measurement<Scalar> likely_r_av(const ForceDropRatios<Scalar>& ratios,
                                                  const ForceDropMeasurement<Scalar>& m) const;
    [[nodiscard]] Scalar law_variance(Equation equation, const ForceDropMeasurement<Scalar>& m, Scalar theta_rad) const;
    [[nodiscard]] typename ForceDropEstimate<Scalar>::Reason join(const Propagation& doubt,
                                                                  ForceDropEstimate<Scalar>& estimate) const;
    void fill_ratios(const ForceDropMeasurement<Scalar>& m, ForceDropEstimate<Scalar>& estimate) const;

    ForceDropLaw<Scalar> law_;
    ForceDropImmersionSettings<Scalar> settings_;
};

extern template class ForceDropImmersion<float>;
extern template class ForceDropImmersion<Fixed>;

}  // namespace millforce::estimation
