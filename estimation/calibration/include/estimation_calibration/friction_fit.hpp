// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/least_squares.hpp"

#include <cmath>

/// Friction and inertia of an unloaded feed axis, from its motion and its motor's force or current.
///
/// Two forms:
///  - Mechanical: F_motor = M a + F_v v + F_c sign(v) + offset (Janot, Gautier, Brunot 2019), and the same with F_v and
///    F_c of their own in each direction.
///  - The quadratic current I_f(w) = K_x1 w² + K_x2 w + K_x3 at steady feed w in m/min (Kim & Chung Eq. 9), with K_x1
///  and
///    K_x2 of their own in each direction and a gravity offset.
///
/// In steady motion without load, a constant that pulls one way (gravity, cable drag) and a difference of the dry
/// friction between the directions are one and the same: half the sum of the two intercepts. The mechanical form by
/// direction keeps two F_c and no offset; the quadratic form keeps one K_x3 and an offset. Neither fit invents the
/// separation.
///
/// At rest friction is not a function of velocity (pre-sliding: the axis holds any force up to F_c), so samples slower
/// than a floor are left out.

namespace millforce::estimation {

/// F = M a + F_v v + F_c sign(v) + offset. Units N, kg, m, s.
template <typename Scalar>
struct SymmetricFriction {
    Scalar mass_kg{0};
    Scalar viscous_N_s_per_m{0};
    Scalar coulomb_N{0};
    Scalar offset_N{0};

    Scalar force_N(Scalar velocity_m_s, Scalar acceleration_m_s2) const {
        const Scalar direction =
            velocity_m_s > Scalar(0) ? Scalar(1) : (velocity_m_s < Scalar(0) ? Scalar(-1) : Scalar(0));
        return mass_kg * acceleration_m_s2 + viscous_N_s_per_m * velocity_m_s + coulomb_N * direction + offset_N;
    }
};

/// F = M a + F_v± v ± F_c±, the sign of v choosing. At v = 0 the friction part is 0: unknown, and not to be used.
template <typename Scalar>
struct DirectionalFriction {
    Scalar mass_kg{0};
    Scalar positive_viscous_N_s_per_m{0};
    Scalar negative_viscous_N_s_per_m{0};
    Scalar positive_coulomb_N{0};
    Scalar negative_coulomb_N{0};

    Scalar force_N(Scalar velocity_m_s, Scalar acceleration_m_s2) const {
        const Scalar inertia = mass_kg * acceleration_m_s2;
        if (velocity_m_s > Scalar(0)) {
            return inertia + positive_viscous_N_s_per_m * velocity_m_s + positive_coulomb_N;
        }
        if (velocity_m_s < Scalar(0)) {
            return inertia + negative_viscous_N_s_per_m * velocity_m_s - negative_coulomb_N;
        }
        return inertia;
    }
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

/// Collects samples of an unloaded axis; both forms can be read at any time.
template <typename Scalar>
class MechanicalFrictionFit {
  public:
    /// Samples with |v| ≤ `minimum_speed_m_s` are left out as pre-sliding.
    explicit MechanicalFrictionFit(Scalar minimum_speed_m_s) : minimum_speed_m_s_(minimum_speed_m_s) {}

    /// Returns whether the sample was used.
    bool add(Scalar velocity_m_s, Scalar acceleration_m_s2, Scalar motor_force_N) {
        const bool forward = velocity_m_s > minimum_speed_m_s_;
        const bool backward = velocity_m_s < -minimum_speed_m_s_;
        if (!forward && !backward) {
            return false;
        }
        const Scalar direction = forward ? Scalar(1) : Scalar(-1);
        const Scalar v_forward = forward ? velocity_m_s : Scalar(0);
        const Scalar v_backward = backward ? velocity_m_s : Scalar(0);
        Eigen::Matrix<Scalar, 4, 1> symmetric;
        symmetric << acceleration_m_s2, velocity_m_s, direction, Scalar(1);
        Eigen::Matrix<Scalar, 5, 1> directional;
        directional << acceleration_m_s2, v_forward, v_backward, forward ? Scalar(1) : Scalar(0),
            backward ? Scalar(-1) : Scalar(0);
        return symmetric_.add(symmetric, motor_force_N) && directional_.add(directional, motor_force_N);
    }

    LeastSquaresSolution<Scalar, 4> symmetric() const { return symmetric_.solve(); }
    LeastSquaresSolution<Scalar, 5> directional() const { return directional_.solve(); }

  private:
    Scalar minimum_speed_m_s_;
    LeastSquares<Scalar, 4> symmetric_;
    LeastSquares<Scalar, 5> directional_;
};

template <typename Scalar>
SymmetricFriction<Scalar> symmetric_friction(const LeastSquaresSolution<Scalar, 4>& solution) {
    const auto& p = solution.parameters;
    return {p(symmetric_mass), p(symmetric_viscous), p(symmetric_coulomb), p(symmetric_offset)};
}

template <typename Scalar>
DirectionalFriction<Scalar> directional_friction(const LeastSquaresSolution<Scalar, 5>& solution) {
    const auto& p = solution.parameters;
    return {p(directional_mass), p(positive_viscous), p(negative_viscous), p(positive_coulomb), p(negative_coulomb)};
}

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
/// feeds in each direction; one direction alone leaves K_x3 and g apart by nothing, and the solution says so.
template <typename Scalar>
class FeedCurrentFit {
  public:
    /// Rows with |w| ≤ `minimum_feed_m_per_min` are left out. Returns whether the row was used.
    bool add(Scalar feed_m_per_min, Scalar current_A, Scalar minimum_feed_m_per_min = Scalar(0)) {
        const Scalar w = feed_m_per_min;
        Eigen::Matrix<Scalar, 6, 1> row;
        if (w > minimum_feed_m_per_min) {
            row << w * w, w, Scalar(0), Scalar(0), Scalar(1), Scalar(1);
        } else if (w < -minimum_feed_m_per_min) {
            row << Scalar(0), Scalar(0), -w * w, w, Scalar(-1), Scalar(1);
        } else {
            return false;
        }
        return fit_.add(row, current_A);
    }

    LeastSquaresSolution<Scalar, 6> solve() const { return fit_.solve(); }

  private:
    LeastSquares<Scalar, 6> fit_;
};

/// The current of FeedCurrentFit's parameters at feed w ≠ 0.
template <typename Scalar>
Scalar feed_friction_current_A(const Eigen::Matrix<Scalar, 6, 1>& p, Scalar feed_m_per_min) {
    const Scalar w = feed_m_per_min;
    if (w > Scalar(0)) {
        return (p(positive_K_x1) * w + p(positive_K_x2)) * w + p(common_K_x3) + p(gravity_offset);
    }
    return (-p(negative_K_x1) * w + p(negative_K_x2)) * w - p(common_K_x3) + p(gravity_offset);
}

}  // namespace millforce::estimation
