// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/finite.hpp"
#include "estimation/number/literal.hpp"

#include <Eigen/Core>

#include <cmath>
#include <limits>

/// Linear least squares, row by row, by a square-root update: y = xᵀθ + e with equal error variance after weighting.
///
/// Each row is rotated into an upper triangle R by Givens rotations (RᵀR = XᵀX without ever forming it), so that the
/// condition of the problem is not squared: float keeps what the normal equations would lose.
/// Memory: N² + N + 4 scalars. Cost: about 2N² operations per row; solve() one one-sided Jacobi decomposition of N × N.
/// No heap. Not thread-safe.

namespace millforce::estimation {

/// What the rows say about the parameters.
template <typename Scalar, int N>
struct LeastSquaresSolution {
    Eigen::Matrix<Scalar, N, 1> parameters = Eigen::Matrix<Scalar, N, 1>::Zero();
    /// s²(XᵀX)⁻¹, s² = Σe²/(rows − free parameters). An undetermined parameter has NaN in its row and column.
    Eigen::Matrix<Scalar, N, N> covariance = Eigen::Matrix<Scalar, N, N>::Zero();
    Scalar residual_rms{0};      ///< √(Σe²/rows), weighted.
    Scalar residual_sd{0};       ///< s; NaN without a degree of freedom.
    Scalar condition_number{0};  ///< that of X with its columns scaled to length 1; infinity where a column is zero.
    unsigned undetermined{0};    ///< bit j: the rows cannot determine parameter j (alone or apart from another one).
    int rows{0};

    bool determined(int j) const { return ((undetermined >> static_cast<unsigned>(j)) & 1U) == 0U; }

    /// Standard error of parameter j; NaN where it is undetermined or no degree of freedom is left.
    Scalar standard_error(int j) const {
        using std::sqrt;
        return sqrt(covariance(j, j));
    }
};

/// One-sided Jacobi: turns `columns` A into A V with orthogonal columns, whose lengths are the singular values of A,
/// and returns V. Accurate to the last digit of small singular values, where a decomposition of AᵀA keeps half of them.
template <typename Scalar, int N>
Eigen::Matrix<Scalar, N, N> orthogonalise_columns(Eigen::Matrix<Scalar, N, N>& columns) {
    using std::abs;
    using std::sqrt;
    constexpr int most_sweeps = 12;  // converges quadratically: 5 or 6 in practice
    Eigen::Matrix<Scalar, N, N> V = Eigen::Matrix<Scalar, N, N>::Identity();
    bool rotated = true;
    for (int sweep = 0; sweep < most_sweeps && rotated; ++sweep) {
        rotated = false;
        for (int p = 0; p < N - 1; ++p) {
            for (int q = p + 1; q < N; ++q) {
                const Scalar alpha = columns.col(p).squaredNorm();
                const Scalar beta = columns.col(q).squaredNorm();
                const Scalar gamma = columns.col(p).dot(columns.col(q));
                if (!(abs(gamma) > std::numeric_limits<Scalar>::epsilon() * sqrt(alpha * beta))) {
                    continue;
                }
                rotated = true;
                const Scalar zeta = (beta - alpha) / (gamma + gamma);
                const Scalar t =
                    (zeta < Scalar(0) ? Scalar(-1) : Scalar(1)) / (abs(zeta) + sqrt(Scalar(1) + zeta * zeta));
                const Scalar cosine = Scalar(1) / sqrt(Scalar(1) + t * t);
                const Scalar sine = cosine * t;
                const auto turn = [&](Eigen::Matrix<Scalar, N, N>& m) {
                    for (int k = 0; k < N; ++k) {
                        const Scalar left = m(k, p);
                        m(k, p) = cosine * left - sine * m(k, q);
                        m(k, q) = sine * left + cosine * m(k, q);
                    }
                };
                turn(columns);
                turn(V);
            }
        }
    }
    return V;
}

template <typename Scalar, int N>
class LeastSquares {
    static_assert(N > 0 && N <= 16);

  public:
    using Vector = Eigen::Matrix<Scalar, N, 1>;
    using Matrix = Eigen::Matrix<Scalar, N, N>;

    /// Adds weight · (value − regressorsᵀθ) to the errors to be minimised. Weight = 1/standard deviation, up to a
    /// factor common to all rows. A row that is not finite is left out: returns false.
    bool add(const Vector& regressors, Scalar value, Scalar weight = Scalar(1)) {
        if (!rotate(regressors, value, weight)) {
            return false;
        }
        ++rows_;
        return true;
    }

    /// Knowledge from elsewhere: parameter j is `mean`, within weight⁻¹ in the units of the weighted rows.
    void add_prior(int j, Scalar mean, Scalar weight) {
        if (rotate(Vector::Unit(j), mean, weight)) {
            ++priors_;
        }
    }

    /// `condition_limit`: singular values of the scaled problem below the largest divided by this count as zero.
    LeastSquaresSolution<Scalar, N> solve(Scalar condition_limit = Scalar(1e4)) const;

    int rows() const { return rows_; }

    /// R of RᵀR = XᵀX, upper triangular: what the rows say apart from their values.
    const Matrix& triangle() const { return R_; }

    /// Σe² of the best fit so far, weighted.
    Scalar residual_sum_of_squares() const { return residual_sum_of_squares_; }

