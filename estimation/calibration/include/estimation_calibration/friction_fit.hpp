// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"

/// Friction and inertia of an unloaded feed axis, from its motion and its motor's force or current.
///
/// Two forms:
///  - Mechanical: F_motor = M a + F_v v + F_c sign(v) + offset (Janot, Gautier, Brunot 2019), and the same with F_v and
///    F_c of their own in each direction.
///  - The quadratic current I_f(w) = K_x1 w² + K_x2 w + K_x3 at steady feed w in m/min (Kim & Chung Eq. 9), with
///    separate K_x1 and K_x2 for each direction, and a gravity offset.
///
/// In steady motion without load, a constant that pulls one way (gravity, cable drag) and a difference of the dry
/// friction between the directions are one and the same: half the sum of the two intercepts. The mechanical form by
/// direction keeps two F_c and no offset; the quadratic form keeps one K_x3 and an offset. Neither fit invents the
/// separation.
///
/// At rest friction is not a function of velocity (pre-sliding: the axis holds any force up to F_c), so samples slower
/// than a floor are left out.

namespace millforce::estimation {

/// F = M a + F_v v + F_c sign(v) + offset.
struct SymmetricFriction {
    double mass_kg = 0.0;
    double viscous_N_s_per_m = 0.0;
    double coulomb_N = 0.0;
    double offset_N = 0.0;

    [[nodiscard]] double force_N(double velocity_m_s, double acceleration_m_s2) const;
};

/// F = M a + F_v± v ± F_c±, the sign of v choosing. At v = 0 friction is unknown: the force then holds M a alone.
struct DirectionalFriction {
    double mass_kg = 0.0;
    double positive_viscous_N_s_per_m = 0.0;
    double negative_viscous_N_s_per_m = 0.0;
    double positive_coulomb_N = 0.0;
    double negative_coulomb_N = 0.0;

    [[nodiscard]] double force_N(double velocity_m_s, double acceleration_m_s2) const;
};

/// Order of the parameters in the solution of MechanicalFrictionFit::symmetric().
enum SymmetricFrictionIndex : int { symmetric_mass, symmetric_viscous, symmetric_coulomb, symmetric_offset };

/// Order of the parameters in the solution of MechanicalFrictionFit::directional().
enum DirectionalFrictionIndex : int {
    directional_mass,
    positive_viscous,
    negative_viscous,
    positive_coulomb,
    negative_coulomb
};

/// What the parameters of MechanicalFrictionFit::directional() are multiplied with. v ≠ 0.
[[nodiscard]] Eigen::Matrix<double, 5, 1> directional_regressors(double velocity_m_s, double acceleration_m_s2);

/// Collects samples of an unloaded axis; both forms can be read at any time. `held_at_zero`, bit j: parameter j is 0,
/// and the others are fitted without it.
class MechanicalFrictionFit {
  public:
    /// Samples with |v| ≤ `minimum_speed_m_s` are left out as pre-sliding.
    explicit MechanicalFrictionFit(double minimum_speed_m_s) : minimum_speed_m_s_(minimum_speed_m_s) {}

    /// Returns whether the sample was used.
    bool add(double velocity_m_s, double acceleration_m_s2, double motor_force_N);

    [[nodiscard]] LeastSquaresSolution<double, 4> symmetric(unsigned held_at_zero = 0) const;
    [[nodiscard]] LeastSquaresSolution<double, 5> directional(unsigned held_at_zero = 0) const;

  private:
    double minimum_speed_m_s_;
    LeastSquares<double, 4> symmetric_;
    LeastSquares<double, 5> directional_;
};

[[nodiscard]] SymmetricFriction symmetric_friction(const LeastSquaresSolution<double, 4>& solution);
[[nodiscard]] DirectionalFriction directional_friction(const LeastSquaresSolution<double, 5>& solution);

/// Order of the parameters in the solution of FeedCurrentFit.
enum FeedCurrentIndex : int {
    positive_K_x1,   ///< A·min²/m²
    positive_K_x2,   ///< A·min/m
    negative_K_x1,   ///< A·min²/m²
    negative_K_x2,   ///< A·min/m
    common_K_x3,     ///< A
    gravity_offset,  ///< A
};

/// I = K_x1+ w² + K_x2+ w + K_x3 + g for w > 0;  I = −(K_x1− w² + K_x2− |w| + K_x3) + g for w < 0.
/// w in m/min (Kim & Chung Eq. 9), I in A. One row is one steady air cut. Determining all six takes three different
/// feeds in each direction; one direction alone cannot separate K_x3 from g, and both are then marked undetermined.
class FeedCurrentFit {
  public:
    /// Rows with |w| ≤ `minimum_feed_m_per_min` are left out. Returns whether the row was used.
    bool add(double feed_m_per_min, double current_A, double minimum_feed_m_per_min = 0.0);

    /// `held_at_zero`: as for MechanicalFrictionFit.
    [[nodiscard]] LeastSquaresSolution<double, 6> solve(unsigned held_at_zero = 0) const;

  private:
    LeastSquares<double, 6> fit_;
};

/// What the parameters of FeedCurrentFit are multiplied with. w ≠ 0.
[[nodiscard]] Eigen::Matrix<double, 6, 1> feed_current_regressors(double feed_m_per_min);

/// The current by FeedCurrentFit's parameters at feed w ≠ 0.
[[nodiscard]] double feed_friction_current_A(const Eigen::Matrix<double, 6, 1>& parameters, double feed_m_per_min);

}  // namespace millforce::estimation
