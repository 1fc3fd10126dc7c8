// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of depth_variation.hpp. src/depth_variation.cpp instantiates them.

#include "estimation/depth_shape/depth_variation.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar, int Channels, int Bins>
ForceIndexFinder<Scalar, Channels, Bins>::ForceIndexFinder(const FluteAverage<Scalar, Channels, Bins>& profile,
                                                           Scalar pitch_rad, CutSide side, Scalar corner_span_rad,
                                                           int channel)
    : profile_(profile), pitch_rad_(pitch_rad), side_(side), channel_(channel) {
    const auto span = static_cast<int>(corner_span_rad / pitch_rad * Scalar(Bins) + Scalar(0.5F));
    span_ = span < 1 ? 1 : (span > Bins / 4 ? Bins / 4 : span);
}

template <typename Scalar, int Channels, int Bins>
ForceIndices<Scalar> ForceIndexFinder<Scalar, Channels, Bins>::find() const {
    ForceIndices<Scalar> indices;
    int highest = 0;
    int lowest = 0;
    for (int b = 0; b < Bins; ++b) {
        indices.mean_N += at(b) / Scalar(Bins);
        highest = at(b) > at(highest) ? b : highest;
        lowest = at(b) < at(lowest) ? b : lowest;
    }
    const Scalar middle = Scalar(0.5F) * (at(highest) + at(lowest));
    const int valley_bin = sharpest(Scalar(1), middle);
    const int peak_bin = sharpest(Scalar(-1), middle);
    const Scalar valley = corner(Scalar(1), valley_bin);
    const Scalar peak = corner(Scalar(-1), peak_bin);
    const Scalar end_of_fall = begin_of_valley(valley, valley_bin, lowest, highest);
    indices.valley_rad = valley * bin_rad();
    indices.valley_to_corner_rad = forward(valley, peak) * bin_rad();
    indices.flat_top_to_valley_rad = forward(peak, end_of_fall) * bin_rad();
    indices.valley_to_peak_rad = forward(valley, smooth_peak(highest, middle)) * bin_rad();
    return indices;
}

template <typename Scalar, int Channels, int Bins>
Scalar ForceIndexFinder<Scalar, Channels, Bins>::at(int b) const {
    const int in_turn = ((b % Bins) + Bins) % Bins;
    return profile_.mean[static_cast<std::size_t>(side_ == CutSide::up ? Bins - 1 - in_turn : in_turn)][channel_];
}

template <typename Scalar, int Channels, int Bins>
Scalar ForceIndexFinder<Scalar, Channels, Bins>::forward(Scalar from, Scalar to) {
    return to >= from ? to - from : to - from + Scalar(Bins);
}

/// How much the profile bends upwards (sign 1) in its lower half, downwards (−1) in its upper half.
template <typename Scalar, int Channels, int Bins>
Scalar ForceIndexFinder<Scalar, Channels, Bins>::sharpness(Scalar sign, Scalar middle, int b) const {
    return sign * (middle - at(b)) > Scalar(0) ? sign * bend(b) : Scalar(0);
}

template <typename Scalar, int Channels, int Bins>
int ForceIndexFinder<Scalar, Channels, Bins>::sharpest(Scalar sign, Scalar middle) const {
    int found = 0;
    for (int b = 1; b < Bins; ++b) {
        found = sharpness(sign, middle, b) > sharpness(sign, middle, found) ? b : found;
    }
    return found;
}

/// Where the force has come down to its valley: the corner itself, or where flutes do not overlap the begin of the
/// floor before it. The chip ends thin there, so that the force has no corner.
template <typename Scalar, int Channels, int Bins>
Scalar ForceIndexFinder<Scalar, Channels, Bins>::begin_of_valley(Scalar valley, int valley_bin, int lowest,
                                                                 int highest) const {
    constexpr Scalar share_of_floor = literal<Scalar>(0.003L);  // of the range: no force of a flute, but ripple
    const Scalar level = at(lowest) + share_of_floor * (at(highest) - at(lowest));
    int floor_bins = 0;
    while (floor_bins < Bins && at(valley_bin - span_ - floor_bins) <= level) {
        ++floor_bins;
    }
    if (floor_bins < 2 * span_) {
        return valley;
    }
    const int begin = valley_bin - span_ - floor_bins;
    return Scalar(begin < 0 ? begin + Bins : begin);
}

/// The hump of the bend around a bin, as the centre of what stands above 0.6 of it: its flanks belong to what is beside
/// the corner.
template <typename Scalar, int Channels, int Bins>
Scalar ForceIndexFinder<Scalar, Channels, Bins>::corner(Scalar sign, int b) const {
    constexpr Scalar share_of_top{0.6F};
    const Scalar most = sign * bend(b);
    return centre(b, [&](int near) { return sign * bend(near) - share_of_top * most; });
}