  private:
    bool rotate(Vector x, Scalar y, Scalar weight);
    /// Factors that bring the columns to length 1; 0 for a column of zeros.
    Vector column_scale() const;
    /// Residuals and covariance. `scaled_root`: (XᵀX)⁺ = scaled_root scaled_rootᵀ.
    void fill_errors(const Matrix& scaled_root, Scalar unexplained, LeastSquaresSolution<Scalar, N>& solution) const;

    Matrix R_ = Matrix::Zero();
    Vector z_ = Vector::Zero();
    Scalar residual_sum_of_squares_{0};
    int rows_{0};
    int priors_{0};
};

template <typename Scalar, int N>
bool LeastSquares<Scalar, N>::rotate(Vector x, Scalar y, Scalar weight) {
    using std::sqrt;
    x *= weight;
    y *= weight;
    if (!is_finite(x.squaredNorm()) || !is_finite(y * y)) {
        return false;
    }
    for (int k = 0; k < N; ++k) {
        if (x(k) == Scalar(0)) {
            continue;
        }
        const Scalar length = sqrt(R_(k, k) * R_(k, k) + x(k) * x(k));
        if (!(length > Scalar(0))) {
            continue;
        }
        const Scalar cosine = R_(k, k) / length;
        const Scalar sine = x(k) / length;
        for (int j = k; j < N; ++j) {
            const Scalar upper = R_(k, j);
            R_(k, j) = cosine * upper + sine * x(j);
            x(j) = cosine * x(j) - sine * upper;
        }
        const Scalar upper = z_(k);
        z_(k) = cosine * upper + sine * y;
        y = cosine * y - sine * upper;
    }
    residual_sum_of_squares_ += y * y;
    return true;
}

template <typename Scalar, int N>
typename LeastSquares<Scalar, N>::Vector LeastSquares<Scalar, N>::column_scale() const {
    Vector scale;
    for (int j = 0; j < N; ++j) {
        const Scalar length = R_.col(j).norm();
        scale(j) = length > Scalar(0) ? Scalar(1) / length : Scalar(0);
    }
    return scale;
}

template <typename Scalar, int N>
void LeastSquares<Scalar, N>::fill_errors(const Matrix& scaled_root, Scalar unexplained,
                                          LeastSquaresSolution<Scalar, N>& solution) const {
    using std::sqrt;
    const Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
    const int free_rows = rows_ + priors_ - N;
    solution.residual_rms = rows_ > 0 ? sqrt(unexplained / static_cast<Scalar>(rows_)) : nan;
    solution.residual_sd = free_rows > 0 ? sqrt(unexplained / static_cast<Scalar>(free_rows)) : nan;
    // Lazy: the usual product of matrices this large holds a way to the heap.
    solution.covariance = scaled_root.lazyProduct(scaled_root.transpose());
    solution.covariance *= solution.residual_sd * solution.residual_sd;
    for (int j = 0; j < N; ++j) {
        if (!solution.determined(j)) {
            solution.covariance.row(j).setConstant(nan);
            solution.covariance.col(j).setConstant(nan);
        }
    }
}

template <typename Scalar, int N>
LeastSquaresSolution<Scalar, N> LeastSquares<Scalar, N>::solve(Scalar condition_limit) const {
    const Scalar infinity = std::numeric_limits<Scalar>::infinity();
    LeastSquaresSolution<Scalar, N> solution;
    solution.rows = rows_;

    const Vector scale = column_scale();
    Matrix scaled = R_ * scale.asDiagonal();
    const Matrix V = orthogonalise_columns<Scalar, N>(scaled);
    Vector singular;
    for (int k = 0; k < N; ++k) {
        singular(k) = scaled.col(k).norm();
    }
    const Scalar largest = singular.maxCoeff();
    const Scalar smallest = singular.minCoeff();
    solution.condition_number = smallest > Scalar(0) ? largest / smallest : infinity;

    // A parameter with more than this share in a direction that the rows do not see is not determined by them.
    constexpr Scalar smallest_share = literal<Scalar>(0.03L);
    Matrix root = Matrix::Zero();  // V Σ⁺, so that (XᵀX)⁺ = root rootᵀ
    Vector unscaled = Vector::Zero();
    Scalar explained{0};
    for (int k = 0; k < N; ++k) {
        if (singular(k) > largest / condition_limit) {
            const Scalar along = scaled.col(k).dot(z_) / singular(k);
            root.col(k) = V.col(k) / singular(k);
            unscaled += root.col(k) * along;
            explained += along * along;
            continue;
        }
        for (int j = 0; j < N; ++j) {
            if (V(j, k) * V(j, k) > smallest_share * smallest_share) {
                solution.undetermined |= 1U << static_cast<unsigned>(j);
            }
        }
    }
    const Scalar left_over = z_.squaredNorm() - explained;
    const Scalar unexplained =
        residual_sum_of_squares_ + (solution.undetermined != 0U && left_over > Scalar(0) ? left_over : Scalar(0));
    for (int j = 0; j < N; ++j) {
        if (!(scale(j) > Scalar(0))) {
            solution.undetermined |= 1U << static_cast<unsigned>(j);
        }
    }
    solution.parameters = scale.asDiagonal() * unscaled;
    fill_errors(scale.asDiagonal() * root, unexplained, solution);
    return solution;
}

}  // namespace millforce::estimation
