// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/roughness_fit.hpp"

#include "least_squares_in_double.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::estimation {

namespace {

constexpr int variables = roughness_variable_count;
constexpr int parameters = variables + 1;

/// Rms of a logarithm about its mean, or about what the other variables explain of it.
constexpr double least_variation = 0.02;

class RoughnessFitSolver {
  public:
    RoughnessFitSolver(std::span<const RoughnessTest> tests, unsigned held) : tests_(tests), held_(held) {}

    RoughnessFit run() {
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
    using Squares = LeastSquares<double, parameters>;
    using Solution = LeastSquaresSolution<double, parameters>;
    using Matrix = Squares::Matrix;
    using Vector = Squares::Vector;

    bool survey();
    void collect();
    void find_undetermined(const Solution& solution);
    void fill_model(const Solution& solution);
    void compare_with_tests();

    [[nodiscard]] bool is_held(int j) const { return ((held_ >> static_cast<unsigned>(j)) & 1U) != 0U; }
    [[nodiscard]] static bool is_usable(const RoughnessTest& test);
    [[nodiscard]] Vector row_of(const RoughnessTest& test) const;
    [[nodiscard]] int partner_of(int j, const Matrix& products) const;

    std::span<const RoughnessTest> tests_;
    unsigned held_;
    Squares squares_{};
    Matrix inverse_ = Matrix::Zero();  // (XᵀX)⁻¹
    RoughnessValues<double> mean_ln_{};
    double mean_ln_roughness_ = 0.0;
    double ln_roughness_squares_ = 0.0;
    RoughnessFit result_{};
};

bool RoughnessFitSolver::is_usable(const RoughnessTest& test) {
    const auto is_positive = [](double value) { return value > 0.0 && std::isfinite(value); };
    return is_positive(test.roughness_um) && std::ranges::all_of(test.cut, is_positive);
}

/// Geometric means and ranges. Returns whether there are enough tests.
bool RoughnessFitSolver::survey() {
    RoughnessModel<double>& model = result_.model;
    for (const RoughnessTest& test : tests_) {
        if (!is_usable(test)) {
            continue;
        }
        const bool is_first = result_.tests == 0;
        ++result_.tests;
        mean_ln_roughness_ += std::log(test.roughness_um);
        for (std::size_t j = 0; j < test.cut.size(); ++j) {
            mean_ln_[j] += std::log(test.cut[j]);
            model.minimum[j] = is_first ? test.cut[j] : std::min(test.cut[j], model.minimum[j]);
            model.maximum[j] = is_first ? test.cut[j] : std::max(test.cut[j], model.maximum[j]);
        }
    }
    int fitted = parameters;
    for (int j = 0; j < variables; ++j) {
        fitted -= is_held(j) ? 1 : 0;
    }
    result_.degrees_of_freedom = result_.tests - fitted;
    if (result_.degrees_of_freedom < 1) {
        return false;
    }
    mean_ln_roughness_ /= result_.tests;
    for (std::size_t j = 0; j < mean_ln_.size(); ++j) {
        mean_ln_[j] /= result_.tests;
        model.reference[j] = std::exp(mean_ln_[j]);
    }
    return true;
}

RoughnessFitSolver::Vector RoughnessFitSolver::row_of(const RoughnessTest& test) const {
    Vector row = Vector::Zero();
    row(0) = 1.0;
    for (int j = 0; j < variables; ++j) {
        const auto k = static_cast<std::size_t>(j);
        row(1 + j) = is_held(j) ? 0.0 : std::log(test.cut[k]) - mean_ln_[k];
    }
    return row;
}

void RoughnessFitSolver::collect() {
    for (const RoughnessTest& test : tests_) {
        if (is_usable(test)) {
            const double ln_R = std::log(test.roughness_um) - mean_ln_roughness_;
            squares_.add(row_of(test), ln_R);
            ln_roughness_squares_ += ln_R * ln_R;
        }
    }
    for (int j = 0; j < variables; ++j) {
        if (is_held(j)) {
            squares_.add_prior(1 + j, 0.0, 1.0);  // its column is zero: any weight holds it at 0
        }
    }
}

/// The variable whose logarithm is correlated most with that of variable j; −1: none.
int RoughnessFitSolver::partner_of(int j, const Matrix& products) const {
    int partner = -1;
    double closest = 0.0;
    for (int k = 0; k < variables; ++k) {
        const double lengths = std::sqrt(products(1 + j, 1 + j) * products(1 + k, 1 + k));
        const double correlation = lengths > 0.0 ? std::abs(products(1 + j, 1 + k)) / lengths : 0.0;
        if (k != j && !is_held(k) && correlation > closest) {
            closest = correlation;
            partner = k;
        }
    }
    return partner;
}

void RoughnessFitSolver::find_undetermined(const Solution& solution) {
    const Matrix& R = squares_.triangle();
    const Matrix products = R.transpose() * R;  // XᵀX
    const double n = result_.tests;
    const bool is_regular = solution.undetermined == 0U;
    if (is_regular) {
        const Matrix root = R.triangularView<Eigen::Upper>().solve(Matrix::Identity());
        inverse_ = root * root.transpose();
    }
    for (int j = 0; j < variables; ++j) {
        if (is_held(j)) {
            continue;
        }
        const bool varies = std::sqrt(products(1 + j, 1 + j) / n) > least_variation;
        const bool varies_alone =
            is_regular ? 1.0 / std::sqrt(n * inverse_(1 + j, 1 + j)) > least_variation : solution.determined(1 + j);
        if (!varies || !varies_alone) {
            result_.undetermined |= 1U << static_cast<unsigned>(j);
            result_.goes_with[static_cast<std::size_t>(j)] = varies ? partner_of(j, products) : -1;
        }
    }
}

void RoughnessFitSolver::fill_model(const Solution& solution) {
    RoughnessModel<double>& model = result_.model;
    const double s = solution.residual_sd;
    double ln_C = mean_ln_roughness_ + solution.parameters(0);
    result_.reference_um = std::exp(ln_C);
    result_.reference_ln_standard_error = s / std::sqrt(result_.tests);
    Vector to_C = Vector::Unit(0);
    for (int j = 0; j < variables; ++j) {
        if (is_held(j)) {
            continue;
        }
        const auto k = static_cast<std::size_t>(j);
        model.exponent[k] = solution.parameters(1 + j);
        result_.exponent_standard_error[k] = solution.standard_error(1 + j);
        ln_C -= model.exponent[k] * mean_ln_[k];
        to_C(1 + j) = -mean_ln_[k];
        for (int i = 0; i <= j; ++i) {
            model.leverage[RoughnessModel<double>::pair(k, static_cast<std::size_t>(i))] =
                is_held(i) ? 0.0 : inverse_(1 + j, 1 + i);
        }
    }
    model.constant_um = std::exp(ln_C);
    result_.constant_ln_standard_error = s * std::sqrt(to_C.dot(inverse_ * to_C));
    model.tests = result_.tests;
    model.degrees_of_freedom = result_.degrees_of_freedom;
    model.residual_ln_sd = s;
    const double residual_squares = s * s * model.degrees_of_freedom;
    result_.determination = ln_roughness_squares_ > 0.0 ? 1.0 - residual_squares / ln_roughness_squares_ : 0.0;
}

void RoughnessFitSolver::compare_with_tests() {
    RoughnessModel<double>& model = result_.model;
    for (std::size_t index = 0; index < tests_.size(); ++index) {
        const RoughnessTest& test = tests_[index];
        if (!is_usable(test)) {
            continue;
        }
        const Vector row = row_of(test);
        const double leverage = std::clamp(row.dot(inverse_ * row), 0.0, 1.0);
        double residual = std::log(test.roughness_um / result_.reference_um);
        for (int j = 0; j < variables; ++j) {
            residual -= model.exponent[static_cast<std::size_t>(j)] * row(1 + j);
        }
        const double sd = model.residual_ln_sd * std::sqrt(1.0 - leverage);
        const double standardised = sd > 0.0 ? std::abs(residual) / sd : 0.0;
        model.largest_leverage = std::max(leverage, model.largest_leverage);
        if (standardised > result_.worst_residual) {
            result_.worst_residual = standardised;
            result_.worst_test = static_cast<int>(index);
        }
    }
}

template <std::size_t N>
void narrow(const std::array<double, N>& from, std::array<float, N>& to) {
    std::ranges::transform(from, to.begin(), [](double value) { return static_cast<float>(value); });
}

}  // namespace

RoughnessFit fit_roughness(std::span<const RoughnessTest> tests, unsigned held) {
    return RoughnessFitSolver(tests, held).run();
}

RoughnessModel<float> in_float(const RoughnessModel<double>& model) {
    RoughnessModel<float> result;
    result.measure = model.measure;
    result.constant_um = static_cast<float>(model.constant_um);
    narrow(model.exponent, result.exponent);
    narrow(model.minimum, result.minimum);
    narrow(model.maximum, result.maximum);
    narrow(model.reference, result.reference);
    result.tests = static_cast<float>(model.tests);
    result.degrees_of_freedom = static_cast<float>(model.degrees_of_freedom);
    result.residual_ln_sd = static_cast<float>(model.residual_ln_sd);
    narrow(model.leverage, result.leverage);
    result.largest_leverage = static_cast<float>(model.largest_leverage);
    return result;
}

}  // namespace millforce::estimation
