// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/depth_shape/cut_category.hpp"
#include "estimation/depth_shape/flute_profile.hpp"
#include "estimation/number/literal.hpp"

#include <array>
#include <cmath>
#include <cstddef>

/// Depth-of-cut variation from two force indices, as published (Yang, DeVor & Kapoor, sections 2.3–2.4).
///
/// PT_doc, an angle of the flute-averaged resultant force, gives one equation of α_sw and α_en per category (Table 1);
/// PT_ave, the mean force, gives K·ADOC·RDOC (Eq. 9), K from a cut of known depths. All twelve categories are solved,
/// solutions beyond ±50 % of the nominal depths are dropped, and of the rest those remain whose own type and overlap
/// (Eqs. 2, 3 and Fig. 10) are the ones assumed. A variation within ±10 % is "normal".
///
/// The paper reads valley and peak off by eye. Here they are corners: the entry of the next flute bends the force up,
/// the end of its rise (type I, II/MO) or of its flat top (type II) bends it down. A corner is where the second
/// difference over ±corner_span is largest, as the centre of the hump; a low-pass delays all corners alike, while it
/// shifts maxima and minima by the slopes beside them (1.1° of 26.5° in the paper's first test). Type III has no corner
/// at its peak: there it is the maximum. Without overlap the valley is a floor, and a flat top's index ends where the
/// floor begins.
///
/// Where Table 1 is not what a force shows (physics of vectors, and of a flute that falls faster than the next one
/// rises): III/MO peaks at α_sw, with the end of the next flute's entry, not at α_en + ½(α_sw − π); the resultant of
/// III/LO has its valley after the next flute's entry, for the two flutes' forces oppose each other. Eq. 9's K is no
/// constant: it holds hardness, and falls with chip thickness. `Characteristics::corrected` takes α_sw for III/MO and
/// III/LO, with the corner at the end of entry; `published` is Table 1 as printed.
///
/// Valid: equal pitch, helix 5…65°, forces with runout less than the feed per tooth. The estimate has no variance: the
/// method has none to give. flute_profile_fit.hpp has. Memory: the profile. Cost: some 6 passes over the profile, and
/// about 4 + 4(N − 1) categories of at most 40 function values each. No heap.

namespace millforce::estimation {

/// Both force indices. A profile without corners (a constant) gives angles without meaning, and no candidate.
template <typename Scalar>
struct ForceIndices {
    Scalar valley_to_corner_rad{0};    ///< PT_doc without flat top: valley to the next downward corner
    Scalar valley_to_peak_rad{0};      ///< PT_doc without flat top: valley to the maximum
    Scalar flat_top_to_valley_rad{0};  ///< PT_doc with flat top: its end to the next valley
    Scalar mean_N{0};                  ///< PT_ave
    Scalar valley_rad{0};              ///< where the valley stands in the pitch
};

/// Which of the indices a category is read from.
template <typename Scalar>
constexpr Scalar ForceIndices<Scalar>::*index_of(CutCategory category) {
    if (category.type == FluteForceType::III) {
        return &ForceIndices<Scalar>::valley_to_peak_rad;
    }
    const bool flat_top = category.type == FluteForceType::II &&
                          (category.overlap == FluteOverlap::none || category.overlap == FluteOverlap::low);
    return flat_top ? &ForceIndices<Scalar>::flat_top_to_valley_rad : &ForceIndices<Scalar>::valley_to_corner_rad;
}

/// Reads indices against those of the cut that K was taken from, for which Table 1 says what the angle should be: what
/// filter, rounded corners and the vectors' sum shift at the nominal depths is taken off. Only the nominal category's
/// own index is shifted.
template <typename Scalar>
ForceIndices<Scalar> read_against(const ForceIndices<Scalar>& nominal, const FluteAngles<Scalar>& nominal_angles,
                                  ForceIndices<Scalar> indices) {
    const auto index = index_of<Scalar>(cut_category(nominal_angles));
    indices.*index += published_peak_angle_rad(nominal_angles) - nominal.*index;
    return indices;
}

/// Indices of a profile (channel `channel` of it). Up milling: the profile is read backwards.
template <typename Scalar, int Channels, int Bins>
class ForceIndexFinder {
  public:
    ForceIndexFinder(const FluteAverage<Scalar, Channels, Bins>& profile, Scalar pitch_rad, CutSide side,
                     Scalar corner_span_rad, int channel = 0)
        : profile_(profile), pitch_rad_(pitch_rad), side_(side), channel_(channel) {
        const auto span = static_cast<int>(corner_span_rad / pitch_rad * Scalar(Bins) + Scalar(0.5F));
        span_ = span < 1 ? 1 : (span > Bins / 4 ? Bins / 4 : span);
    }