/// The maximum as the centre of what stands above 0.98 of it, counted from the middle of the profile's range: one bin
/// alone would be the noise's choice, and lower down the slopes beside it differ.
template <typename Scalar, int Channels, int Bins>
Scalar ForceIndexFinder<Scalar, Channels, Bins>::smooth_peak(int highest, Scalar middle) const {
    constexpr Scalar share_of_peak = literal<Scalar>(0.98L);
    const Scalar level = middle + share_of_peak * (at(highest) - middle);
    return centre(highest, [&](int b) { return at(b) - level; });
}

/// Centre of the hump around `top` where `height` is positive.
template <typename Scalar, int Channels, int Bins>
template <typename Height>
Scalar ForceIndexFinder<Scalar, Channels, Bins>::centre(int top, const Height& height) {
    Scalar sum{0};
    Scalar moment{0};
    const auto gather = [&](int step) {
        for (int k = step > 0 ? 0 : 1; k < Bins / 2; ++k) {
            const Scalar h = height(top + step * k);
            if (!(h > Scalar(0))) {
                break;
            }
            sum += h;
            moment += h * Scalar(step * k);
        }
    };
    gather(1);
    gather(-1);
    const Scalar place = Scalar(top) + (sum > Scalar(0) ? moment / sum : Scalar(0));
    return place < Scalar(0) ? place + Scalar(Bins) : place;  // forward() takes care of the other end
}

template <typename Scalar>
DepthVariation<Scalar> DepthVariationMethod<Scalar>::solve(const ForceIndices<Scalar>& indices) const {
    DepthVariation<Scalar> result;
    const Scalar area_mm2 = indices.mean_N / settings_.specific_energy_N_mm2;
    if (!(area_mm2 > Scalar(0))) {
        return result;
    }
    type_I(indices, area_mm2, result);
    type_II(indices, area_mm2, result);
    type_III(indices, area_mm2, result);
    choose(result);
    return result;
}

template <typename Scalar>
void DepthVariationMethod<Scalar>::type_I(const ForceIndices<Scalar>& indices, Scalar area_mm2,
                                          DepthVariation<Scalar>& result) const {
    for (const FluteOverlap overlap : {FluteOverlap::none, FluteOverlap::low, FluteOverlap::medium}) {
        by_sweep({FluteForceType::I, overlap}, indices.valley_to_corner_rad, area_mm2, result);
    }
    for (int n = 1; n < settings_.cutter.teeth; ++n) {
        by_sweep({FluteForceType::I, FluteOverlap::high}, indices.valley_to_corner_rad + Scalar(n) * pitch_rad(),
                 area_mm2, result);
    }
}

template <typename Scalar>
void DepthVariationMethod<Scalar>::type_II(const ForceIndices<Scalar>& indices, Scalar area_mm2,
                                           DepthVariation<Scalar>& result) const {
    by_engagement({FluteForceType::II, FluteOverlap::none}, indices.flat_top_to_valley_rad, area_mm2, result);
    by_sweep({FluteForceType::II, FluteOverlap::low}, pitch_rad() - indices.flat_top_to_valley_rad, area_mm2, result);
    by_sweep({FluteForceType::II, FluteOverlap::medium}, pitch_rad() + indices.valley_to_corner_rad, area_mm2, result);
    for (int n = 1; n < settings_.cutter.teeth; ++n) {
        by_engagement({FluteForceType::II, FluteOverlap::high}, indices.valley_to_corner_rad + Scalar(n) * pitch_rad(),
                      area_mm2, result);
    }
}

template <typename Scalar>
void DepthVariationMethod<Scalar>::type_III(const ForceIndices<Scalar>& indices, Scalar area_mm2,
                                            DepthVariation<Scalar>& result) const {
    for (const FluteOverlap overlap : {FluteOverlap::none, FluteOverlap::low, FluteOverlap::medium}) {
        if (settings_.characteristics == Characteristics::corrected && overlap != FluteOverlap::none) {
            by_sweep({FluteForceType::III, overlap}, indices.valley_to_corner_rad, area_mm2, result);
        } else {
            by_both({FluteForceType::III, overlap}, indices.valley_to_peak_rad, area_mm2, result);
        }
    }
    for (int n = 1; n < settings_.cutter.teeth; ++n) {
        by_both({FluteForceType::III, FluteOverlap::high}, indices.valley_to_peak_rad + Scalar(n) * pitch_rad(),
                area_mm2, result);
    }
}

