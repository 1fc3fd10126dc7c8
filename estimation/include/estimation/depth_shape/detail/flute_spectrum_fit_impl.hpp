// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of flute_spectrum_fit.hpp. Only flute_profile_fit_impl.hpp includes them.

#include "estimation/depth_shape/detail/flute_spectrum_fit.hpp"
#include "estimation/depth_shape/detail/flute_spectrum_impl.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar, int Harmonics>
class FluteSpectrumFit<Scalar, Harmonics>::Projection {
  public:
    Projection(const FluteSpectrumFit& fit, const LawLines& laws, const Lines& helix) : fit_(fit) {
        for (std::size_t l = 0; l < chip_.size(); ++l) {
            const Phasor<Scalar> after = helix[l] * fit.measured_.response[l] * fit.measured_.weight[l];
            chip_[l] = laws[0][l] * after;
            edge_[l] = laws[1][l] * after;
        }
        orthonormalise();
    }
    [[nodiscard]] Scalar explained(Scalar shift) const {
        const Phasor<Scalar> step = turned_by(shift);
        Phasor<Scalar> at{Scalar(1), Scalar(0)};
        Phasor<Scalar> along_chip;
        Phasor<Scalar> along_edge;
        const auto add = [&](std::size_t l, Phasor<Scalar> turn) {
            const Phasor<Scalar> d = fit_.measured_.data[l] * turn * fit_.measured_.weight[l];
            along_chip += conjugate(chip_[l]) * d;
            along_edge += conjugate(edge_[l]) * d;
        };
        add(Model::line(0), at);
        for (int k = 1; k <= fit_.model_.used(); ++k) {
            at = at * step;
            add(Model::line(k), at);
            add(Model::line(-k), conjugate(at));
        }
        return squared_length(along_chip) + squared_length(along_edge);
    }

  private:
    static void normalise(Lines& lines) {
        using std::sqrt;
        Scalar energy{0};
        for (const Phasor<Scalar>& x : lines) {
            energy += squared_length(x);
        }
        const Scalar scale = energy > Scalar(0) ? Scalar(1) / sqrt(energy) : Scalar(0);
        for (Phasor<Scalar>& x : lines) {
            x = x * scale;
        }
    }
    void orthonormalise() {
        normalise(chip_);
        normalise(edge_);
        Phasor<Scalar> dot;
        for (std::size_t l = 0; l < chip_.size(); ++l) {
            dot += conjugate(chip_[l]) * edge_[l];
        }
        for (std::size_t l = 0; l < chip_.size(); ++l) {
            edge_[l] -= chip_[l] * dot;
        }
        normalise(edge_);
    }

    const FluteSpectrumFit& fit_;
    Lines chip_{};
    Lines edge_{};
};

template <typename Scalar, int Harmonics>
struct FluteSpectrumFit<Scalar, Harmonics>::State {
    Point point;
    LawLines laws;
    Lines helix;
    Lines turn;  ///< shift and low-pass
};

template <typename Scalar, int Harmonics>
typename FluteSpectrumFit<Scalar, Harmonics>::Minimum FluteSpectrumFit<Scalar, Harmonics>::refine(
    Point point, const FluteLimits<Scalar>& limits, const FluteKnowledge<Scalar>& knowledge) const {
    constexpr int most_iterations = 12;
    Minimum minimum;
    State state = state_at(point);
    const Scalar scale = law_scale(state);
    minimum.point = point;
    minimum.misfit = linear_fit(state, scale).residual_sum_of_squares() + distance(point, knowledge);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const Coefficients c = coefficients(linear_fit(state, scale).solve(condition_limit));
        const auto solution = joint_fit(state, c, scale, knowledge).solve(condition_limit);
        keep_variance(solution, minimum);
        if (!step(solution.parameters.template tail<3>(), limits, knowledge, scale, state, minimum)) {
            break;
        }
    }
    return minimum;
}

template <typename Scalar, int Harmonics>
Scalar FluteSpectrumFit<Scalar, Harmonics>::energy() const {
    Scalar energy{0};
    for (std::size_t l = 0; l < measured_.data.size(); ++l) {
        energy += square(measured_.weight[l]) * squared_length(measured_.data[l]);
    }
    return energy;
}