    [[nodiscard]] ForceIndices<Scalar> find() const {
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

  private:
    [[nodiscard]] Scalar bin_rad() const { return pitch_rad_ / Scalar(Bins); }
    [[nodiscard]] Scalar at(int b) const {
        const int in_turn = ((b % Bins) + Bins) % Bins;
        return profile_.mean[static_cast<std::size_t>(side_ == CutSide::up ? Bins - 1 - in_turn : in_turn)][channel_];
    }
    [[nodiscard]] Scalar bend(int b) const { return at(b + span_) - Scalar(2) * at(b) + at(b - span_); }
    [[nodiscard]] static Scalar forward(Scalar from, Scalar to) {
        return to >= from ? to - from : to - from + Scalar(Bins);
    }

    /// How much the profile bends upwards (sign 1) in its lower half, downwards (−1) in its upper half.
    [[nodiscard]] Scalar sharpness(Scalar sign, Scalar middle, int b) const {
        return sign * (middle - at(b)) > Scalar(0) ? sign * bend(b) : Scalar(0);
    }
    [[nodiscard]] int sharpest(Scalar sign, Scalar middle) const {
        int found = 0;
        for (int b = 1; b < Bins; ++b) {
            found = sharpness(sign, middle, b) > sharpness(sign, middle, found) ? b : found;
        }
        return found;
    }
    /// Where the force has come down to its valley: the corner itself, or where flutes do not overlap the begin of the
    /// floor before it. The chip ends thin there, so that the force has no corner.
    [[nodiscard]] Scalar begin_of_valley(Scalar valley, int valley_bin, int lowest, int highest) const {
        const Scalar level = at(lowest) + literal<Scalar>(0.003L) * (at(highest) - at(lowest));
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

    /// The hump of the bend around a bin, as its centre.
    [[nodiscard]] Scalar corner(Scalar sign, int b) const {
        const Scalar most = sign * bend(b);
        return centre(b, [&](int near) { return sign * bend(near) - Scalar(0.6F) * most; });
    }

    /// The maximum as the centre of what stands above 0.98 of it, counted from the middle of the profile's range.
    [[nodiscard]] Scalar smooth_peak(int highest, Scalar middle) const {
        const Scalar level = middle + literal<Scalar>(0.98L) * (at(highest) - middle);
        return centre(highest, [&](int b) { return at(b) - level; });
    }

    /// Centre of the hump around `top` where `height` is positive.
    template <typename Height>
    [[nodiscard]] static Scalar centre(int top, const Height& height) {
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

    const FluteAverage<Scalar, Channels, Bins>& profile_;
    Scalar pitch_rad_;
    CutSide side_;
    int channel_;
    int span_ = 1;
};

/// One solution of the two indices.
template <typename Scalar>
struct DepthCandidate {
    CutCategory category{};
    DepthsOfCut<Scalar> depths{};
    Scalar axial_variation{0};   ///< δADOC (Eq. 1)
    Scalar radial_variation{0};  ///< δRDOC
    bool consistent = false;     ///< its own type and overlap are the ones assumed
};

template <typename Scalar>
struct DepthVariation {
    static constexpr std::size_t most_candidates = 16;
    bool valid = false;      ///< at least one consistent candidate
    bool ambiguous = false;  ///< more than one: the one nearest to nominal was taken
    bool normal = false;     ///< both variations within ±10 %
    DepthCandidate<Scalar> best{};
    std::array<DepthCandidate<Scalar>, most_candidates> candidates{};  ///< within ±50 % of nominal
    std::size_t count = 0;
};

enum class Characteristics : unsigned char {
    published,  ///< Table 1
    corrected,  ///< III/MO and III/LO by α_sw: what forces show that add as vectors
};

template <typename Scalar>
struct DepthVariationSettings {
    FluteGeometry<Scalar> cutter{};
    DepthsOfCut<Scalar> nominal{};
    Scalar specific_energy_N_mm2{0};  ///< K of Eq. 9
    Characteristics characteristics = Characteristics::published;
    Scalar largest_variation = Scalar(0.5F);
    Scalar normal_variation = literal<Scalar>(0.1L);
};

/// K of Eq. 9 from a cut of known depths.
template <typename Scalar>
Scalar specific_energy_N_mm2(Scalar mean_N, const DepthsOfCut<Scalar>& depths) {
    return mean_N / (depths.axial_mm * depths.radial_mm);
}

template <typename Scalar>
class DepthVariationMethod {
  public:
    explicit DepthVariationMethod(const DepthVariationSettings<Scalar>& settings) : settings_(settings) {}

    [[nodiscard]] DepthVariation<Scalar> solve(const ForceIndices<Scalar>& indices) const {
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

  private:
    [[nodiscard]] Scalar pitch_rad() const { return Scalar(2) * pi<Scalar> / Scalar(settings_.cutter.teeth); }

    void type_I(const ForceIndices<Scalar>& indices, Scalar area_mm2, DepthVariation<Scalar>& result) const {
        for (const FluteOverlap overlap : {FluteOverlap::none, FluteOverlap::low, FluteOverlap::medium}) {
            by_sweep({FluteForceType::I, overlap}, indices.valley_to_corner_rad, area_mm2, result);
        }
        for (int n = 1; n < settings_.cutter.teeth; ++n) {
            by_sweep({FluteForceType::I, FluteOverlap::high}, indices.valley_to_corner_rad + Scalar(n) * pitch_rad(),
                     area_mm2, result);
        }
    }

    void type_II(const ForceIndices<Scalar>& indices, Scalar area_mm2, DepthVariation<Scalar>& result) const {
        by_engagement({FluteForceType::II, FluteOverlap::none}, indices.flat_top_to_valley_rad, area_mm2, result);
        by_sweep({FluteForceType::II, FluteOverlap::low}, pitch_rad() - indices.flat_top_to_valley_rad, area_mm2,
                 result);
        by_sweep({FluteForceType::II, FluteOverlap::medium}, pitch_rad() + indices.valley_to_corner_rad, area_mm2,
                 result);
        for (int n = 1; n < settings_.cutter.teeth; ++n) {
            by_engagement({FluteForceType::II, FluteOverlap::high},
                          indices.valley_to_corner_rad + Scalar(n) * pitch_rad(), area_mm2, result);
        }
    }

    void type_III(const ForceIndices<Scalar>& indices, Scalar area_mm2, DepthVariation<Scalar>& result) const {
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

    void by_sweep(CutCategory category, Scalar sweep_rad, Scalar area_mm2, DepthVariation<Scalar>& result) const {
        const Scalar axial_mm =
            depths_of_cut(settings_.cutter, FluteAngles<Scalar>{Scalar(0), sweep_rad, pitch_rad()}).axial_mm;
        keep(category, {axial_mm, area_mm2 / axial_mm}, result);
    }

    void by_engagement(CutCategory category, Scalar engagement_rad, Scalar area_mm2,
                       DepthVariation<Scalar>& result) const {
        const Scalar radial_mm =
            depths_of_cut(settings_.cutter, FluteAngles<Scalar>{engagement_rad, Scalar(0), pitch_rad()}).radial_mm;
        keep(category, {area_mm2 / radial_mm, radial_mm}, result);
    }

    /// α_en + ½(α_sw − π) = angle with ADOC·RDOC = area: the first root in α_en from half immersion on.
    void by_both(CutCategory category, Scalar angle_rad, Scalar area_mm2, DepthVariation<Scalar>& result) const {
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

    void keep(CutCategory category, const DepthsOfCut<Scalar>& depths, DepthVariation<Scalar>& result) const {
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

    void choose(DepthVariation<Scalar>& result) const {
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

    DepthVariationSettings<Scalar> settings_;
};

}  // namespace millforce::estimation
