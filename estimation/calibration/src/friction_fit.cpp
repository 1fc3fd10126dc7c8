// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/friction_fit.hpp"

#include "least_squares_in_double.hpp"

namespace millforce::estimation {

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

bool MechanicalFrictionFit::add(double velocity_m_s, double acceleration_m_s2, double motor_force_N) {
    const bool is_forward = velocity_m_s > minimum_speed_m_s_;
    const bool is_backward = velocity_m_s < -minimum_speed_m_s_;
    if (!is_forward && !is_backward) {
        return false;
    }
    const double forward = is_forward ? 1.0 : 0.0;
    const double backward = is_backward ? 1.0 : 0.0;
    Eigen::Matrix<double, 4, 1> symmetric;
    symmetric << acceleration_m_s2, velocity_m_s, forward - backward, 1.0;
    Eigen::Matrix<double, 5, 1> directional;
    directional << acceleration_m_s2, forward * velocity_m_s, backward * velocity_m_s, forward, -backward;
    return symmetric_.add(symmetric, motor_force_N) && directional_.add(directional, motor_force_N);
}

LeastSquaresSolution<double, 4> MechanicalFrictionFit::symmetric() const {
    return symmetric_.solve();
}

LeastSquaresSolution<double, 5> MechanicalFrictionFit::directional() const {
    return directional_.solve();
}

SymmetricFriction symmetric_friction(const LeastSquaresSolution<double, 4>& solution) {
    const auto& p = solution.parameters;
    return {p(symmetric_mass), p(symmetric_viscous), p(symmetric_coulomb), p(symmetric_offset)};
}

DirectionalFriction directional_friction(const LeastSquaresSolution<double, 5>& solution) {
    const auto& p = solution.parameters;
    return {p(directional_mass), p(positive_viscous), p(negative_viscous), p(positive_coulomb), p(negative_coulomb)};
}

bool FeedCurrentFit::add(double feed_m_per_min, double current_A, double minimum_feed_m_per_min) {
    const double w = feed_m_per_min;
    Eigen::Matrix<double, 6, 1> row;
    if (w > minimum_feed_m_per_min) {
        row << w * w, w, 0.0, 0.0, 1.0, 1.0;
    } else if (w < -minimum_feed_m_per_min) {
        row << 0.0, 0.0, -w * w, w, -1.0, 1.0;
    } else {
        return false;
    }
    return fit_.add(row, current_A);
}

LeastSquaresSolution<double, 6> FeedCurrentFit::solve() const {
    return fit_.solve();
}

double feed_friction_current_A(const Eigen::Matrix<double, 6, 1>& parameters, double feed_m_per_min) {
    const auto& p = parameters;
    const double w = feed_m_per_min;
    if (w > 0.0) {
        return (p(positive_K_x1) * w + p(positive_K_x2)) * w + p(common_K_x3) + p(gravity_offset);
    }
    return (-p(negative_K_x1) * w + p(negative_K_x2)) * w - p(common_K_x3) + p(gravity_offset);
}

}  // namespace millforce::estimation
