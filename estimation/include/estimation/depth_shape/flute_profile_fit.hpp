// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/depth_shape/detail/flute_spectrum_fit.hpp"
#include "estimation/depth_shape/flute_profile.hpp"
#include "estimation/depth_shape/flute_profile_estimate.hpp"
#include "estimation/number/fixed_point.hpp"
#include "estimation/number/measurement.hpp"

#include <array>
#include <cstddef>

/// Axial and radial depth of cut from the whole flute-averaged profile of the plane force: from its shape alone.
///
/// Where two indices (depth_variation.hpp) need to know which of twelve categories a cut belongs to, the whole profile
/// needs none: it is fitted in closed form, flutes added as vectors (detail/flute_spectrum.hpp). Free in the fit, and
/// so without influence on the depths:
///  - hardness: both cutting pressures, and any factor on the force;
///  - the law of force against chip thickness: edge force, and a departure from the straight line at thin chips by
///    three hats, held within about 0.3 of the chip's coefficient (size effect, rubbing, teeth missing by runout);
///  - the direction of the frame: the coefficients are complex, a turned frame turns them;
///  - runout: the flute average has taken it out but for its work on thin chips, which the hats take up.
/// Searched: sweep α_sw, engagement α_en, and the shift of the profile (which two tips stand at the encoder's zero).
///
/// The tip's angle is worth a calibration. Without it the width hangs on where the force ends at the thin side of the
/// chip, where runout lifts teeth out of the cut: at e = 0.15 f_z three cuts in ten then have no estimate, of the
/// others the mean error is still near 1 %. With it, learnt from one cut of known depths (as the published method
/// learns K), the sharp side of the cut gives the width. A spindle whose tool has not moved in its holder keeps it.
///
/// Steps: (1) 40 × 14 nodes of sweep and engagement with chip and edge alone, 32 shifts each where the tip's angle is
/// not known; (2) from the six highest local maxima, and one pitch of sweep to either side of the best, variable
/// projection and Gauss–Newton; (3) the lowest misfit. The variance comes from the assumed errors (line_error of each
/// Fourier line and floor_error of the whole profile; more where the residuals say so) and from every other minimum
/// that explains the profile about as well.
///
/// "No estimate" of a depth: its standard deviation above largest_relative_sd; the solution at the end of the search
/// range; a profile without ripple (the sweep a whole number of pitches: F constant, nothing to see; 4 of 1 000 random
/// cuts); fewer than three harmonics within the low-pass. Sweeps of more than a pitch have look-alikes a pitch away;
/// where the profile cannot distinguish them (most of the 4 in 100 random cuts without estimate) the axial depth has
/// none.
///
/// Accuracy in simulation (`millforce reproduce yang`): with the tip's angle, 0.3 % mean over the published tests; over
/// 1 000 random cuts (2–6 flutes, helix 20–50°, a_p 0.1–4.5 R, a_e 0.05–1.98 R, up and down, e ≤ 0.15 f_z, 1 % noise,
/// low-pass at 7 times tooth passing) below 3 % in 95 of 100, cuts without estimate counted as wrong.
///
/// Valid: end mill of equal pitch and constant helix 5…65°, 1–12 flutes, a straight wall (down or up), a rigid tool,
/// known filter (a cutoff wrong by 10 % costs some 1 % of width), steady cut over the profile; f_z/R below 0.05. At
/// least 7 samples per tooth; from 23 on all ten harmonics are used.
///
/// Cost, for K = 10: 560 nodes × 1 (32) projections of 2K + 1 lines, and 8 starts × 12 steps of at most 6 linear
/// problems of 2(2K + 1) × 10 and one of 2(2K + 1) × 13. At most 2 (13) Mflop for the search and 35 Mflop for the fits,
/// of which some 5 are usual; 2 (8) ms on a 2.5 GHz core. Not for the tick: for a task beside it, once per profile.
/// Memory: no state but the settings; some 20 kB of stack. No heap.
/// Bodies: flute_profile_fit_impl.hpp.

