// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/fixed_point.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

#include <array>
#include <cstddef>

/// Surface roughness from the ratio of cutting forces, during the cut (Tangjitsitcharoen & Senjuntichaj Eqs. 1–2):
///
///   R = C V^a₁ f^a₂ φ^a₃ D^a₄ ρ^a₅,   ρ = F_x/F_z
///
/// V spindle speed (rpm), f feed (mm/rev), φ tool diameter and D depth of cut (mm), R is R_a or R_z (µm). The paper
/// calls this power law an exponential function. Its two published models (ball end, AISI 1050):
///
///   R_a = 7.5e-6 V^0.964 f^0.195 φ^2.69 D^0.917 ρ^−2.6     R_z = 2.91 V^0.16 f^0.438 φ^1.25 D^0.474 ρ^−2.84
///
/// The paper draws 95 % prediction intervals and prints neither their formula nor its residual, its number of tests or
/// the range of ρ. Here, with x₀ = (1, ln V, …, ln ρ) of the cut and X of the n tests that the model was fitted to,
///
///   R · exp(± √(t² s² (1 + h₀) + (1.96 a₅)² var ln ρ)),   h₀ = x₀ᵀ(XᵀX)⁻¹x₀,   t = t_{0.975, n−p}
///
/// The first term is the interval of a test as they were made for the fit. The second is what the paper has no need of:
/// there a dynamometer measures ρ as in the tests, here two motor currents do. R itself is the median, not the mean.
/// Without s and n − p there is no interval, and nothing may act on R: so it is with the published models.
///
/// h₀ is held as 1/n + zᵀ M z: z the logarithms of the variables over their geometric means in the tests, M = (ZᵀZ)⁻¹
/// of the centred tests. This is the same number, and float keeps it.
///
/// Memory: 49 scalars, the model included. No heap. Not thread-safe. Valid from 1 degree of freedom.
/// Bodies: roughness_impl.hpp.

namespace millforce::estimation {

enum RoughnessVariable : int {
    roughness_spindle_speed,
    roughness_feed,
    roughness_tool_diameter,
    roughness_axial_depth,
    roughness_force_ratio,
    roughness_variable_count
};

template <typename Scalar>
using RoughnessValues = std::array<Scalar, static_cast<std::size_t>(roughness_variable_count)>;

/// What R is predicted from: V in rpm, f in mm/rev, φ in mm, D in mm, ρ; in the order of RoughnessVariable. Each > 0.
template <typename Scalar>
using RoughnessConditions = RoughnessValues<Scalar>;

enum class RoughnessMeasure : unsigned char { Ra, Rz };

/// A model with its range and with what its interval is made of. Plain data: the [roughness] table of a tool.
template <typename Scalar>
struct RoughnessModel {
    static constexpr std::size_t pairs = 15;
    RoughnessMeasure measure{RoughnessMeasure::Ra};
    Scalar constant_um{0};                 ///< C; 0: there is no model
    RoughnessValues<Scalar> exponent{};    ///< a₁ … a₅
    RoughnessValues<Scalar> minimum{};     ///< lower end of the tests' range; 0: not given
    RoughnessValues<Scalar> maximum{};     ///< upper end of the tests' range; 0: not given
    RoughnessValues<Scalar> reference{};   ///< geometric means of the tests
    Scalar tests{0};                       ///< n
    Scalar degrees_of_freedom{0};          ///< n − p; 0: no interval
    Scalar residual_ln_sd{0};              ///< s
    std::array<Scalar, pairs> leverage{};  ///< M, lower triangle by rows; see pair()
    Scalar largest_leverage{0};            ///< leverage of a test on the fit; 0: not given

    /// Place of M(row, column) in `leverage`; row ≥ column.
    static constexpr std::size_t pair(std::size_t row, std::size_t column) { return row * (row + 1) / 2 + column; }
};

/// |F_x/F_z| with its variance. No estimate where either force is missing or lies within three standard deviations of
/// zero: the ratio of such numbers has no bounded interval. Signs are the axes' business: a ball end presses down.
template <typename Scalar>
Measurement<Scalar> force_ratio(const Measurement<Scalar>& f_x, const Measurement<Scalar>& f_z);

/// R of a cut with its 95 % prediction interval, and whether the cut is like those that the model was fitted to.
template <typename Scalar>
struct RoughnessPrediction {
    bool valid = false;         ///< roughness_um is an estimate
    bool has_interval = false;  ///< low_um and high_um are
    Scalar roughness_um{0};
    Scalar low_um{0};
    Scalar high_um{0};
    Scalar leverage{0};   ///< h₀
    unsigned outside{0};  ///< bit j: variable j lies outside the range of the tests; see also hidden_extrapolation
    unsigned range_not_given{0};  ///< bit j: the range of variable j is not given

