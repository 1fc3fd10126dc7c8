#pragma once

#include "estimation/cut_category.hpp"
#include "estimation/detail/flute_spectrum_fit.hpp"
#include "estimation/flute_profile.hpp"
#include "estimation/low_pass.hpp"
#include "estimation/measurement.hpp"

namespace millforce::estimation {

template <typename Scalar>
struct DepthRange {
    Scalar low_mm{0};
    Scalar high_mm{0};
};

template <typename Scalar>
struct FluteProfileFitSettings {
    FluteGeometry<Scalar> cutter{};
    Scalar feed_per_tooth_mm{0};  ///< for the trochoid's part of the chip's shape (some f_z/R); 0: chips of circles
    CutSide side = CutSide::down;  ///< down, up, or unknown: both are fitted
    DepthRange<Scalar> axial{};    ///< searched; a solution at its end is none
    DepthRange<Scalar> radial{};
    LowPass<Scalar> low_pass{};
    /// Angle of a tooth's tip at the encoder's zero, 0…2π/N; not valid: unknown, then found with the depths.
    Measurement<Scalar> tip_angle_rad{};
    Scalar line_error = static_cast<Scalar>(0.003L);   ///< what a line may differ by, of itself
    Scalar floor_error = static_cast<Scalar>(0.001L);  ///< and of the whole profile
    Scalar largest_relative_sd = static_cast<Scalar>(0.1L);
};

template <typename Scalar>
struct FluteProfileEstimate {
    Measurement<Scalar> axial_depth_mm{};
    Measurement<Scalar> radial_depth_mm{};
    Measurement<Scalar> tip_angle_rad{};
    CutSide side = CutSide::unknown;
    CutCategory category{};
    Scalar misfit{0};  ///< of the weighted profile, what is not explained: √(misfit/energy)
    Scalar residual_variance{0};  ///< against the assumed errors
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
        return down.misfit <= up.misfit ? down : up;
    }

    /// The tip's angle from a cut of known depths (each within relative_sd).
    [[nodiscard]] Measurement<Scalar> calibrate_tip_angle(const Spectrum& spectrum, const DepthsOfCut<Scalar>& known,
                                                          Scalar relative_sd) const {
        const Model model = model_for(spectrum, settings_.side);
        const Measured measured = measured_lines(spectrum, model);
        const Fit fit(model, measured);
        const FluteAngles<Scalar> angles = flute_angles(settings_.cutter, known);
        Point point;
        point << angles.sweep_rad, angles.engagement_rad, Scalar(0);
        point(2) = best_shift(typename Fit::Projection(fit, model.straight_laws(point(1)), model.helix(point(0)))).shift;
        FluteKnowledge<Scalar> knowledge;
        knowledge.mean = point;
        const Scalar radial_sd_mm = relative_sd * known.radial_mm;
        using std::sin;
        const Scalar per_rad = settings_.cutter.cutter_radius_mm * sin(point(1));
        knowledge.sd << relative_sd * point(0),
            per_rad * relative_sd > radial_sd_mm ? relative_sd : radial_sd_mm / (per_rad + static_cast<Scalar>(1e-3L)), Scalar(0);
        FluteLimits<Scalar> wide;
        wide.low << Scalar(0), Scalar(0), Scalar(-100);
        wide.high << Scalar(100), pi<Scalar>, Scalar(100);
        return tip_angle(fit.refine(point, wide, knowledge));
    }

  private:
    using Model = FluteSpectrum<Scalar, Harmonics>;
    using Fit = FluteSpectrumFit<Scalar, Harmonics>;
    using Measured = typename Fit::Measured;
    using Point = FlutePoint<Scalar>;
    using Minimum = FluteMinimum<Scalar>;

    static constexpr int sweep_nodes = 40;
    static constexpr int engagement_nodes = 14;
    static constexpr int shift_nodes = 32;
    static constexpr std::size_t grid_starts = 5;

    [[nodiscard]] Model model_for(const Spectrum& spectrum, CutSide side) const {
        int used = 0;
        for (int k = 1; k <= Harmonics && passes(spectrum, k); ++k) {
            used = k;
        }
        return Model(settings_.cutter.teeth, settings_.feed_per_tooth_mm / settings_.cutter.cutter_radius_mm, side, used);
    }
    [[nodiscard]] Phasor<Scalar> response(const Spectrum& spectrum, int k) const {
        return low_pass_response(settings_.low_pass, Scalar(k * settings_.cutter.teeth) * spectrum.spindle_speed_rev_s);
    }
    /// A harmonic of which the low-pass leaves less than a fifth is not used: its response is not known well enough.
    [[nodiscard]] bool passes(const Spectrum& spectrum, int k) const {
        return squared_length(response(spectrum, k)) > static_cast<Scalar>(0.04L);
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
            const Scalar variance = square(settings_.floor_error) * total +
                                    square(settings_.line_error) * squared_length(spectrum.line[l]);
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
        limits.low << low.sweep_rad, low.engagement_rad, Scalar(-100);
        limits.high << high.sweep_rad, high.engagement_rad, Scalar(100);
        return limits;
    }

