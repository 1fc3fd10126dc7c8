// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/depth_shape/detail/flute_spectrum.hpp"
#include "estimation/number/least_squares.hpp"
#include "estimation/number/literal.hpp"

#include <Eigen/Core>

#include <array>

/// Weighted least squares of a measured profile's Fourier lines against FluteSpectrum, around one starting point.
/// The force law's coefficients are linear: at each point they are solved for, and what is minimised over sweep,
/// engagement and shift is what they leave (variable projection, Gauss–Newton with steps shortened). Bodies:
/// flute_spectrum_fit_impl.hpp.

namespace millforce::estimation {

/// The three unknowns that are not linear: α_sw, α_en, and ζ = N θ₀, where the profile starts.
template <typename Scalar>
using FlutePoint = Eigen::Matrix<Scalar, 3, 1>;

template <typename Scalar>
struct FluteLimits {
    FlutePoint<Scalar> low;
    FlutePoint<Scalar> high;
};

/// What is known of the unknowns beforehand; sd 0: nothing.
template <typename Scalar>
struct FluteKnowledge {
    FlutePoint<Scalar> mean = FlutePoint<Scalar>::Zero();
    FlutePoint<Scalar> sd = FlutePoint<Scalar>::Zero();
};

template <typename Scalar>
struct FluteMinimum {
    FlutePoint<Scalar> point = FlutePoint<Scalar>::Zero();
    Scalar misfit{0};  ///< sum of squared weighted residuals, knowledge included
    FlutePoint<Scalar> variance = FlutePoint<Scalar>::Zero();
    Scalar residual_variance{1};  ///< variance of the weighted residuals, 1 where the assumed errors are right
    bool solved = false;
};

template <typename Scalar, int Harmonics>
class FluteSpectrumFit {
  public:
    using Model = FluteSpectrum<Scalar, Harmonics>;
    using Lines = typename Model::Lines;
    using LawLines = typename Model::LawLines;
    using Point = FlutePoint<Scalar>;
    using Minimum = FluteMinimum<Scalar>;

    struct Measured {
        Lines data{};
        Lines response{};                           ///< response of the low-pass
        std::array<Scalar, Model::lines> weight{};  ///< 1/standard deviation; 0: not used
    };

    FluteSpectrumFit(const Model& model, const Measured& measured) : model_(model), measured_(measured) {}

    [[nodiscard]] Minimum refine(Point point, const FluteLimits<Scalar>& limits,
                                 const FluteKnowledge<Scalar>& knowledge) const;

    /// Of the chip and edge lines alone: their part of the data's energy at the shift, and all of it.
    class Projection;

    [[nodiscard]] Scalar energy() const;

  private:
    static constexpr int linear = 2 * static_cast<int>(Model::laws);
    /// Very small residuals can be chance, so the residual variance has a floor: two minima must differ by more than
    /// this allows.
    static constexpr Scalar smallest_residual_variance = literal<Scalar>(0.03L);
    static constexpr Scalar condition_limit = Scalar(1e6F);
    using LinearFit = LeastSquares<Scalar, linear>;
    using JointFit = LeastSquares<Scalar, linear + 3>;
    using Coefficients = std::array<Phasor<Scalar>, Model::laws>;

    struct State;

    [[nodiscard]] State state_at(const Point& point) const;
    [[nodiscard]] Scalar law_scale(const State& state) const;
    template <typename Fit>
    static void add_law_priors(Fit& fit, Scalar scale);
    template <typename Row>
    static void fill_laws(const State& state, std::size_t l, Row& re, Row& im);
    [[nodiscard]] LinearFit linear_fit(const State& state, Scalar scale) const;
    [[nodiscard]] static Coefficients coefficients(const LeastSquaresSolution<Scalar, linear>& solution);
    [[nodiscard]] JointFit joint_fit(const State& state, const Coefficients& c, Scalar scale,
                                     const FluteKnowledge<Scalar>& knowledge) const;
    [[nodiscard]] static Scalar distance(const Point& point, const FluteKnowledge<Scalar>& knowledge);
    bool step(const Point& change, const FluteLimits<Scalar>& limits, const FluteKnowledge<Scalar>& knowledge,
              Scalar scale, State& state, Minimum& minimum) const;
    static void keep_variance(const LeastSquaresSolution<Scalar, linear + 3>& solution, Minimum& minimum);

    const Model& model_;
    const Measured& measured_;
};

}  // namespace millforce::estimation