template <typename Scalar>
void DepthVariationMethod<Scalar>::by_sweep(CutCategory category, Scalar sweep_rad, Scalar area_mm2,
                                            DepthVariation<Scalar>& result) const {
    const Scalar axial_mm =
        depths_of_cut(settings_.cutter, FluteAngles<Scalar>{Scalar(0), sweep_rad, pitch_rad()}).axial_mm;
    keep(category, {axial_mm, area_mm2 / axial_mm}, result);
}

template <typename Scalar>
void DepthVariationMethod<Scalar>::by_engagement(CutCategory category, Scalar engagement_rad, Scalar area_mm2,
                                                 DepthVariation<Scalar>& result) const {
    const Scalar radial_mm =
        depths_of_cut(settings_.cutter, FluteAngles<Scalar>{engagement_rad, Scalar(0), pitch_rad()}).radial_mm;
    keep(category, {area_mm2 / radial_mm, radial_mm}, result);
}

/// α_en + ½(α_sw − π) = angle with ADOC·RDOC = area: the first root in α_en from half immersion on.
template <typename Scalar>
void DepthVariationMethod<Scalar>::by_both(CutCategory category, Scalar angle_rad, Scalar area_mm2,
                                           DepthVariation<Scalar>& result) const {
    const auto error = [&](Scalar engagement_rad) {
        const Scalar radial_mm =
            depths_of_cut(settings_.cutter, FluteAngles<Scalar>{engagement_rad, Scalar(0), pitch_rad()}).radial_mm;
        const FluteAngles<Scalar> angles = flute_angles(settings_.cutter, {area_mm2 / radial_mm, radial_mm});
        return engagement_rad + Scalar(0.5F) * (angles.sweep_rad - pi<Scalar>)-angle_rad;
    };
    constexpr int steps = 24;
    constexpr int halvings = 16;
    const Scalar step = Scalar(0.5F) * pi<Scalar> / Scalar(steps);
    Scalar low = Scalar(0.5F) * pi<Scalar>;
    Scalar at_low = error(low);
    for (int k = 1; k <= steps; ++k) {
        const Scalar high = Scalar(0.5F) * pi<Scalar> + Scalar(k) * step;
        const Scalar at_high = error(high);
        if ((at_low <= Scalar(0)) != (at_high <= Scalar(0))) {
            Scalar from = low;
            Scalar to = high;
            for (int halving = 0; halving < halvings; ++halving) {
                const Scalar middle = Scalar(0.5F) * (from + to);
                ((error(middle) <= Scalar(0)) == (at_low <= Scalar(0)) ? from : to) = middle;
            }
            by_engagement(category, Scalar(0.5F) * (from + to), area_mm2, result);
            return;
        }
        low = high;
        at_low = at_high;
    }
}

template <typename Scalar>
void DepthVariationMethod<Scalar>::keep(CutCategory category, const DepthsOfCut<Scalar>& depths,
                                        DepthVariation<Scalar>& result) const {
    DepthCandidate<Scalar> candidate;
    candidate.category = category;
    candidate.depths = depths;
    candidate.axial_variation = depths.axial_mm / settings_.nominal.axial_mm - Scalar(1);
    candidate.radial_variation = depths.radial_mm / settings_.nominal.radial_mm - Scalar(1);
    const Scalar most = settings_.largest_variation;
    const bool near = square(candidate.axial_variation) <= most * most &&
                      square(candidate.radial_variation) <= most * most &&
                      depths.radial_mm <= Scalar(2) * settings_.cutter.cutter_radius_mm;
    if (!near || result.count == result.candidates.size()) {
        return;
    }
    candidate.consistent = cut_category(flute_angles(settings_.cutter, depths)) == category;
    result.candidates[result.count++] = candidate;
}

template <typename Scalar>
void DepthVariationMethod<Scalar>::choose(DepthVariation<Scalar>& result) const {
    Scalar nearest{0};
    for (std::size_t k = 0; k < result.count; ++k) {
        const DepthCandidate<Scalar>& candidate = result.candidates[k];
        const Scalar distance = square(candidate.axial_variation) + square(candidate.radial_variation);
        if (!candidate.consistent) {
            continue;
        }
        result.ambiguous = result.valid;
        if (!result.valid || distance < nearest) {
            nearest = distance;
            result.best = candidate;
        }
        result.valid = true;
    }
    const Scalar band = square(settings_.normal_variation);
    result.normal =
        result.valid && square(result.best.axial_variation) <= band && square(result.best.radial_variation) <= band;
}

}  // namespace millforce::estimation
