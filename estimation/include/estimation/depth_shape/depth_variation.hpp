// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/depth_shape/cut_category.hpp"
#include "estimation/depth_shape/flute_profile.hpp"
#include "estimation/number/fixed_point.hpp"
#include "estimation/number/literal.hpp"

#include <array>
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
/// Bodies: depth_variation_impl.hpp.

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
                     Scalar corner_span_rad, int channel = 0);

    [[nodiscard]] ForceIndices<Scalar> find() const;

  private:
    [[nodiscard]] Scalar bin_rad() const { return pitch_rad_ / Scalar(Bins); }
    [[nodiscard]] Scalar at(int b) const;
    [[nodiscard]] Scalar bend(int b) const { return at(b + span_) - Scalar(2) * at(b) + at(b - span_); }
    [[nodiscard]] static Scalar forward(Scalar from, Scalar to);
    [[nodiscard]] Scalar sharpness(Scalar sign, Scalar middle, int b) const;
    [[nodiscard]] int sharpest(Scalar sign, Scalar middle) const;
    [[nodiscard]] Scalar begin_of_valley(Scalar valley, int valley_bin, int lowest, int highest) const;
    [[nodiscard]] Scalar corner(Scalar sign, int b) const;
    [[nodiscard]] Scalar smooth_peak(int highest, Scalar middle) const;
    template <typename Height>
    [[nodiscard]] static Scalar centre(int top, const Height& height);

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

    [[nodiscard]] DepthVariation<Scalar> solve(const ForceIndices<Scalar>& indices) const;

  private:
    [[nodiscard]] Scalar pitch_rad() const { return Scalar(2) * pi<Scalar> / Scalar(settings_.cutter.teeth); }

    void type_I(const ForceIndices<Scalar>& indices, Scalar area_mm2, DepthVariation<Scalar>& result) const;
    void type_II(const ForceIndices<Scalar>& indices, Scalar area_mm2, DepthVariation<Scalar>& result) const;
    void type_III(const ForceIndices<Scalar>& indices, Scalar area_mm2, DepthVariation<Scalar>& result) const;
    void by_sweep(CutCategory category, Scalar sweep_rad, Scalar area_mm2, DepthVariation<Scalar>& result) const;
    void by_engagement(CutCategory category, Scalar engagement_rad, Scalar area_mm2,
                       DepthVariation<Scalar>& result) const;
    void by_both(CutCategory category, Scalar angle_rad, Scalar area_mm2, DepthVariation<Scalar>& result) const;
    void keep(CutCategory category, const DepthsOfCut<Scalar>& depths, DepthVariation<Scalar>& result) const;
    void choose(DepthVariation<Scalar>& result) const;

    DepthVariationSettings<Scalar> settings_;
};

/// A resultant force with bins of an eighth of a degree at four teeth.
extern template class FluteProfile<float, 1, 720>;
extern template class ForceIndexFinder<float, 1, 720>;
extern template class DepthVariationMethod<float>;
extern template class DepthVariationMethod<Fixed>;

}  // namespace millforce::estimation
