// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/literal.hpp"
#include "firmware/carried_immersion.hpp"

namespace millforce::firmware {

template <typename Scalar>
void CarriedImmersion<Scalar>::follow_section(Scalar section_mm2) {
    section_sum_mm2_ += section_mm2;
    ++sections_;
}

template <typename Scalar>
void CarriedImmersion<Scalar>::forget_sections() {
    section_sum_mm2_ = Scalar(0);
    sections_ = 0;
}

template <typename Scalar>
void CarriedImmersion<Scalar>::take(const estimation::Measurement<Scalar>& immersion,
                                    const estimation::Measurement<Scalar>& last) {
    constexpr Scalar least_growth = estimation::literal<Scalar>(0.04L);  // less is noise of the section
    const Scalar section_mm2 = sections_ > 0 ? section_sum_mm2_ / Scalar(sections_) : Scalar(0);
    if (last.valid && immersion.valid && section_of_drops_mm2_ > Scalar(0) && last.value > Scalar(0)) {
        const Scalar growth = section_mm2 / section_of_drops_mm2_ - Scalar(1);
        if (estimation::square(growth) > estimation::square(least_growth)) {
            const Scalar seen =
                estimation::clamp((immersion.value / last.value - Scalar(1)) / growth, Scalar(0), Scalar(1));
            width_share_ = estimation::halved(width_share_ + seen);
        }
    } else {
        width_share_ = width_share_unknown;
    }
    section_of_drops_mm2_ = section_mm2;
    forget_sections();
}

template <typename Scalar>
estimation::Measurement<Scalar> CarriedImmersion<Scalar>::carry(estimation::Measurement<Scalar> immersion,
                                                                Scalar section_mm2) const {
    constexpr Scalar variance_of_even_distribution = estimation::literal<Scalar>(1.0L / 12.0L);
    constexpr Scalar largest_growth{0.5F};
    immersion.valid = immersion.valid && section_of_drops_mm2_ > Scalar(0);
    if (immersion.valid) {
        const Scalar growth = section_mm2 / section_of_drops_mm2_ - Scalar(1);
        immersion.variance += variance_of_even_distribution * estimation::square(growth * immersion.value);
        immersion.value *= Scalar(1) + width_share_ * growth;
        immersion.valid = estimation::square(growth) < estimation::square(largest_growth);
    }
    return immersion;
}

}  // namespace millforce::firmware
