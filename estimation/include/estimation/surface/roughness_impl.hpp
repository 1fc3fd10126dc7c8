// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of roughness.hpp. src/roughness.cpp instantiates them for float and Fixed, the calibration for double.

#include "estimation/number/elementary.hpp"
#include "estimation/number/finite.hpp"
#include "estimation/number/student_t.hpp"
#include "estimation/surface/roughness.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar>
Measurement<Scalar> force_ratio(const Measurement<Scalar>& f_x, const Measurement<Scalar>& f_z) {
    const auto is_clear = [](const Measurement<Scalar>& f) {
        constexpr Scalar least_significance{3};
        return f.valid && f.variance >= Scalar(0) && is_finite(square(f.value)) &&
               square(f.value) > square(least_significance) * f.variance && square(f.value) > Scalar(0);
    };
    if (!is_clear(f_x) || !is_clear(f_z)) {
        return {};
    }
    const Scalar ratio = f_x.value / f_z.value;
    const Scalar ln_variance = f_x.variance / square(f_x.value) + f_z.variance / square(f_z.value);
    return {true, ratio < Scalar(0) ? -ratio : ratio, square(ratio) * ln_variance, Scalar(0)};
}

template <typename Scalar>
RoughnessPredictor<Scalar>::RoughnessPredictor(const RoughnessModel<Scalar>& model) : model_(model) {
    using elementary::log;
    const auto is_positive = [](Scalar value) { return value > Scalar(0) && is_finite(value); };
    has_model_ = is_positive(model.constant_um);
    if (!has_model_) {
        return;
    }
    ln_at_reference_um_ = log(model.constant_um);
    bool has_references = true;
    for (std::size_t j = 0; j < count; ++j) {
        const bool is_given = is_positive(model.reference[j]);
        has_references = has_references && is_given;
        ln_reference_[j] = is_given ? log(model.reference[j]) : Scalar(0);
        ln_at_reference_um_ += model.exponent[j] * ln_reference_[j];
    }
    has_model_ = is_finite(ln_at_reference_um_);
    has_interval_ = has_model_ && has_references && is_positive(model.residual_ln_sd) && is_positive(model.tests) &&
                    model.degrees_of_freedom >= Scalar(1);
    t_ = has_interval_ ? student_t_975(model.degrees_of_freedom) : Scalar(0);
}

template <typename Scalar>
RoughnessPrediction<Scalar> RoughnessPredictor<Scalar>::predict(const RoughnessConditions<Scalar>& cut) const {
    return prediction_of(cut, Scalar(0));
}

template <typename Scalar>
RoughnessPrediction<Scalar> RoughnessPredictor<Scalar>::predict(RoughnessConditions<Scalar> cut,
                                                                const Measurement<Scalar>& f_x,
                                                                const Measurement<Scalar>& f_z) const {
    const Measurement<Scalar> ratio = force_ratio(f_x, f_z);
    if (!ratio.valid) {
        return {};
    }
    cut[roughness_force_ratio] = ratio.value;
    return prediction_of(cut, ratio.variance / square(ratio.value));
}

template <typename Scalar>
bool RoughnessPredictor<Scalar>::are_usable(const RoughnessConditions<Scalar>& cut) {
    for (const Scalar value : cut) {
        if (!(value > Scalar(0)) || !is_finite(value)) {
            return false;
        }
    }
    return true;
}

template <typename Scalar>
RoughnessValues<Scalar> RoughnessPredictor<Scalar>::logarithms(const RoughnessConditions<Scalar>& cut) const {
    using elementary::log;
    RoughnessValues<Scalar> z{};
    for (std::size_t j = 0; j < count; ++j) {
        z[j] = log(cut[j]) - ln_reference_[j];
    }
    return z;
}

template <typename Scalar>
Scalar RoughnessPredictor<Scalar>::ln_roughness(const RoughnessValues<Scalar>& z) const {
    Scalar sum = ln_at_reference_um_;
    for (std::size_t j = 0; j < count; ++j) {
        sum += model_.exponent[j] * z[j];
    }
    return sum;
}

template <typename Scalar>
Scalar RoughnessPredictor<Scalar>::leverage(const RoughnessValues<Scalar>& z) const {
    Scalar form{0};
    for (std::size_t row = 0; row < count; ++row) {
        form += model_.leverage[model_.pair(row, row)] * square(z[row]);
        for (std::size_t column = 0; column < row; ++column) {
            form += Scalar(2) * model_.leverage[model_.pair(row, column)] * z[row] * z[column];
        }
    }
    return Scalar(1) / model_.tests + (form > Scalar(0) ? form : Scalar(0));
}

template <typename Scalar>
Scalar RoughnessPredictor<Scalar>::half_interval(Scalar leverage, Scalar ratio_ln_variance) const {
    using std::sqrt;
    return sqrt(square(t_ * model_.residual_ln_sd) * (Scalar(1) + leverage) +
                square(normal_975<Scalar> * model_.exponent[roughness_force_ratio]) * ratio_ln_variance);
}

