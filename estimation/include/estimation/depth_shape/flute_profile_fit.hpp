// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/depth_shape/cut_category.hpp"
#include "estimation/depth_shape/detail/flute_spectrum_fit.hpp"
#include "estimation/depth_shape/flute_profile.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"
#include "estimation/signal/low_pass.hpp"

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
/// learns K), the sharp side of the cut tells the width. A spindle whose tool has not moved in its holder keeps it.
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
/// where the profile cannot tell them apart (most of the 4 in 100 random cuts without estimate) the axial depth has
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

namespace millforce::estimation {

/// Depths that are searched.
template <typename Scalar>
struct DepthRange {
    Scalar low_mm{0};
    Scalar high_mm{0};
};

template <typename Scalar>
struct FluteProfileFitSettings {
    FluteGeometry<Scalar> cutter{};
    Scalar feed_per_tooth_mm{0};   ///< for the trochoid's part of the chip's shape (some f_z/R); 0: chips of circles
    CutSide side = CutSide::down;  ///< down, up, or unknown: both are fitted, and the clearly better one is taken
    DepthRange<Scalar> axial{};    ///< searched; a solution at its end is none
    DepthRange<Scalar> radial{};
    LowPass<Scalar> low_pass{};
    /// Angle of a tooth's tip at the encoder's zero, 0…2π/N; not valid: unknown, then found with the depths.
    Measurement<Scalar> tip_angle_rad{};
    Scalar line_error = literal<Scalar>(0.003L);               ///< what a Fourier line may be wrong by, of itself
    Scalar floor_error = literal<Scalar>(0.001L);              ///< and of the whole profile's rms
    Scalar largest_relative_sd = literal<Scalar>(0.1L);        ///< of a depth; above: no estimate of it
    Scalar largest_tip_angle_sd_rad = literal<Scalar>(0.05L);  ///< above: nothing learnt
    Scalar smallest_ripple = literal<Scalar>(0.002L);  ///< of the whole profile; below it there is no shape to fit
};

template <typename Scalar>
struct FluteProfileEstimate {
    Measurement<Scalar> axial_depth_mm{};
    Measurement<Scalar> radial_depth_mm{};
    Measurement<Scalar> tip_angle_rad{};
    CutSide side = CutSide::unknown;
    CutCategory category{};
    Scalar ripple{0};             ///< rms of the profile about its mean, over the rms of the whole profile
    Scalar misfit{1};             ///< of the weighted profile, the share that is not explained
    Scalar residual_variance{0};  ///< over the assumed one; far above 1 the cut is not what the model takes it for
};

template <typename Scalar, int Harmonics = 10>
class FluteProfileFit {
  public:
    using Spectrum = ProfileSpectrum<Scalar, Harmonics>;
    using Estimate = FluteProfileEstimate<Scalar>;

    FluteProfileFit() = default;
    explicit FluteProfileFit(const FluteProfileFitSettings<Scalar>& settings) : settings_(settings) {}

    [[nodiscard]] Estimate estimate(const Spectrum& spectrum) const {
        if (settings_.side != CutSide::unknown) {
            return estimate_side(spectrum, settings_.side);
        }
        const Estimate down = estimate_side(spectrum, CutSide::down);
        const Estimate up = estimate_side(spectrum, CutSide::up);
        constexpr Scalar clearly_better = literal<Scalar>(0.7L);
        Estimate better = down.misfit <= up.misfit ? down : up;
        if (better.misfit > clearly_better * (down.misfit <= up.misfit ? up : down).misfit) {
            better.side = CutSide::unknown;
            better.axial_depth_mm.valid = false;
            better.radial_depth_mm.valid = false;
        }
        return better;
    }

