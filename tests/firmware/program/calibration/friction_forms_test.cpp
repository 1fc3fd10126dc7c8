// SPDX-License-Identifier: Apache-2.0
#include "calibration/axis_motion.hpp"

#include <CppUTest/TestHarness.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

using namespace millforce::host;

/// Which forms of friction the measured axis has: each is fitted to one half of the record and foretells the other.

namespace {

struct Moment {
    double velocity_m_s = 0.0;
    double acceleration_m_s2 = 0.0;
    double position_m = 0.0;
    double time_s = 0.0;
    double force_N = 0.0;
};

using Terms = std::function<std::vector<double>(const Moment&)>;

std::vector<Moment> moving_axis() {
    constexpr double slowest_m_s = 0.002;
    const AxisMotion motion = read_axis_motion(MILLFORCE_TEST_DATA "/ball_screw_axis_200hz.csv", 20.0);
    std::vector<Moment> moments;
    double position_m = 0.0;
    for (std::size_t k = 0; k < motion.velocity_m_s.size(); ++k) {
        position_m += motion.velocity_m_s[k] * motion.dt_s;
        if (std::abs(motion.velocity_m_s[k]) > slowest_m_s) {
            moments.push_back({motion.velocity_m_s[k], motion.acceleration_m_s2[k], position_m,
                               static_cast<double>(k) * motion.dt_s, motion.motor_force_N[k]});
        }
    }
    return moments;
}

Eigen::MatrixXd terms_of(const Terms& terms, const std::vector<Moment>& moments) {
    const auto width = static_cast<Eigen::Index>(terms(moments.front()).size());
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(moments.size()), width);
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const std::vector<double> row = terms(moments[k]);
        matrix.row(static_cast<Eigen::Index>(k)) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), width);
    }
    return matrix;
}

Eigen::VectorXd forces_of(const std::vector<Moment>& moments) {
    Eigen::VectorXd forces(static_cast<Eigen::Index>(moments.size()));
    for (std::size_t k = 0; k < moments.size(); ++k) {
        forces(static_cast<Eigen::Index>(k)) = moments[k].force_N;
    }
    return forces;
}

Eigen::VectorXd fitted(const Terms& terms, const std::vector<Moment>& moments) {
    const Eigen::MatrixXd matrix = terms_of(terms, moments);
    return (matrix.transpose() * matrix).ldlt().solve(matrix.transpose() * forces_of(moments));
}

/// Of both halves, each foretold by the other, N rms.
double held_out_N(const Terms& terms) {
    const std::vector<Moment> all = moving_axis();
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    const std::vector<Moment> halves[] = {{all.begin(), middle}, {middle, all.end()}};
    double squares_N2 = 0.0;
    for (const int k : {0, 1}) {
        const Eigen::VectorXd parameters = fitted(terms, halves[k]);
        squares_N2 += (forces_of(halves[1 - k]) - terms_of(terms, halves[1 - k]) * parameters).squaredNorm();
    }
    return std::sqrt(squares_N2 / static_cast<double>(all.size()));
}

double sign_of(double velocity) {
    return velocity > 0.0 ? 1.0 : -1.0;
}

std::vector<double> same_both_ways(const Moment& m) {
    return {m.acceleration_m_s2, m.velocity_m_s, sign_of(m.velocity_m_s), 1.0};
}

std::vector<double> by_direction(const Moment& m) {
    const bool forth = m.velocity_m_s > 0.0;
    const double v = m.velocity_m_s;
    return {m.acceleration_m_s2, forth ? v : 0.0, forth ? 0.0 : v, forth ? 1.0 : 0.0, forth ? 0.0 : 1.0};
}

Terms by_direction_and(std::function<std::vector<double>(const Moment&)> more) {
    return [more = std::move(more)](const Moment& m) {
        std::vector<double> terms = by_direction(m);
        const std::vector<double> others = more(m);
        terms.insert(terms.end(), others.begin(), others.end());
        return terms;
    };
}

Terms with_stribeck(double speed_m_s) {
    return by_direction_and([speed_m_s](const Moment& m) -> std::vector<double> {
        return {sign_of(m.velocity_m_s) * std::exp(-std::abs(m.velocity_m_s) / speed_m_s)};
    });
}

}  // namespace

TEST_GROUP(FrictionForms){};

TEST(FrictionForms, the_measured_axis_has_another_friction_in_each_direction) {
    CHECK(held_out_N(by_direction) < 0.8 * held_out_N(same_both_ways));
}

TEST(FrictionForms, the_measured_axis_shows_no_stribeck_friction_it_grows_from_rest_on) {
    for (const double speed_m_s : {0.002, 0.005, 0.01, 0.02, 0.05}) {
        const Eigen::VectorXd parameters = fitted(with_stribeck(speed_m_s), moving_axis());
        CHECK(parameters(parameters.size() - 1) < 0.0);
    }
}

TEST(FrictionForms, what_a_stribeck_term_gains_on_the_measured_axis_the_curvature_K_x1_gains_too) {
    const Terms with_curvature = by_direction_and(
        [](const Moment& m) -> std::vector<double> { return {m.velocity_m_s * std::abs(m.velocity_m_s)}; });
    const double plain_N = held_out_N(by_direction);
    CHECK(held_out_N(with_curvature) < 0.97 * plain_N);
    for (const double speed_m_s : {0.002, 0.005, 0.01, 0.02, 0.05}) {
        CHECK(held_out_N(with_stribeck(speed_m_s)) > held_out_N(with_curvature) - 0.05 * plain_N);
    }
}

TEST(FrictionForms, a_term_for_each_turn_of_the_screw_foretells_the_measured_axis_no_better) {
    for (const double lead_mm : {4.0, 5.0, 8.0, 10.0, 12.7, 16.0, 20.0, 25.0}) {
        const Terms turning = by_direction_and([lead_mm](const Moment& m) -> std::vector<double> {
            const double turn = 2.0 * std::numbers::pi * m.position_m / (1e-3 * lead_mm);
            return {std::cos(turn), std::sin(turn)};
        });
        CHECK(held_out_N(turning) > 0.98 * held_out_N(by_direction));
    }
}

TEST(FrictionForms, a_drift_in_time_foretells_the_measured_axis_no_better) {
    const Terms drifting = by_direction_and(
        [](const Moment& m) -> std::vector<double> { return {sign_of(m.velocity_m_s) * (m.time_s - 12.4)}; });
    CHECK(held_out_N(drifting) > held_out_N(by_direction));
}
