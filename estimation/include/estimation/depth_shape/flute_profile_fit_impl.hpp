// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of flute_profile_fit.hpp. src/depth_monitor.cpp instantiates them for float and Fixed.

#include "estimation/depth_shape/detail/flute_spectrum_fit_impl.hpp"
#include "estimation/depth_shape/flute_profile_fit.hpp"

namespace millforce::estimation {

template <typename Scalar, int Harmonics>
struct FluteProfileFit<Scalar, Harmonics>::Shift {
    Scalar explained{-1};
    Scalar shift{0};
    bool taken = false;
};

/// What the starts led to.
template <typename Scalar, int Harmonics>
struct FluteProfileFit<Scalar, Harmonics>::Minima {
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
    /// The best one; another that explains the data about as well adds to its uncertainty.
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

template <typename Scalar, int Harmonics>
typename FluteProfileFit<Scalar, Harmonics>::Estimate FluteProfileFit<Scalar, Harmonics>::estimate(
    const Spectrum& spectrum) const {
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

template <typename Scalar, int Harmonics>
Measurement<Scalar> FluteProfileFit<Scalar, Harmonics>::calibrate_tip_angle(const Spectrum& spectrum,
                                                                            const DepthsOfCut<Scalar>& known,
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
    // Near a slot a_e says little of α_en: dα_en = da_e/(R sin α_en), never taken above relative_sd · π.
    knowledge.sd << relative_sd * point(0), relative_sd * engagement_per_relative_depth(point(1)), Scalar(0);
    FluteLimits<Scalar> wide;
    wide.low << Scalar(0), Scalar(0), -any_shift;
    wide.high << Scalar(2) * point(0), pi<Scalar>, any_shift;
    Measurement<Scalar> tip = tip_angle(fit.refine(point, wide, knowledge));
    tip.valid = tip.valid && tip.variance < square(settings_.largest_tip_angle_sd_rad);
    return tip;
}

template <typename Scalar, int Harmonics>
Scalar FluteProfileFit<Scalar, Harmonics>::engagement_per_relative_depth(Scalar engagement_rad) {
    using std::cos;
    using std::sin;
    const Scalar depth = Scalar(1) - cos(engagement_rad);
    const Scalar slope = sin(engagement_rad);
    return depth < pi<Scalar> * slope ? depth / slope : pi<Scalar>;
}

template <typename Scalar, int Harmonics>
typename FluteProfileFit<Scalar, Harmonics>::Model FluteProfileFit<Scalar, Harmonics>::model_for(
    const Spectrum& spectrum, CutSide side) const {
    int used = 0;
    for (int k = 1; k <= spectrum.highest && passes(spectrum, k); ++k) {
        used = k;
    }
    return Model(settings_.cutter.teeth, settings_.feed_per_tooth_mm / settings_.cutter.cutter_radius_mm, side, used);
}

template <typename Scalar, int Harmonics>
Phasor<Scalar> FluteProfileFit<Scalar, Harmonics>::response(const Spectrum& spectrum, int k) const {
    return low_pass_response(settings_.low_pass, Scalar(k * settings_.cutter.teeth) * spectrum.spindle_speed_rev_s);
}

/// A harmonic of which the low-pass leaves less than a fifth is not used: its response is not known well enough.
template <typename Scalar, int Harmonics>
bool FluteProfileFit<Scalar, Harmonics>::passes(const Spectrum& spectrum, int k) const {
    constexpr Scalar least_squared = literal<Scalar>(0.04L);  // (1/5)²
    return squared_length(response(spectrum, k)) > least_squared;
}

template <typename Scalar, int Harmonics>
typename FluteProfileFit<Scalar, Harmonics>::Measured FluteProfileFit<Scalar, Harmonics>::measured_lines(
    const Spectrum& spectrum, const Model& model) const {
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

template <typename Scalar, int Harmonics>
FluteLimits<Scalar> FluteProfileFit<Scalar, Harmonics>::limits() const {
    const FluteAngles<Scalar> low =
        flute_angles(settings_.cutter, DepthsOfCut<Scalar>{settings_.axial.low_mm, settings_.radial.low_mm});
    const FluteAngles<Scalar> high =
        flute_angles(settings_.cutter, DepthsOfCut<Scalar>{settings_.axial.high_mm, settings_.radial.high_mm});
    FluteLimits<Scalar> limits;
    limits.low << low.sweep_rad, low.engagement_rad, -any_shift;
    limits.high << high.sweep_rad, high.engagement_rad, any_shift;
    return limits;
}

template <typename Scalar, int Harmonics>
typename FluteProfileFit<Scalar, Harmonics>::Shift FluteProfileFit<Scalar, Harmonics>::best_shift(
    const typename Fit::Projection& projection) const {
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

template <typename Scalar, int Harmonics>
Scalar FluteProfileFit<Scalar, Harmonics>::ripple(const Measured& measured) {
    using std::sqrt;
    Scalar all{0};
    for (const Phasor<Scalar>& line : measured.data) {
        all += squared_length(line);
    }
    const Scalar mean = squared_length(measured.data[Model::line(0)]);
    return all > Scalar(0) ? sqrt((all - mean) / all) : Scalar(0);
}

template <typename Scalar, int Harmonics>
Scalar FluteProfileFit<Scalar, Harmonics>::node(Scalar low, Scalar high, std::size_t index, int count) {
    return low + (high - low) * (Scalar(index) + Scalar(0.5F)) / Scalar(count);
}

template <typename Scalar, int Harmonics>
Scalar FluteProfileFit<Scalar, Harmonics>::sweep_node(const FluteLimits<Scalar>& limits, std::size_t i) {
    return node(limits.low(0), limits.high(0), i, sweep_nodes);
}

template <typename Scalar, int Harmonics>
Scalar FluteProfileFit<Scalar, Harmonics>::engagement_node(const FluteLimits<Scalar>& limits, std::size_t j) {
    return node(limits.low(1), limits.high(1), j, engagement_nodes);
}

template <typename Scalar, int Harmonics>
void FluteProfileFit<Scalar, Harmonics>::search(const Fit& fit, const Model& model, const FluteLimits<Scalar>& limits,
                                                Grid& grid) const {
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

template <typename Scalar, int Harmonics>
bool FluteProfileFit<Scalar, Harmonics>::is_peak(const Grid& grid, std::size_t i, std::size_t j) {
    const Scalar here = grid[i][j].explained;
    return !grid[i][j].taken && (i == 0 || grid[i - 1][j].explained <= here) &&
           (i + 1 == grid.size() || grid[i + 1][j].explained <= here) && (j == 0 || grid[i][j - 1].explained <= here) &&
           (j + 1 == grid[0].size() || grid[i][j + 1].explained <= here);
}

/// Takes the highest local maximum that has not been taken. False where there is none left.
template <typename Scalar, int Harmonics>
bool FluteProfileFit<Scalar, Harmonics>::take_start(Grid& grid, const FluteLimits<Scalar>& limits, Point& start) {
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

template <typename Scalar, int Harmonics>
typename FluteProfileFit<Scalar, Harmonics>::Estimate FluteProfileFit<Scalar, Harmonics>::estimate_side(
    const Spectrum& spectrum, CutSide side) const {
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

template <typename Scalar, int Harmonics>
typename FluteProfileFit<Scalar, Harmonics>::Estimate FluteProfileFit<Scalar, Harmonics>::estimate_at(
    const Minimum& best, const FluteLimits<Scalar>& range, CutSide side, Scalar energy, Scalar ripple) const {
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

template <typename Scalar, int Harmonics>
Measurement<Scalar> FluteProfileFit<Scalar, Harmonics>::tip_angle(const Minimum& minimum) const {
    using std::floor;
    const Scalar turns = -minimum.point(2) / (Scalar(2) * pi<Scalar>);
    const Scalar pitch = Scalar(2) * pi<Scalar> / Scalar(settings_.cutter.teeth);
    const Scalar variance = minimum.variance(2) / square(Scalar(settings_.cutter.teeth));
    return {minimum.solved, (turns - floor(turns)) * pitch, variance, variance};
}

}  // namespace millforce::estimation