namespace millforce::estimation {

template <typename Scalar, int Harmonics = 10>
class FluteProfileFit {
  public:
    using Spectrum = ProfileSpectrum<Scalar, Harmonics>;
    using Estimate = FluteProfileEstimate<Scalar>;

    FluteProfileFit() = default;
    explicit FluteProfileFit(const FluteProfileFitSettings<Scalar>& settings) : settings_(settings) {}

    [[nodiscard]] Estimate estimate(const Spectrum& spectrum) const;

    /// The tip's angle from a cut of known depths (each within relative_sd); not valid where the profile does not show
    /// it.
    [[nodiscard]] Measurement<Scalar> calibrate_tip_angle(const Spectrum& spectrum, const DepthsOfCut<Scalar>& known,
                                                          Scalar relative_sd) const;

  private:
    using Model = FluteSpectrum<Scalar, Harmonics>;
    using Fit = FluteSpectrumFit<Scalar, Harmonics>;
    using Measured = typename Fit::Measured;
    using Point = FlutePoint<Scalar>;
    using Minimum = FluteMinimum<Scalar>;

    static constexpr Scalar any_shift = Scalar(100);
    static constexpr int sweep_nodes = 40;
    static constexpr int engagement_nodes = 14;
    static constexpr int shift_nodes = 32;
    static constexpr std::size_t grid_starts = 6;
    static constexpr int fewest_harmonics = 3;  // 14 real numbers, for 13 unknowns of which 8 are held

    struct Minima;
    struct Shift;
    /// What chip and edge alone explain at each node, and at which shift.
    using Grid = std::array<std::array<Shift, static_cast<std::size_t>(engagement_nodes)>,
                            static_cast<std::size_t>(sweep_nodes)>;

    [[nodiscard]] static Scalar engagement_per_relative_depth(Scalar engagement_rad);
    [[nodiscard]] Model model_for(const Spectrum& spectrum, CutSide side) const;
    [[nodiscard]] Phasor<Scalar> response(const Spectrum& spectrum, int k) const;
    [[nodiscard]] bool passes(const Spectrum& spectrum, int k) const;
    [[nodiscard]] Measured measured_lines(const Spectrum& spectrum, const Model& model) const;
    [[nodiscard]] FluteLimits<Scalar> limits() const;
    [[nodiscard]] Scalar known_shift() const { return -settings_.tip_angle_rad.value * Scalar(settings_.cutter.teeth); }
    [[nodiscard]] Shift best_shift(const typename Fit::Projection& projection) const;
    [[nodiscard]] static Scalar ripple(const Measured& measured);
    [[nodiscard]] static Scalar node(Scalar low, Scalar high, std::size_t index, int count);
    [[nodiscard]] static Scalar sweep_node(const FluteLimits<Scalar>& limits, std::size_t i);
    [[nodiscard]] static Scalar engagement_node(const FluteLimits<Scalar>& limits, std::size_t j);
    void search(const Fit& fit, const Model& model, const FluteLimits<Scalar>& limits, Grid& grid) const;
    [[nodiscard]] static bool is_peak(const Grid& grid, std::size_t i, std::size_t j);
    [[nodiscard]] static bool take_start(Grid& grid, const FluteLimits<Scalar>& limits, Point& start);
    [[nodiscard]] Estimate estimate_side(const Spectrum& spectrum, CutSide side) const;
    [[nodiscard]] Estimate estimate_at(const Minimum& best, const FluteLimits<Scalar>& range, CutSide side,
                                       Scalar energy, Scalar ripple) const;
    [[nodiscard]] Measurement<Scalar> tip_angle(const Minimum& minimum) const;

    FluteProfileFitSettings<Scalar> settings_{};
};

extern template class FluteProfileFit<float>;
extern template class FluteProfileFit<Fixed>;

}  // namespace millforce::estimation