    /// Each variable is in its range, but no test had them together: h₀ is beyond that of any test.
    static constexpr unsigned hidden_extrapolation = 1U << static_cast<unsigned>(roughness_variable_count);

    /// Within the fitted range, as far as it is given.
    [[nodiscard]] bool in_range() const { return valid && outside == 0U; }
    /// Good enough to act on: with an interval, and within a completely given range.
    [[nodiscard]] bool is_sure() const { return in_range() && has_interval && range_not_given == 0U; }
};

template <typename Scalar>
class RoughnessPredictor {
  public:
    RoughnessPredictor() = default;
    explicit RoughnessPredictor(const RoughnessModel<Scalar>& model);

    [[nodiscard]] bool has_model() const { return has_model_; }
    [[nodiscard]] bool has_interval() const { return has_interval_; }
    [[nodiscard]] const RoughnessModel<Scalar>& model() const { return model_; }

    /// R of a cut whose ρ is known as well as in the tests. No estimate where a condition is not positive and finite.
    /// Cost: 5 logarithms, 3 exponentials, 1 root, some 60 products.
    [[nodiscard]] RoughnessPrediction<Scalar> predict(const RoughnessConditions<Scalar>& cut) const;

    /// The same from forces as the drives give them: the interval includes the uncertainty of both.
    [[nodiscard]] RoughnessPrediction<Scalar> predict(RoughnessConditions<Scalar> cut, const Measurement<Scalar>& f_x,
                                                      const Measurement<Scalar>& f_z) const;

    /// How fast to feed at most so that the upper bound of R stays at `limit_um` or below, with all but the feed as in
    /// `cut`. Within the fitted feeds: the effect of others on the surface was not measured.
    struct FeedCeiling {
        bool valid = false;      ///< feed_mm_rev is a ceiling
        bool reachable = false;  ///< a fitted feed keeps the limit; else feed_mm_rev is the lowest of them
        bool in_range = false;   ///< the cut at this feed is like those of the tests
        Scalar feed_mm_rev{0};
    };

    /// No ceiling without an interval, without a given range of feeds, or where R does not grow with the feed (a₂ ≤ 0:
    /// a slower feed would not help). Cost: 18 times 15 products and a root, and
    /// two predictions.
    [[nodiscard]] FeedCeiling feed_ceiling(RoughnessConditions<Scalar> cut, const Measurement<Scalar>& f_x,
                                           const Measurement<Scalar>& f_z, Scalar limit_um) const;

  private:
    static constexpr std::size_t count = static_cast<std::size_t>(roughness_variable_count);
    /// What a drive holds of a programmed speed or feed: no cut in the loop has the tests' numbers to the digit.
    static constexpr Scalar tolerance = literal<Scalar>(0.01L);

    [[nodiscard]] RoughnessPrediction<Scalar> prediction_of(const RoughnessConditions<Scalar>& cut,
                                                            Scalar ratio_ln_variance) const;
    [[nodiscard]] Scalar highest_feed_within(Scalar ln_limit, RoughnessValues<Scalar> z,
                                             Scalar ratio_ln_variance) const;
    [[nodiscard]] static bool are_usable(const RoughnessConditions<Scalar>& cut);
    [[nodiscard]] RoughnessValues<Scalar> logarithms(const RoughnessConditions<Scalar>& cut) const;
    [[nodiscard]] Scalar ln_roughness(const RoughnessValues<Scalar>& z) const;
    [[nodiscard]] Scalar leverage(const RoughnessValues<Scalar>& z) const;
    [[nodiscard]] Scalar half_interval(Scalar leverage, Scalar ratio_ln_variance) const;
    void compare_with_tests(const RoughnessConditions<Scalar>& cut, RoughnessPrediction<Scalar>& prediction) const;

    RoughnessModel<Scalar> model_{};
    RoughnessValues<Scalar> ln_reference_{};  // of z: geometric means of the tests, or 1 where there are none
    Scalar ln_at_reference_um_{0};
    Scalar t_{0};
    bool has_model_ = false;
    bool has_interval_ = false;
};

extern template Measurement<float> force_ratio(const Measurement<float>&, const Measurement<float>&);
extern template Measurement<Fixed> force_ratio(const Measurement<Fixed>&, const Measurement<Fixed>&);
extern template class RoughnessPredictor<float>;
extern template class RoughnessPredictor<Fixed>;

}  // namespace millforce::estimation
