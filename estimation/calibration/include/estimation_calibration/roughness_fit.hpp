// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"
#include "estimation/surface/roughness.hpp"

#include <cmath>
#include <limits>
#include <span>

/// A roughness model from cutting tests: least squares in logarithms (Tangjitsitcharoen & Senjuntichaj, section 2.2),
///
///   ln R = ln C + a₁ ln V + a₂ ln f + a₃ ln φ + a₄ ln D + a₅ ln ρ + e,   e normal with the same variance in all tests,
///
/// p = 6 parameters, with what the prediction interval needs: s, n − p, M and the largest leverage (roughness.hpp).
///
/// An exponent is not determined where its variable, apart from what the other variables explain of it, varies by less
/// than 2 % (rms): then the tests hold nothing of it, and another scatter would give another exponent. A shop with one
/// tool holds its diameter: an exponent that is held is 0 and no parameter, and the model is for that diameter alone.
///
/// Cost: three passes over the tests, one 6 × 6 decomposition. Memory: 160 scalars and the caller's tests. No heap.

namespace millforce::estimation {

/// One cutting test: conditions, and R_a or R_z as measured on the surface. All > 0; others are left out.
template <typename Scalar>
struct RoughnessTest {
    RoughnessConditions<Scalar> cut{};
    Scalar roughness_um{0};
};

template <typename Scalar>
struct RoughnessFit {
    RoughnessModel<Scalar> model{};
    RoughnessValues<Scalar> exponent_standard_error{};
    Scalar constant_ln_standard_error{0};   ///< of ln C, far outside the tests: R at their middle is known far better
    Scalar reference_um{0};                 ///< R at the geometric means of the tests …
    Scalar reference_ln_standard_error{0};  ///< … and how well it is known: s/√n
    Scalar determination{0};                ///< share of the variance of ln R that the model explains, 0…1
    int tests{0};
    int degrees_of_freedom{0};
    int worst_test{-1};        ///< index of the test furthest from the model …
    Scalar worst_residual{0};  ///< … in standard deviations of its own residual, s √(1 − h)
    unsigned undetermined{0};  ///< bit j: the tests cannot determine exponent j
    std::array<int, static_cast<std::size_t>(roughness_variable_count)> goes_with{};  ///< see variable_it_goes_with

    /// False: too few tests, or an exponent is not determined. `model` is then not to be used.
    [[nodiscard]] bool is_determined() const { return degrees_of_freedom > 0 && undetermined == 0U; }
    [[nodiscard]] bool determined(int j) const { return ((undetermined >> static_cast<unsigned>(j)) & 1U) == 0U; }
    /// Why exponent j is not determined: −1: its variable does not vary; else the variable that varies along with it.
    [[nodiscard]] int variable_it_goes_with(int j) const { return goes_with[static_cast<std::size_t>(j)]; }
};

namespace detail {

/// R⁻¹ of an upper triangle without a zero on its diagonal, column by column. Small loops: Eigen's general inverse and
/// products bring a heap with them.
template <typename Scalar, int N>
Eigen::Matrix<Scalar, N, N> inverse_of_triangle(const Eigen::Matrix<Scalar, N, N>& R) {
    Eigen::Matrix<Scalar, N, N> inverse = Eigen::Matrix<Scalar, N, N>::Zero();
    for (int column = 0; column < N; ++column) {
        inverse(column, column) = Scalar(1) / R(column, column);
        for (int row = column - 1; row >= 0; --row) {
            Scalar sum{0};
            for (int k = row + 1; k <= column; ++k) {
                sum += R(row, k) * inverse(k, column);
            }
            inverse(row, column) = -sum / R(row, row);
        }
    }
    return inverse;
}

template <typename Scalar>
class RoughnessFitSolver {
  public:
    RoughnessFitSolver(std::span<const RoughnessTest<Scalar>> tests, unsigned held) : tests_(tests), held_(held) {}

    RoughnessFit<Scalar> run() {
        if (!survey()) {
            return result_;
        }
        collect();
        const auto solution = squares_.solve();
        find_undetermined(solution);
        if (result_.is_determined()) {
            fill_model(solution);
            compare_with_tests();
        }
        return result_;
    }

  private:
    static constexpr int count = roughness_variable_count;
    static constexpr int parameters = count + 1;
    using Squares = LeastSquares<Scalar, parameters>;
    using Matrix = typename Squares::Matrix;
    using Vector = typename Squares::Vector;

    [[nodiscard]] bool is_held(int j) const { return ((held_ >> static_cast<unsigned>(j)) & 1U) != 0U; }