template <typename Scalar, int Harmonics>
typename FluteSpectrumFit<Scalar, Harmonics>::State FluteSpectrumFit<Scalar, Harmonics>::state_at(
    const Point& point) const {
    State state{point, model_.all_laws(point(1)), model_.helix(point(0)), model_.turn(-point(2))};
    for (std::size_t l = 0; l < state.turn.size(); ++l) {
        state.turn[l] = state.turn[l] * measured_.response[l];
    }
    return state;
}

/// The size of a coefficient that would explain the data with the chip alone: what the priors are measured by.
template <typename Scalar, int Harmonics>
Scalar FluteSpectrumFit<Scalar, Harmonics>::law_scale(const State& state) const {
    using std::sqrt;
    Scalar model{0};
    for (std::size_t l = 0; l < measured_.data.size(); ++l) {
        model += square(measured_.weight[l]) * squared_length(state.laws[0][l] * state.helix[l] * state.turn[l]);
    }
    return model > Scalar(0) ? sqrt(energy() / model) : Scalar(1);
}

/// Edge force and hats stay within some of the chip's coefficient, or they would stand in for the geometry.
template <typename Scalar, int Harmonics>
template <typename Fit>
void FluteSpectrumFit<Scalar, Harmonics>::add_law_priors(Fit& fit, Scalar scale) {
    constexpr Scalar edge_share = Scalar(2);
    constexpr Scalar hat_share = literal<Scalar>(0.3L);
    for (int j = 2; j < linear; ++j) {
        fit.add_prior(j, Scalar(0), Scalar(1) / (scale * (j < 4 ? edge_share : hat_share)));
    }
}

/// Rows for the real and imaginary part of one line, for c = c_re + i c_im of each law.
template <typename Scalar, int Harmonics>
template <typename Row>
void FluteSpectrumFit<Scalar, Harmonics>::fill_laws(const State& state, std::size_t l, Row& re, Row& im) {
    const Phasor<Scalar> after = state.helix[l] * state.turn[l];
    for (std::size_t b = 0; b < Model::laws; ++b) {
        const Phasor<Scalar> u = state.laws[b][l] * after;
        const auto j = static_cast<Eigen::Index>(2 * b);
        re(j) = u.re;
        re(j + 1) = -u.im;
        im(j) = u.im;
        im(j + 1) = u.re;
    }
}

template <typename Scalar, int Harmonics>
typename FluteSpectrumFit<Scalar, Harmonics>::LinearFit FluteSpectrumFit<Scalar, Harmonics>::linear_fit(
    const State& state, Scalar scale) const {
    LinearFit fit;
    typename LinearFit::Vector re;
    typename LinearFit::Vector im;
    for (std::size_t l = 0; l < measured_.data.size(); ++l) {
        if (measured_.weight[l] > Scalar(0)) {
            fill_laws(state, l, re, im);
            fit.add(re, measured_.data[l].re, measured_.weight[l]);
            fit.add(im, measured_.data[l].im, measured_.weight[l]);
        }
    }
    add_law_priors(fit, scale);
    return fit;
}

template <typename Scalar, int Harmonics>
typename FluteSpectrumFit<Scalar, Harmonics>::Coefficients FluteSpectrumFit<Scalar, Harmonics>::coefficients(
    const LeastSquaresSolution<Scalar, linear>& solution) {
    Coefficients c{};
    for (std::size_t b = 0; b < c.size(); ++b) {
        const auto j = static_cast<Eigen::Index>(2 * b);
        c[b] = {solution.parameters(j), solution.parameters(j + 1)};
    }
    return c;
}