    /// The tip's angle from a cut of known depths (each within relative_sd); not valid where the profile does not tell.
    [[nodiscard]] Measurement<Scalar> calibrate_tip_angle(const Spectrum& spectrum, const DepthsOfCut<Scalar>& known,
                                                          Scalar relative_sd) const {
        const Model model = model_for(spectrum, settings_.side);
        const Measured measured = measured_lines(spectrum, model);
        const Fit fit(model, measured);
        const FluteAngles<Scalar> angles = flute_angles(settings_.cutter, known);
        Point point;
        point << angles.sweep_rad, angles.engagement_rad, Scalar(0);
        point(2) =
            best_shift(typename Fit::Projection(fit, model.straight_laws(point(1)), model.helix(point(0)))).shift;
        FluteKnowledge<Scalar> knowledge;
        knowledge.mean = point;
        // Near a slot a_e says little of α_en: dα_en = da_e/(R sin α_en), never taken above relative_sd · π.
        knowledge.sd << relative_sd * point(0), relative_sd * engagement_per_relative_depth(point(1)), Scalar(0);
        FluteLimits<Scalar> wide;
        wide.low << Scalar(0), Scalar(0), -any_shift;
        wide.high << Scalar(2) * point(0), pi<Scalar>, any_shift;
        Measurement<Scalar> tip = tip_angle(fit.refine(point, wide, knowledge));
        tip.valid = tip.valid && tip.variance < square(settings_.largest_tip_angle_sd_rad);
        return tip;
    }

  private:
    using Model = FluteSpectrum<Scalar, Harmonics>;
    using Fit = FluteSpectrumFit<Scalar, Harmonics>;
    using Measured = typename Fit::Measured;
    using Point = FlutePoint<Scalar>;
    using Minimum = FluteMinimum<Scalar>;

    static constexpr Scalar any_shift = Scalar(100);

    [[nodiscard]] static Scalar engagement_per_relative_depth(Scalar engagement_rad) {
        using std::cos;
        using std::sin;
        const Scalar depth = Scalar(1) - cos(engagement_rad);
        const Scalar slope = sin(engagement_rad);
        return depth < pi<Scalar> * slope ? depth / slope : pi<Scalar>;
    }

    static constexpr int sweep_nodes = 40;
    static constexpr int engagement_nodes = 14;
    static constexpr int shift_nodes = 32;
    static constexpr std::size_t grid_starts = 6;
    static constexpr int fewest_harmonics = 3;  // 14 real numbers, for 13 unknowns of which 8 are held

    [[nodiscard]] Model model_for(const Spectrum& spectrum, CutSide side) const {
        int used = 0;
        for (int k = 1; k <= spectrum.highest && passes(spectrum, k); ++k) {
            used = k;
        }
        return Model(settings_.cutter.teeth, settings_.feed_per_tooth_mm / settings_.cutter.cutter_radius_mm, side,
                     used);
    }
    [[nodiscard]] Phasor<Scalar> response(const Spectrum& spectrum, int k) const {
        return low_pass_response(settings_.low_pass, Scalar(k * settings_.cutter.teeth) * spectrum.spindle_speed_rev_s);
    }
    /// A harmonic of which the low-pass leaves less than a fifth is not used: its response is not known well enough.
    [[nodiscard]] bool passes(const Spectrum& spectrum, int k) const {
        return squared_length(response(spectrum, k)) > literal<Scalar>(0.04L);
    }

    [[nodiscard]] Measured measured_lines(const Spectrum& spectrum, const Model& model) const {
        using std::sqrt;
        Measured measured;
        Scalar total{0};
        for (int k = -model.used(); k <= model.used(); ++k) {
            total += squared_length(spectrum.line[Model::line(k)]);
        }
        for (int k = -model.used(); k <= model.used(); ++k) {
            const std::size_t l = Model::line(k);
            const Phasor<Scalar> H = response(spectrum, k < 0 ? -k : k);
            measured.data[l] = spectrum.line[l];
            measured.response[l] = k < 0 ? conjugate(H) : H;
            const Scalar variance =
                square(settings_.floor_error) * total + square(settings_.line_error) * squared_length(spectrum.line[l]);
            measured.weight[l] = variance > Scalar(0) ? Scalar(1) / sqrt(variance) : Scalar(0);
        }
        return measured;
    }

    [[nodiscard]] FluteLimits<Scalar> limits() const {
        const FluteAngles<Scalar> low =
            flute_angles(settings_.cutter, DepthsOfCut<Scalar>{settings_.axial.low_mm, settings_.radial.low_mm});
        const FluteAngles<Scalar> high =
            flute_angles(settings_.cutter, DepthsOfCut<Scalar>{settings_.axial.high_mm, settings_.radial.high_mm});
        FluteLimits<Scalar> limits;
        limits.low << low.sweep_rad, low.engagement_rad, -any_shift;
        limits.high << high.sweep_rad, high.engagement_rad, any_shift;
        return limits;
    }