    struct Shift {
        Scalar explained{-1};
        Scalar shift{0};
    };
    [[nodiscard]] Scalar known_shift() const { return -settings_.tip_angle_rad.value * Scalar(settings_.cutter.teeth); }

    [[nodiscard]] Shift best_shift(const typename Fit::Projection& projection) const {
        Shift best;
        for (int s = 0; s < shift_nodes; ++s) {
            const Scalar shift = Scalar(2) * pi<Scalar> * Scalar(s) / Scalar(shift_nodes);
            const Scalar explained = projection.explained(shift);
            if (explained > best.explained) {
                best = {explained, shift};
            }
        }
        return best;
    }

    struct Node {
        Scalar explained{-1};
        Point point = Point::Zero();
    };
    using Row = std::array<Node, static_cast<std::size_t>(sweep_nodes)>;

    [[nodiscard]] static Scalar node(Scalar low, Scalar high, int index, int count) {
        return low + (high - low) * (Scalar(index) + Scalar(0.5F)) / Scalar(count);
    }

    /// The best start of each stretch of the sweep: minima lie apart in the sweep, which carries the fine structure.
    [[nodiscard]] Row search(const Fit& fit, const Model& model, const FluteLimits<Scalar>& limits) const {
        Row best;
        for (int j = 0; j < engagement_nodes; ++j) {
            const Scalar engagement = node(limits.low(1), limits.high(1), j, engagement_nodes);
            const auto laws = model.straight_laws(engagement);
            for (int i = 0; i < sweep_nodes; ++i) {
                const Scalar sweep = node(limits.low(0), limits.high(0), i, sweep_nodes);
                const typename Fit::Projection projection(fit, laws, model.helix(sweep));
                const Shift at = settings_.tip_angle_rad.valid ? Shift{projection.explained(known_shift()), known_shift()}
                                                               : best_shift(projection);
                Node& kept = best[static_cast<std::size_t>(i)];
                if (at.explained > kept.explained) {
                    kept.explained = at.explained;
                    kept.point << sweep, engagement, at.shift;
                }
            }
        }
        return best;
    }

    [[nodiscard]] Estimate estimate_side(const Spectrum& spectrum, CutSide side) const {
        using std::sqrt;
        const Model model = model_for(spectrum, side);
        const Measured measured = measured_lines(spectrum, model);
        const Fit fit(model, measured);
        const FluteLimits<Scalar> range = limits();
        Row row = search(fit, model, range);
        FluteKnowledge<Scalar> knowledge;
        if (settings_.tip_angle_rad.valid) {
            knowledge.mean(2) = known_shift();
            knowledge.sd(2) = Scalar(settings_.cutter.teeth) * sqrt(settings_.tip_angle_rad.variance);
        }
        Minima minima;
        while (minima.count < grid_starts && take_start(row, minima.start)) {
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
        return estimate_at(minima.with_doubt(), range, side, fit.energy(), model);
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

    /// Takes the highest local maximum off the row. False where there is none left.
    [[nodiscard]] static bool take_start(Row& row, Point& start) {
        Node* top = nullptr;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const bool peak = row[i].explained >= Scalar(0) && (i == 0 || row[i - 1].explained <= row[i].explained) &&
                              (i + 1 == row.size() || row[i + 1].explained <= row[i].explained);
            if (peak && (top == nullptr || row[i].explained > top->explained)) {
                top = &row[i];
            }
        }
        if (top == nullptr) {
            return false;
        }
        start = top->point;
        top->explained = Scalar(-1);
        return true;
    }

    [[nodiscard]] Estimate estimate_at(const Minimum& best, const FluteLimits<Scalar>& range, CutSide side,
                                       Scalar energy, const Model& model) const {
        using std::sin;
        using std::sqrt;
        using std::tan;
        Estimate estimate;
        estimate.side = side;
        estimate.misfit = energy > Scalar(0) ? sqrt(best.misfit / energy) : Scalar(1);
        estimate.residual_variance = best.residual_variance;
        if (!best.solved) {
            return estimate;
        }
        const FluteAngles<Scalar> angles{best.point(1), best.point(0), model.pitch_rad()};
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