/// Fits the coefficients of the laws and the changes of sweep, engagement and shift in one problem. The coefficients
/// replace the earlier ones.
template <typename Scalar, int Harmonics>
typename FluteSpectrumFit<Scalar, Harmonics>::JointFit FluteSpectrumFit<Scalar, Harmonics>::joint_fit(
    const State& state, const Coefficients& c, Scalar scale, const FluteKnowledge<Scalar>& knowledge) const {
    JointFit fit;
    typename JointFit::Vector re;
    typename JointFit::Vector im;
    const Scalar edge_rad = model_.moving_edge_rad(state.point(1));
    Phasor<Scalar> at_edge;
    for (std::size_t b = 0; b < c.size(); ++b) {
        at_edge += c[b] * Model::law(b, model_.chip(edge_rad));
    }
    for (std::size_t l = 0; l < measured_.data.size(); ++l) {
        if (!(measured_.weight[l] > Scalar(0))) {
            continue;
        }
        fill_laws(state, l, re, im);
        Phasor<Scalar> disc;
        for (std::size_t b = 0; b < c.size(); ++b) {
            disc += c[b] * state.laws[b][l];
        }
        const auto k = Scalar(Model::order(l));
        const Scalar m = k * Scalar(2) * pi<Scalar> / model_.pitch_rad();
        const Phasor<Scalar> by[3] = {disc * turned_by(-m * state.point(0)) * state.turn[l],
                                      at_edge * turned_by(-(m + Scalar(1)) * edge_rad) * state.helix[l] * state.turn[l],
                                      over_i(disc * state.helix[l] * state.turn[l]) * k};
        for (int j = 0; j < 3; ++j) {
            re(linear + j) = by[j].re;
            im(linear + j) = by[j].im;
        }
        fit.add(re, measured_.data[l].re, measured_.weight[l]);
        fit.add(im, measured_.data[l].im, measured_.weight[l]);
    }
    add_law_priors(fit, scale);
    for (int j = 0; j < 3; ++j) {
        if (knowledge.sd(j) > Scalar(0)) {
            fit.add_prior(linear + j, knowledge.mean(j) - state.point(j), Scalar(1) / knowledge.sd(j));
        }
    }
    return fit;
}

template <typename Scalar, int Harmonics>
Scalar FluteSpectrumFit<Scalar, Harmonics>::distance(const Point& point, const FluteKnowledge<Scalar>& knowledge) {
    Scalar sum{0};
    for (int j = 0; j < 3; ++j) {
        sum += knowledge.sd(j) > Scalar(0) ? square((point(j) - knowledge.mean(j)) / knowledge.sd(j)) : Scalar(0);
    }
    return sum;
}

/// The step, or less of it, that lowers the misfit. False where none does.
template <typename Scalar, int Harmonics>
bool FluteSpectrumFit<Scalar, Harmonics>::step(const Point& change, const FluteLimits<Scalar>& limits,
                                               const FluteKnowledge<Scalar>& knowledge, Scalar scale, State& state,
                                               Minimum& minimum) const {
    constexpr int most_tries = 5;
    constexpr Scalar shorter = literal<Scalar>(0.4L);  // the last try is 1/40 of the step: with halves it were 1/16
    constexpr Scalar longest_rad = literal<Scalar>(0.2L);
    constexpr Scalar worthwhile_gain = literal<Scalar>(1e-4L);  // of the misfit; less is far below its noise
    Scalar share{1};
    for (int k = 0; k < most_tries; ++k) {
        Point trial = minimum.point;
        for (int j = 0; j < 3; ++j) {
            const Scalar moved = trial(j) + share * clamp(change(j), -longest_rad, longest_rad);
            trial(j) = clamp(moved, limits.low(j), limits.high(j));
        }
        State at_trial = state_at(trial);
        const Scalar misfit = linear_fit(at_trial, scale).residual_sum_of_squares() + distance(trial, knowledge);
        if (misfit < minimum.misfit) {
            const bool go_on = minimum.misfit - misfit > worthwhile_gain * misfit;
            minimum.misfit = misfit;
            minimum.point = trial;
            state = at_trial;
            return go_on;
        }
        share *= shorter;
    }
    return false;
}

template <typename Scalar, int Harmonics>
void FluteSpectrumFit<Scalar, Harmonics>::keep_variance(const LeastSquaresSolution<Scalar, linear + 3>& solution,
                                                        Minimum& minimum) {
    const Scalar residual_variance = square(solution.residual_sd);
    minimum.residual_variance = clamp(residual_variance, smallest_residual_variance, residual_variance);
    const Scalar scale = residual_variance > Scalar(1) ? Scalar(1) : Scalar(1) / residual_variance;
    for (int j = 0; j < 3; ++j) {
        minimum.variance(j) = solution.covariance(linear + j, linear + j) * scale;
    }
    minimum.solved = residual_variance > Scalar(0) && minimum.variance.allFinite();
}

}  // namespace millforce::estimation