    struct Shift {
        Scalar explained{-1};
        Scalar shift{0};
        bool taken = false;
    };
    [[nodiscard]] Scalar known_shift() const { return -settings_.tip_angle_rad.value * Scalar(settings_.cutter.teeth); }

    [[nodiscard]] Shift best_shift(const typename Fit::Projection& projection) const {
        Shift best;
        for (int s = 0; s < shift_nodes; ++s) {
            const Scalar shift = Scalar(2) * pi<Scalar> * Scalar(s) / Scalar(shift_nodes);
            const Scalar explained = projection.explained(shift);
            if (explained > best.explained) {
                best = {explained, shift, false};
            }
        }
        return best;
    }

    [[nodiscard]] static Scalar ripple(const Measured& measured) {
        using std::sqrt;
        Scalar all{0};
        for (const Phasor<Scalar>& line : measured.data) {
            all += squared_length(line);
        }
        const Scalar mean = squared_length(measured.data[Model::line(0)]);
        return all > Scalar(0) ? sqrt((all - mean) / all) : Scalar(0);
    }

    /// What chip and edge alone explain at each node, and at which shift.
    using Grid = std::array<std::array<Shift, static_cast<std::size_t>(engagement_nodes)>,
                            static_cast<std::size_t>(sweep_nodes)>;

    [[nodiscard]] static Scalar node(Scalar low, Scalar high, std::size_t index, int count) {
        return low + (high - low) * (Scalar(index) + Scalar(0.5F)) / Scalar(count);
    }
    [[nodiscard]] static Scalar sweep_node(const FluteLimits<Scalar>& limits, std::size_t i) {
        return node(limits.low(0), limits.high(0), i, sweep_nodes);
    }
    [[nodiscard]] static Scalar engagement_node(const FluteLimits<Scalar>& limits, std::size_t j) {
        return node(limits.low(1), limits.high(1), j, engagement_nodes);
    }

    void search(const Fit& fit, const Model& model, const FluteLimits<Scalar>& limits, Grid& grid) const {
        for (std::size_t j = 0; j < grid[0].size(); ++j) {
            const auto laws = model.straight_laws(engagement_node(limits, j));
            for (std::size_t i = 0; i < grid.size(); ++i) {
                const typename Fit::Projection projection(fit, laws, model.helix(sweep_node(limits, i)));
                grid[i][j] = settings_.tip_angle_rad.valid
                                 ? Shift{projection.explained(known_shift()), known_shift(), false}
                                 : best_shift(projection);
            }
        }
    }

    [[nodiscard]] static bool is_peak(const Grid& grid, std::size_t i, std::size_t j) {
        const Scalar here = grid[i][j].explained;
        return !grid[i][j].taken && (i == 0 || grid[i - 1][j].explained <= here) &&
               (i + 1 == grid.size() || grid[i + 1][j].explained <= here) &&
               (j == 0 || grid[i][j - 1].explained <= here) &&
               (j + 1 == grid[0].size() || grid[i][j + 1].explained <= here);
    }

    /// Takes the highest local maximum that has not been taken. False where there is none left.
    [[nodiscard]] static bool take_start(Grid& grid, const FluteLimits<Scalar>& limits, Point& start) {
        Shift* top = nullptr;
        for (std::size_t i = 0; i < grid.size(); ++i) {
            for (std::size_t j = 0; j < grid[0].size(); ++j) {
                if ((top == nullptr || grid[i][j].explained > top->explained) && is_peak(grid, i, j)) {
                    top = &grid[i][j];
                    start << sweep_node(limits, i), engagement_node(limits, j), grid[i][j].shift;
                }
            }
        }
        if (top != nullptr) {
            top->taken = true;
        }
        return top != nullptr;
    }

