// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/friction_fit.hpp"

#include "least_squares_in_double.hpp"

#include <cmath>

namespace millforce::estimation {

namespace {

template <int N>
LeastSquaresSolution<double, N> solve_without(LeastSquares<double, N> fit, unsigned held_at_zero) {
    constexpr double outweighing = 1e9;  // all rows together
    for (int j = 0; j < N; ++j) {
        if (((held_at_zero >> static_cast<unsigned>(j)) & 1U) != 0U) {
            fit.add_prior(j, 0.0, outweighing);
        }
    }
    return fit.solve();
}

}  // namespace

double SymmetricFriction::force_N(double velocity_m_s, double acceleration_m_s2) const {
    const double direction = velocity_m_s > 0.0 ? 1.0 : (velocity_m_s < 0.0 ? -1.0 : 0.0);
    return mass_kg * acceleration_m_s2 + viscous_N_s_per_m * velocity_m_s + coulomb_N * direction + offset_N;
}

double DirectionalFriction::force_N(double velocity_m_s, double acceleration_m_s2) const {
    const double inertia_N = mass_kg * acceleration_m_s2;
    if (velocity_m_s > 0.0) {
        return inertia_N + positive_viscous_N_s_per_m * velocity_m_s + positive_coulomb_N;
    }
    if (velocity_m_s < 0.0) {
        return inertia_N + negative_viscous_N_s_per_m * velocity_m_s - negative_coulomb_N;
    }
    return inertia_N;
}

Eigen::Matrix<double, 5, 1> directional_regressors(double velocity_m_s, double acceleration_m_s2) {
    const double forward = velocity_m_s > 0.0 ? 1.0 : 0.0;
    const double backward = velocity_m_s < 0.0 ? 1.0 : 0.0;
    Eigen::Matrix<double, 5, 1> row;
    row << acceleration_m_s2, forward * velocity_m_s, backward * velocity_m_s, forward, -backward;
    return row;
}

bool MechanicalFrictionFit::add(double velocity_m_s, double acceleration_m_s2, double motor_force_N) {
    const bool is_forward = velocity_m_s > minimum_speed_m_s_;
    const bool is_backward = velocity_m_s < -minimum_speed_m_s_;
    if (!is_forward && !is_backward) {
        return false;
    }
    Eigen::Matrix<double, 4, 1> symmetric;
    symmetric << acceleration_m_s2, velocity_m_s, is_forward ? 1.0 : -1.0, 1.0;
    return symmetric_.add(symmetric, motor_force_N) &&
           directional_.add(directional_regressors(velocity_m_s, acceleration_m_s2), motor_force_N);
}

LeastSquaresSolution<double, 4> MechanicalFrictionFit::symmetric(unsigned held_at_zero) const {
    return solve_without(symmetric_, held_at_zero);
}

LeastSquaresSolution<double, 5> MechanicalFrictionFit::directional(unsigned held_at_zero) const {
    return solve_without(directional_, held_at_zero);
}

SymmetricFriction symmetric_friction(const LeastSquaresSolution<double, 4>& solution) {
    const auto& p = solution.parameters;
    return {p(symmetric_mass), p(symmetric_viscous), p(symmetric_coulomb), p(symmetric_offset)};
}

DirectionalFriction directional_friction(const LeastSquaresSolution<double, 5>& solution) {
    const auto& p = solution.parameters;
    return {p(directional_mass), p(positive_viscous), p(negative_viscous), p(positive_coulomb), p(negative_coulomb)};
}

Eigen::Matrix<double, 6, 1> feed_current_regressors(double feed_m_per_min) {
    const double w = feed_m_per_min;
    Eigen::Matrix<double, 6, 1> row;
    if (w > 0.0) {
        row << w * w, w, 0.0, 0.0, 1.0, 1.0;
    } else {
        row << 0.0, 0.0, -w * w, w, -1.0, 1.0;
    }
    return row;
}

bool FeedCurrentFit::add(double feed_m_per_min, double current_A, double minimum_feed_m_per_min) {
    return std::abs(feed_m_per_min) > minimum_feed_m_per_min &&
           fit_.add(feed_current_regressors(feed_m_per_min), current_A);
}

LeastSquaresSolution<double, 6> FeedCurrentFit::solve(unsigned held_at_zero) const {
    return solve_without(fit_, held_at_zero);
}

double feed_friction_current_A(const Eigen::Matrix<double, 6, 1>& parameters, double feed_m_per_min) {
    return parameters.dot(feed_current_regressors(feed_m_per_min));
}

}  // namespace millforce::estimation
