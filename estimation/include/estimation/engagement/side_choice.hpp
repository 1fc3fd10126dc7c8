// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_estimate.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::estimation {

/// 95 % of a normal distribution: deviations on each side of the mean, its whole width in deviations, and the rise of
/// χ² above its minimum (one degree of freedom).
template <typename Scalar>
inline constexpr Scalar deviations_of_95_percent = literal<Scalar>(1.96L);
template <typename Scalar>
inline constexpr Scalar width_of_95_percent = literal<Scalar>(3.92L);
template <typename Scalar>
inline constexpr Scalar threshold_of_95_percent = literal<Scalar>(3.84L);

/// By how much larger than stated the variances of the forces are taken, of a model that explains them badly: 1 up to
/// the misfit that one window in 20 of the right model exceeds, and from there as J grows.
template <typename Scalar>
[[nodiscard]] Scalar variance_per_stated(Scalar misfit) {
    const Scalar beyond_usual = misfit - threshold_of_95_percent<Scalar>;
    return beyond_usual > Scalar(0) ? Scalar(1) + beyond_usual : Scalar(1);
}

/// By how much J rises to the ends of the 95 % interval.
template <typename Scalar>
[[nodiscard]] Scalar rise_of_interval(Scalar misfit) {
    return threshold_of_95_percent<Scalar> * variance_per_stated(misfit);
}

/// J of a model that does not describe the measured forces. J is a sum of at most two squares in deviations: where the
/// model holds, one window in 3 000 exceeds it.
template <typename Scalar>
inline constexpr Scalar misfit_of_a_wrong_model{16};

/// The most by which J may rise when a remembered or declared depth that holds is added: three standard deviations,
/// squared.
template <typename Scalar>
inline constexpr Scalar misfit_of_another_depth{9};

template <typename Scalar>
[[nodiscard]] bool is_refuted(const EngagementEstimate<Scalar>& found) {
    return found.misfit > misfit_of_a_wrong_model<Scalar>;
}

/// J of the other side must be lower than that of the declared one by this much: three standard deviations, squared.
template <typename Scalar>
inline constexpr Scalar advantage_of_the_other_side{9};

/// The declared side fits so badly that the other side is tried as well.
template <typename Scalar>
[[nodiscard]] bool may_be_the_other_side(const EngagementEstimate<Scalar>& declared) {
    return declared.misfit > advantage_of_the_other_side<Scalar>;
}

/// The declared side is kept unless the forces clearly fit the other one.
template <typename Scalar>
[[nodiscard]] EngagementEstimate<Scalar> declared_or_other_side(const EngagementEstimate<Scalar>& declared,
                                                                const EngagementEstimate<Scalar>& other) {
    const bool is_clear = declared.misfit - other.misfit > advantage_of_the_other_side<Scalar>;
    return other.solved && !is_refuted(other) && is_clear ? other : declared;
}

/// The side of a tool whose side is not known: the one that fits better by more than 95 %. Where neither does, the
/// estimate is valid only if both sides give the same immersion.
template <typename Scalar>
[[nodiscard]] EngagementEstimate<Scalar> better_of_sides(const EngagementEstimate<Scalar>& down,
                                                         const EngagementEstimate<Scalar>& up) {
    const Scalar advantage = up.misfit - down.misfit;
    if (advantage > threshold_of_95_percent<Scalar>) {
        return down;
    }
    if (advantage < -threshold_of_95_percent<Scalar>) {
        return up;
    }
    EngagementEstimate<Scalar> either = advantage < Scalar(0) ? up : down;
    const Scalar apart = down.radial_immersion - up.radial_immersion;
    const Scalar within = deviations_of_95_percent<Scalar> * (down.radial_immersion_sd + up.radial_immersion_sd);
    either.side = CutSide::unknown;
    if (!(square(apart) <= square(within))) {
        either.immersion_valid = false;
        either.depth_valid = false;
    }
    return either;
}

}  // namespace millforce::estimation