    [[nodiscard]] Estimate estimate_side(const Spectrum& spectrum, CutSide side) const {
        using std::sqrt;
        const Model model = model_for(spectrum, side);
        if (model.used() < fewest_harmonics) {
            return {};
        }
        const Measured measured = measured_lines(spectrum, model);
        const Fit fit(model, measured);
        const FluteLimits<Scalar> range = limits();
        Grid grid;
        search(fit, model, range, grid);
        FluteKnowledge<Scalar> knowledge;
        if (settings_.tip_angle_rad.valid) {
            knowledge.mean(2) = known_shift();
            knowledge.sd(2) = Scalar(settings_.cutter.teeth) * sqrt(settings_.tip_angle_rad.variance);
        }
        Minima minima;
        while (minima.count < grid_starts && take_start(grid, range, minima.start)) {
            minima.add(fit.refine(minima.start, range, knowledge));
        }
        const Point best = minima.best.point;
        for (const Scalar pitches : {Scalar(-1), Scalar(1)}) {
            minima.start = best;
            minima.start(0) += pitches * model.pitch_rad();
            if (minima.start(0) > range.low(0) && minima.start(0) < range.high(0)) {
                minima.add(fit.refine(minima.start, range, knowledge));
            }
        }
        return estimate_at(minima.with_doubt(), range, side, fit.energy(), ripple(measured));
    }

    /// What the starts led to.
    struct Minima {
        std::array<Minimum, grid_starts + 2> all{};
        std::size_t count = 0;
        Minimum best{};
        Point start = Point::Zero();

        void add(const Minimum& minimum) {
            all[count++] = minimum;
            if (minimum.solved && (!best.solved || minimum.misfit < best.misfit)) {
                best = minimum;
            }
        }
        /// The best one; another that explains the data about as well is part of its doubt.
        [[nodiscard]] Minimum with_doubt() const {
            Minimum result = best;
            const Scalar as_good = best.misfit + Scalar(9) * best.residual_variance;
            for (std::size_t s = 0; s < count; ++s) {
                if (all[s].solved && all[s].misfit < as_good) {
                    result.variance = result.variance.cwiseMax((all[s].point - best.point).cwiseAbs2() * Scalar(0.25F));
                }
            }
            return result;
        }
    };

    [[nodiscard]] Estimate estimate_at(const Minimum& best, const FluteLimits<Scalar>& range, CutSide side,
                                       Scalar energy, Scalar ripple) const {
        using std::sin;
        using std::sqrt;
        using std::tan;
        Estimate estimate;
        estimate.side = side;
        estimate.misfit = energy > Scalar(0) ? sqrt(best.misfit / energy) : Scalar(1);
        estimate.residual_variance = best.residual_variance;
        estimate.ripple = ripple;
        if (!best.solved || ripple < settings_.smallest_ripple || !(settings_.cutter.helix_rad > Scalar(0))) {
            return estimate;
        }
        const FluteAngles<Scalar> angles{best.point(1), best.point(0),
                                         Scalar(2) * pi<Scalar> / Scalar(settings_.cutter.teeth)};
        estimate.category = cut_category(angles);
        const DepthsOfCut<Scalar> depths = depths_of_cut(settings_.cutter, angles);
        const Scalar R = settings_.cutter.cutter_radius_mm;
        const auto inside = [&](int j) { return best.point(j) > range.low(j) && best.point(j) < range.high(j); };
        const auto fill = [&](Measurement<Scalar>& m, Scalar value, Scalar per_rad, int j) {
            m.value = value;
            m.variance = square(per_rad) * best.variance(j);
            m.noise = m.variance;
            m.valid = inside(j) && m.variance < square(settings_.largest_relative_sd * value);
        };
        fill(estimate.axial_depth_mm, depths.axial_mm, R / tan(settings_.cutter.helix_rad), 0);
        fill(estimate.radial_depth_mm, depths.radial_mm, R * sin(best.point(1)), 1);
        estimate.tip_angle_rad = tip_angle(best);
        return estimate;
    }

    [[nodiscard]] Measurement<Scalar> tip_angle(const Minimum& minimum) const {
        using std::floor;
        const Scalar turns = -minimum.point(2) / (Scalar(2) * pi<Scalar>);
        const Scalar pitch = Scalar(2) * pi<Scalar> / Scalar(settings_.cutter.teeth);
        const Scalar variance = minimum.variance(2) / square(Scalar(settings_.cutter.teeth));
        return {minimum.solved, (turns - floor(turns)) * pitch, variance, variance};
    }

    FluteProfileFitSettings<Scalar> settings_{};
};

}  // namespace millforce::estimation