template <typename Scalar>
void RoughnessPredictor<Scalar>::compare_with_tests(const RoughnessConditions<Scalar>& cut,
                                                    RoughnessPrediction<Scalar>& prediction) const {
    for (std::size_t j = 0; j < count; ++j) {
        const unsigned bit = 1U << static_cast<unsigned>(j);
        if (!(model_.maximum[j] > Scalar(0))) {
            prediction.range_not_given |= bit;
        } else if (cut[j] < model_.minimum[j] * (Scalar(1) - tolerance) ||
                   cut[j] > model_.maximum[j] * (Scalar(1) + tolerance)) {
            prediction.outside |= bit;
        }
    }
    const bool is_given = prediction.has_interval && model_.largest_leverage > Scalar(0);
    constexpr Scalar of_all_variables = Scalar(roughness_variable_count) * tolerance;
    if (is_given && prediction.leverage > model_.largest_leverage * (Scalar(1) + of_all_variables)) {
        prediction.outside |= RoughnessPrediction<Scalar>::hidden_extrapolation;
    }
}

template <typename Scalar>
RoughnessPrediction<Scalar> RoughnessPredictor<Scalar>::prediction_of(const RoughnessConditions<Scalar>& cut,
                                                                      Scalar ratio_ln_variance) const {
    using elementary::exp;
    RoughnessPrediction<Scalar> prediction;
    if (!has_model_ || !are_usable(cut)) {
        return prediction;
    }
    const RoughnessValues<Scalar> z = logarithms(cut);
    const Scalar ln_R = ln_roughness(z);
    prediction.roughness_um = exp(ln_R);
    prediction.valid = is_finite(prediction.roughness_um);
    if (has_interval_) {
        prediction.leverage = leverage(z);
        const Scalar half = half_interval(prediction.leverage, ratio_ln_variance);
        prediction.low_um = exp(ln_R - half);
        prediction.high_um = exp(ln_R + half);
        prediction.has_interval = prediction.valid && is_finite(prediction.high_um);
    }
    compare_with_tests(cut, prediction);
    return prediction;
}

/// The feed, as ln(f/reference), at which the upper bound of R meets its limit, by bisection; `z` is at the highest
/// fitted feed. Where none does: below the lowest fitted feed.
template <typename Scalar>
Scalar RoughnessPredictor<Scalar>::highest_feed_within(Scalar ln_limit, RoughnessValues<Scalar> z,
                                                       Scalar ratio_ln_variance) const {
    using elementary::log;
    const auto keeps_limit = [&](Scalar z_feed) {
        z[roughness_feed] = z_feed;
        return ln_roughness(z) + half_interval(leverage(z), ratio_ln_variance) <= ln_limit;
    };
    Scalar broken = z[roughness_feed];
    if (keeps_limit(broken)) {
        return broken;
    }
    Scalar kept = log(model_.minimum[roughness_feed]) - ln_reference_[roughness_feed];
    if (!keeps_limit(kept)) {
        return kept - Scalar(1);
    }
    constexpr int halvings = 16;  // 2⁻¹⁶ of the fitted range of feeds, as a logarithm
    for (int k = 0; k < halvings; ++k) {
        const Scalar middle = Scalar(0.5F) * (kept + broken);
        (keeps_limit(middle) ? kept : broken) = middle;
    }
    return kept;
}

template <typename Scalar>
typename RoughnessPredictor<Scalar>::FeedCeiling RoughnessPredictor<Scalar>::feed_ceiling(
    RoughnessConditions<Scalar> cut, const Measurement<Scalar>& f_x, const Measurement<Scalar>& f_z,
    Scalar limit_um) const {
    using elementary::exp;
    using elementary::log;
    const Measurement<Scalar> ratio = force_ratio(f_x, f_z);
    const Scalar lowest = model_.minimum[roughness_feed];
    const Scalar highest = model_.maximum[roughness_feed];
    cut[roughness_feed] = highest;
    cut[roughness_force_ratio] = ratio.value;
    const bool has_feeds = lowest > Scalar(0) && highest >= lowest && model_.exponent[roughness_feed] > Scalar(0);
    if (!has_interval_ || !ratio.valid || !has_feeds || !(limit_um > Scalar(0)) || !are_usable(cut)) {
        return {};
    }
    const Scalar ratio_ln_variance = ratio.variance / square(ratio.value);
    const Scalar feed =
        exp(highest_feed_within(log(limit_um), logarithms(cut), ratio_ln_variance) + ln_reference_[roughness_feed]);
    FeedCeiling ceiling;
    ceiling.reachable = feed > lowest * (Scalar(1) - tolerance);
    ceiling.feed_mm_rev = clamp(feed, lowest, highest);
    cut[roughness_feed] = ceiling.feed_mm_rev;
    const RoughnessPrediction<Scalar> there = prediction_of(cut, ratio_ln_variance);
    ceiling.valid = there.has_interval;
    ceiling.in_range = there.is_sure();
    return ceiling;
}

}  // namespace millforce::estimation
