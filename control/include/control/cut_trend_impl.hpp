// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of cut_trend.hpp. Only src/cut_trend.cpp includes them.

#include "control/cut_trend.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::control {

template <typename Scalar>
void CutTrend<Scalar>::clear() {
    mean_ = Scalar(0);
    since_fall_mm_ = memory_mm;
    forget_growth();
}

template <typename Scalar>
void CutTrend<Scalar>::forget_growth() {
    since_rise_mm_ = Scalar(0);
    growing_ = false;
}

template <typename Scalar>
bool CutTrend<Scalar>::fading() const {
    return since_fall_mm_ < memory_mm;
}

template <typename Scalar>
void CutTrend<Scalar>::update(Scalar section, Scalar section_sd, Scalar travel_mm) {
    using estimation::literal;
    constexpr Scalar least_change = literal<Scalar>(0.08L);
    constexpr Scalar step_fall = literal<Scalar>(0.2L);
    constexpr Scalar calm_travel_mm = Scalar(0.25F);  // L/4
    if (!(section > Scalar(0)) || !(travel_mm >= Scalar(0))) {
        return;
    }
    if (!(mean_ > Scalar(0))) {
        mean_ = section;
    }
    const Scalar by_chance = Scalar(2) * section_sd;
    const bool rises = section > mean_ * (Scalar(1) + least_change) + by_chance;
    const bool falls = section < mean_ * (Scalar(1) - least_change) - by_chance;
    const bool is_step = falls && section < mean_ * (Scalar(1) - step_fall);
    const bool was_calm = since_rise_mm_ >= calm_travel_mm;
    growing_ = rises ? growing_ || was_calm : growing_ && !was_calm;
    since_rise_mm_ = rises ? Scalar(0) : since_rise_mm_ + travel_mm;
    since_fall_mm_ = falls ? Scalar(0) : since_fall_mm_ + travel_mm;
    mean_ += (section - mean_) * (is_step ? Scalar(1) : travel_mm / (travel_mm + memory_mm));
}

}  // namespace millforce::control