    [[nodiscard]] static bool is_usable(const RoughnessTest<Scalar>& test) {
        bool usable = test.roughness_um > Scalar(0) && test.roughness_um - test.roughness_um == Scalar(0);
        for (const Scalar value : test.cut) {
            usable = usable && value > Scalar(0) && value - value == Scalar(0);
        }
        return usable;
    }

    /// Geometric means and ranges; false where there are too few tests.
    bool survey();
    [[nodiscard]] Vector row_of(const RoughnessTest<Scalar>& test) const;
    void collect();
    void find_undetermined(const LeastSquaresSolution<Scalar, parameters>& solution);
    [[nodiscard]] int partner_of(int j, const Matrix& products) const;
    void fill_model(const LeastSquaresSolution<Scalar, parameters>& solution);
    void compare_with_tests();

    std::span<const RoughnessTest<Scalar>> tests_;
    unsigned held_;
    Squares squares_{};
    Matrix inverse_ = Matrix::Zero();  // (XᵀX)⁻¹
    RoughnessValues<Scalar> mean_ln_{};
    Scalar mean_ln_roughness_{0};
    Scalar ln_roughness_squares_{0};
    RoughnessFit<Scalar> result_{};
};

template <typename Scalar>
bool RoughnessFitSolver<Scalar>::survey() {
    using std::exp;
    using std::log;
    RoughnessModel<Scalar>& model = result_.model;
    for (const RoughnessTest<Scalar>& test : tests_) {
        if (!is_usable(test)) {
            continue;
        }
        const bool is_first = result_.tests == 0;
        ++result_.tests;
        mean_ln_roughness_ += log(test.roughness_um);
        for (std::size_t j = 0; j < test.cut.size(); ++j) {
            mean_ln_[j] += log(test.cut[j]);
            model.minimum[j] = is_first || test.cut[j] < model.minimum[j] ? test.cut[j] : model.minimum[j];
            model.maximum[j] = is_first || test.cut[j] > model.maximum[j] ? test.cut[j] : model.maximum[j];
        }
    }
    int fitted = parameters;
    for (int j = 0; j < count; ++j) {
        fitted -= is_held(j) ? 1 : 0;
    }
    result_.degrees_of_freedom = result_.tests - fitted;
    if (result_.degrees_of_freedom < 1) {
        return false;
    }
    const auto n = static_cast<Scalar>(result_.tests);
    mean_ln_roughness_ /= n;
    for (std::size_t j = 0; j < mean_ln_.size(); ++j) {
        mean_ln_[j] /= n;
        model.reference[j] = exp(mean_ln_[j]);
    }
    return true;
}

template <typename Scalar>
typename RoughnessFitSolver<Scalar>::Vector RoughnessFitSolver<Scalar>::row_of(
    const RoughnessTest<Scalar>& test) const {
    using std::log;
    Vector row = Vector::Zero();
    row(0) = Scalar(1);
    for (int j = 0; j < count; ++j) {
        const auto k = static_cast<std::size_t>(j);
        row(1 + j) = is_held(j) ? Scalar(0) : log(test.cut[k]) - mean_ln_[k];
    }
    return row;
}

template <typename Scalar>
void RoughnessFitSolver<Scalar>::collect() {
    using std::log;
    for (const RoughnessTest<Scalar>& test : tests_) {
        if (is_usable(test)) {
            const Scalar ln_R = log(test.roughness_um) - mean_ln_roughness_;
            squares_.add(row_of(test), ln_R);
            ln_roughness_squares_ += square(ln_R);
        }
    }
    for (int j = 0; j < count; ++j) {
        if (is_held(j)) {
            squares_.add_prior(1 + j, Scalar(0), Scalar(1));  // its column is zero: this decides it, and nothing else
        }
    }
}

template <typename Scalar>
int RoughnessFitSolver<Scalar>::partner_of(int j, const Matrix& products) const {
    using std::abs;
    using std::sqrt;
    int partner = -1;
    Scalar closest{0};
    for (int k = 0; k < count; ++k) {
        const Scalar lengths = sqrt(products(1 + j, 1 + j) * products(1 + k, 1 + k));
        const Scalar correlation = lengths > Scalar(0) ? abs(products(1 + j, 1 + k)) / lengths : Scalar(0);
        if (k != j && !is_held(k) && correlation > closest) {
            closest = correlation;
            partner = k;
        }
    }
    return partner;
}

template <typename Scalar>
void RoughnessFitSolver<Scalar>::find_undetermined(const LeastSquaresSolution<Scalar, parameters>& solution) {
    using std::sqrt;
    constexpr Scalar least_variation = static_cast<Scalar>(0.02L);
    const Matrix& R = squares_.triangle();
    const Matrix products = R.transpose().lazyProduct(R);
    const auto n = static_cast<Scalar>(result_.tests);
    const bool is_regular = solution.undetermined == 0U;
    if (is_regular) {
        const Matrix root = inverse_of_triangle<Scalar, parameters>(R);
        inverse_ = root.lazyProduct(root.transpose());
    }
    for (int j = 0; j < count; ++j) {
        if (is_held(j)) {
            continue;
        }
        const bool varies = sqrt(products(1 + j, 1 + j) / n) > least_variation;
        const bool varies_alone =
            is_regular ? Scalar(1) / sqrt(n * inverse_(1 + j, 1 + j)) > least_variation : solution.determined(1 + j);
        if (!varies || !varies_alone) {
            result_.undetermined |= 1U << static_cast<unsigned>(j);
            result_.goes_with[static_cast<std::size_t>(j)] = varies ? partner_of(j, products) : -1;
        }
    }
}

template <typename Scalar>
void RoughnessFitSolver<Scalar>::fill_model(const LeastSquaresSolution<Scalar, parameters>& solution) {
    using std::exp;
    using std::sqrt;
    RoughnessModel<Scalar>& model = result_.model;
    const auto n = static_cast<Scalar>(result_.tests);
    const Scalar s = solution.residual_sd;
    Scalar ln_C = mean_ln_roughness_ + solution.parameters(0);
    result_.reference_um = exp(ln_C);
    result_.reference_ln_standard_error = s / sqrt(n);
    Vector to_C = Vector::Unit(0);
    for (int j = 0; j < count; ++j) {
        const auto k = static_cast<std::size_t>(j);
        const Scalar scale = is_held(j) ? Scalar(0) : Scalar(1);
        model.exponent[k] = scale * solution.parameters(1 + j);
        result_.exponent_standard_error[k] = scale * solution.standard_error(1 + j);
        ln_C -= model.exponent[k] * mean_ln_[k];
        to_C(1 + j) = -scale * mean_ln_[k];
        for (int i = 0; i <= j; ++i) {
            const Scalar other = is_held(i) ? Scalar(0) : scale;
            model.leverage[model.pair(k, static_cast<std::size_t>(i))] = other * inverse_(1 + j, 1 + i);
        }
    }
    model.constant_um = exp(ln_C);
    result_.constant_ln_standard_error = s * sqrt(to_C.dot(inverse_.lazyProduct(to_C)));
    model.tests = n;
    model.degrees_of_freedom = static_cast<Scalar>(result_.degrees_of_freedom);
    model.residual_ln_sd = s;
    const Scalar residual_squares = square(s) * model.degrees_of_freedom;
    result_.determination =
        ln_roughness_squares_ > Scalar(0) ? Scalar(1) - residual_squares / ln_roughness_squares_ : Scalar(0);
}

template <typename Scalar>
void RoughnessFitSolver<Scalar>::compare_with_tests() {
    using std::abs;
    using std::log;
    using std::sqrt;
    RoughnessModel<Scalar>& model = result_.model;
    int index = 0;
    for (const RoughnessTest<Scalar>& test : tests_) {
        if (is_usable(test)) {
            const Vector row = row_of(test);
            const Scalar leverage = clamp(row.dot(inverse_.lazyProduct(row)), Scalar(0), Scalar(1));
            Scalar residual = log(test.roughness_um / result_.reference_um);
            for (int j = 0; j < count; ++j) {
                residual -= model.exponent[static_cast<std::size_t>(j)] * row(1 + j);
            }
            const Scalar sd = model.residual_ln_sd * sqrt(Scalar(1) - leverage);
            const Scalar standardised = sd > Scalar(0) ? abs(residual) / sd : Scalar(0);
            model.largest_leverage = leverage > model.largest_leverage ? leverage : model.largest_leverage;
            if (standardised > result_.worst_residual) {
                result_.worst_residual = standardised;
                result_.worst_test = index;
            }
        }
        ++index;
    }
}

}  // namespace detail

/// `held`: bit j: exponent j is not fitted and stays 0.
template <typename Scalar>
RoughnessFit<Scalar> fit_roughness(std::span<const RoughnessTest<Scalar>> tests, unsigned held = 0U) {
    return detail::RoughnessFitSolver<Scalar>(tests, held).run();
}

}  // namespace millforce::estimation
