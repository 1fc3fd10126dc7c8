// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/immersion_profile.hpp"

namespace millforce::estimation {

template <typename Scalar, int Nodes>
ImmersionProfile<Scalar, Nodes>::ImmersionProfile(const Table& law, const AverageForceMeasurement<Scalar>& forces,
                                                  Scalar feed_per_tooth_mm, Scalar law_relative_sd,
                                                  const KnownDepth<Scalar>& known, Scalar largest_depth_mm)
    : forces_(forces),
      known_(known),
      feed_(law.feed(feed_per_tooth_mm)),
      K_s_(law.doubt_of_K_s()),
      r_1_(law.doubt_of_r_1()),
      tangential_weight_(Scalar(1) / forces.tangential_N.variance),
      largest_depth_mm_(largest_depth_mm) {
    const Scalar law_variance = square(law_relative_sd * forces.tangential_N.value);
    forces_.x_N.variance += law_variance;
    forces_.y_N.variance += law_variance;
    forces_.resting.least_N.variance += law_variance;
}

template <typename Scalar, int Nodes>
typename ImmersionProfile<Scalar, Nodes>::Value ImmersionProfile<Scalar, Nodes>::at(const Table& table,
                                                                                    Scalar theta_rad) const {
    return value_of(table.at(theta_rad, feed_), theta_rad);
}

template <typename Scalar, int Nodes>
typename ImmersionProfile<Scalar, Nodes>::Value ImmersionProfile<Scalar, Nodes>::at_node(const Table& table,
                                                                                         std::size_t node) const {
    return value_of(table.at_node(node, feed_), table.angle_rad(Scalar(static_cast<int>(node))));
}

/// Variance that the uncertainty of K_s and r_1 adds to a force at a given F_at. That of r_1 acts along the feed and
/// across it at once. That of K_s acts only where there are edge forces: it does not change them, but their share of
/// F_at.
template <typename Scalar, int Nodes>
typename ImmersionProfile<Scalar, Nodes>::Term ImmersionProfile<Scalar, Nodes>::along_axis(
    const Measurement<Scalar>& force_N, const typename Table::Forces& model, const LawDoubt& doubt, Scalar direction_x,
    Scalar direction_y) const {
    if (!force_N.valid) {
        return {};
    }
    const Scalar per_mm = direction_x * model.feed_N - direction_y * model.normal_N;
    const Scalar edge_per_mm = direction_x * model.edge_feed_N - direction_y * model.edge_normal_N;
    const Scalar per_ln_r_1 = direction_x * model.feed_per_ln_r_1_N - direction_y * model.normal_per_ln_r_1_N;
    const Scalar per_ln_K_s = per_mm * doubt.edge_share - edge_per_mm;
    const Scalar by_law =
        doubt.r_1 * square(doubt.depth_mm * per_ln_r_1) + doubt.K_s * square(doubt.depth_mm * per_ln_K_s);
    return {force_N.value, per_mm, Scalar(1) / (force_N.variance + by_law)};
}

template <typename Scalar, int Nodes>
typename ImmersionProfile<Scalar, Nodes>::LawDoubt ImmersionProfile<Scalar, Nodes>::law_doubt(
    const typename Table::Forces& model) const {
    const Scalar mm_per_N = Scalar(1) / model.tangential_N;
    return {forces_.tangential_N.value * mm_per_N, Scalar(1) - model.cutting_tangential_N * mm_per_N,
            K_s_.variance_at(model.ln_t_in_references), r_1_.variance_at(model.ln_t_in_references)};
}

/// It bounds what the forces leave open. K_s and depth act on all forces as one factor, so the relative variance of
/// this term is the sum of both.
template <typename Scalar, int Nodes>
typename ImmersionProfile<Scalar, Nodes>::Term ImmersionProfile<Scalar, Nodes>::of_known_depth(
    const LawDoubt& doubt) const {
    if (!(known_.depth_mm > Scalar(0))) {
        return {};
    }
    const Scalar by_K_s = known_.K_s_is_in_doubt ? doubt.K_s : Scalar(0);
    const Scalar relative_variance = square(known_.relative_sd) + by_K_s;
    return {known_.depth_mm, Scalar(1), Scalar(1) / (square(known_.depth_mm) * relative_variance)};
}

/// Of a force that is smaller than the least one, or opposite to it.
template <typename Scalar, int Nodes>
Scalar ImmersionProfile<Scalar, Nodes>::misfit_of_resting_axis(const typename Table::Forces& model,
                                                               const LawDoubt& doubt, Scalar depth_mm) const {
    const Scalar t_x = forces_.feed_direction_x;
    const Scalar t_y = forces_.feed_direction_y;
    const bool is_x = forces_.resting.is_x;
    const Term term = along_axis(forces_.resting.least_N, model, doubt, is_x ? t_x : t_y, is_x ? t_y : -t_x);
    const Scalar missing_N = term.measured - depth_mm * term.per_mm;
    return missing_N * term.measured > Scalar(0) ? term.weight * square(missing_N) : Scalar(0);
}

template <typename Scalar, int Nodes>
typename ImmersionProfile<Scalar, Nodes>::Value ImmersionProfile<Scalar, Nodes>::value_of(
    const typename Table::Forces& model, Scalar theta_rad) const {
    using elementary::cos;
    const Scalar t_x = forces_.feed_direction_x;
    const Scalar t_y = forces_.feed_direction_y;
    const LawDoubt doubt = law_doubt(model);
    const Term terms[] = {{forces_.tangential_N.value, model.tangential_N, tangential_weight_},
                          along_axis(forces_.x_N, model, doubt, t_x, t_y),
                          along_axis(forces_.y_N, model, doubt, t_y, -t_x),
                          of_known_depth(doubt)};
    Scalar wgg{0};
    Scalar wmg{0};
    for (const Term& term : terms) {
        const Scalar wg = term.weight * term.per_mm;
        wgg += wg * term.per_mm;
        wmg += wg * term.measured;
    }
    Value value;
    value.information = wgg;
    value.depth_mm = wmg > Scalar(0) ? wmg / wgg : Scalar(0);
    if (largest_depth_mm_ > Scalar(0) && value.depth_mm > largest_depth_mm_) {
        value.depth_mm = largest_depth_mm_;
    }
    value.ln_t_in_references = model.ln_t_in_references;
    for (const Term& term : terms) {
        value.misfit += term.weight * square(term.measured - value.depth_mm * term.per_mm);
    }
    value.misfit += misfit_of_resting_axis(model, doubt, value.depth_mm);
    if (forces_.radial_immersion.valid) {
        const Scalar immersion = Scalar(1) - cos(theta_rad);
        value.misfit += square(immersion - forces_.radial_immersion.value) / forces_.radial_immersion.variance;
    }
    return value;
}

}  // namespace millforce::estimation
