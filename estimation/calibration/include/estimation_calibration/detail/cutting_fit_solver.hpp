// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation_calibration/cutting_fit.hpp"

#include <array>

/// Robust Gauss–Newton solution of fit_cutting_law; not for use on its own.

namespace millforce::estimation::detail {

template <typename Scalar>
class CuttingFitSolver {
  public:
    using Vector = Eigen::Matrix<Scalar, cutting_parameter_count, 1>;
    using Matrix = Eigen::Matrix<Scalar, cutting_parameter_count, cutting_parameter_count>;
    static constexpr int channel_count = 3;

    CuttingFitSolver(std::span<const CuttingMeasurement<Scalar>> cuts, const CuttingFitOptions<Scalar>& options)
        : cuts_(cuts), options_(options) {}

    CuttingFit<Scalar> run();

  private:
    /// One measured force beside the model's, with its derivatives by the six parameters.
    struct Row {
        Scalar measured{0};
        Scalar model{0};
        Vector derivatives = Vector::Zero();
        int channel = 0;
    };

    struct Channel {
        Scalar scale{static_cast<Scalar>(0.05L)};
        Scalar floor_N{0};
        Scalar sum_of_relative_squares{0};
        Scalar sum_of_clipped_squares{0};
        int cuts = 0;
        int unclipped = 0;
        int odd = 0;
    };

    static Scalar measured(const CuttingMeasurement<Scalar>& m, int channel) {
        return channel == 0 ? m.tangential_N : (channel == 1 ? m.feed_N : m.normal_N);
    }

    static Scalar smaller(Scalar a, Scalar b) { return a < b ? a : b; }

    static bool usable(const CuttingMeasurement<Scalar>& m) {
        using std::isfinite;
        const Scalar t = mean_chip_thickness_mm(m.cut.feed_per_tooth_mm, m.cut.engagement);
        return isfinite(t) && t > Scalar(0) && isfinite(m.cut.axial_depth_mm) && m.cut.axial_depth_mm > Scalar(0) &&
               isfinite(m.cut.teeth) && m.cut.teeth > Scalar(0);
    }

    bool survey();
    bool start();
    Scalar step();
    void measure_scatter();
    void conclude();
    void find_undetermined();
    void fill_law();
    void fill_doubts();

    Row row(const CuttingMeasurement<Scalar>& m, int channel) const;
    Scalar error_sd(const Row& r) const;
    void add_beliefs(LeastSquares<Scalar, cutting_parameter_count>& fit, bool steps_from_here) const;
    Scalar free_parameters() const;

    /// Calls f(Row) for each measured force.
    template <typename Function>
    void for_each_row(Function f) const {
        using std::isfinite;
        for (const CuttingMeasurement<Scalar>& m : cuts_) {
            if (!usable(m)) {
                continue;
            }
            for (int channel = 0; channel < channel_count; ++channel) {
                if (isfinite(measured(m, channel))) {
                    f(row(m, channel));
                }
            }
        }
    }

    std::span<const CuttingMeasurement<Scalar>> cuts_;
    const CuttingFitOptions<Scalar>& options_;
    CuttingFit<Scalar> result_{};
    std::array<Channel, channel_count> channels_{};
    Vector belief_mean_ = Vector::Zero();
    Vector belief_weight_ = Vector::Zero();  ///< 0: none
    Scalar ln_t_ref_{0};
    Scalar thinnest_mm_{0}, thickest_mm_{0};
    int rows_ = 0;
};

/// Ranges, counts and mean forces. Returns whether there is anything to fit.
template <typename Scalar>
bool CuttingFitSolver<Scalar>::survey() {
    using std::abs;
    using std::exp;
    using std::isfinite;
    using std::log;
    Scalar sum_of_logarithms{0};
    int usable_cuts = 0;
    for (const CuttingMeasurement<Scalar>& m : cuts_) {
        if (!usable(m)) {
            continue;
        }
        const Scalar f_z = m.cut.feed_per_tooth_mm;
        const Scalar t = mean_chip_thickness_mm(f_z, m.cut.engagement);
        const bool first = usable_cuts == 0;
        thinnest_mm_ = first || t < thinnest_mm_ ? t : thinnest_mm_;
        thickest_mm_ = first || t > thickest_mm_ ? t : thickest_mm_;
        result_.minimum_feed_per_tooth_mm = first ? f_z : smaller(f_z, result_.minimum_feed_per_tooth_mm);
        result_.maximum_feed_per_tooth_mm = first ? f_z : -smaller(-f_z, -result_.maximum_feed_per_tooth_mm);
        sum_of_logarithms += log(t);
        ++usable_cuts;
        for (int c = 0; c < channel_count; ++c) {
            if (isfinite(measured(m, c))) {
                auto& channel = channels_[static_cast<std::size_t>(c)];
                channel.floor_N += abs(measured(m, c));
                ++channel.cuts;
                ++rows_;
            }
        }
    }
    for (Channel& channel : channels_) {
        channel.floor_N *= channel.cuts > 0 ? options_.error_floor / static_cast<Scalar>(channel.cuts) : Scalar(0);
    }
    ln_t_ref_ = usable_cuts > 0 ? sum_of_logarithms / static_cast<Scalar>(usable_cuts) : Scalar(0);
    result_.reference_chip_thickness_mm = exp(ln_t_ref_);
    return rows_ > 0;
}

template <typename Scalar>
typename CuttingFitSolver<Scalar>::Row CuttingFitSolver<Scalar>::row(const CuttingMeasurement<Scalar>& m,
                                                                     int channel) const {
    using std::exp;
    using std::log;
    const Vector& p = result_.parameters;
    const EngagementIntegrals<Scalar> i = engagement_integrals(m.cut.engagement);
    const Scalar per_pitch = m.cut.axial_depth_mm * m.cut.teeth / (Scalar(2) * pi<Scalar>);
    const Scalar u = log(m.cut.feed_per_tooth_mm * i.mean_sine) - ln_t_ref_;
    const Scalar r_1_growth = exp(p(cutting_p_1) * u);
    const Scalar r_1 = p(cutting_r_1) * r_1_growth;
    const Scalar G = exp(p(cutting_ln_K_s) + p(cutting_p_s) * u) * m.cut.feed_per_tooth_mm * per_pitch;
    // F = G (by_K + r_1 by_r) + per_pitch (K_te edge_t + K_re edge_r)
    const std::array<Scalar, channel_count> by_K{i.c, i.s, -i.b};
    const std::array<Scalar, channel_count> by_r{Scalar(0), i.b, i.s};
    const std::array<Scalar, channel_count> edge_t{i.delta_rad, i.d, -i.c};
    const std::array<Scalar, channel_count> edge_r{Scalar(0), i.c, i.d};
    const auto c = static_cast<std::size_t>(channel);
    const Scalar cutting = G * (by_K[c] + r_1 * by_r[c]);
    Row result;
    result.channel = channel;
    result.measured = measured(m, channel);
    result.model = cutting + per_pitch * (p(cutting_K_te) * edge_t[c] + p(cutting_K_re) * edge_r[c]);
    result.derivatives << cutting, u * cutting, G * by_r[c] * r_1_growth, u * G * by_r[c] * r_1, per_pitch * edge_t[c],
        per_pitch * edge_r[c];
    return result;
}

/// Standard deviation of a measured force, in units of the channel's relative scatter ρ.
template <typename Scalar>
Scalar CuttingFitSolver<Scalar>::error_sd(const Row& r) const {
    using std::sqrt;
    const Scalar floor = channels_[static_cast<std::size_t>(r.channel)].floor_N;
    return sqrt(r.model * r.model + floor * floor);
}

/// Initial values: with the exponents where they are believed to be, and no edge forces, the law is linear in K_s and
/// K_s r_1.
template <typename Scalar>
bool CuttingFitSolver<Scalar>::start() {
    using std::exp;
    using std::log;
    const Scalar pinned = Scalar(1e5);
    const bool linear_edge = options_.form == CuttingLawForm::linear_edge;
    belief_mean_(cutting_p_s) = linear_edge ? Scalar(0) : options_.p_s_mean;
    belief_mean_(cutting_p_1) = linear_edge ? Scalar(0) : options_.p_1_mean;
    result_.parameters = belief_mean_;
    result_.parameters(cutting_r_1) = Scalar(1);
    LeastSquares<Scalar, 2> linear;
    for_each_row([&](const Row& r) {
        const Scalar by_K_r = r.derivatives(cutting_r_1);
        const Scalar by_K = r.derivatives(cutting_ln_K_s) - by_K_r;
        linear.add({by_K, by_K_r}, r.measured, Scalar(1) / (channels_[static_cast<std::size_t>(r.channel)].floor_N));
    });
    const auto solution = linear.solve();
    const Scalar K_s = solution.parameters(0);
    if (!(K_s > Scalar(0))) {
        return false;
    }
    result_.parameters(cutting_ln_K_s) = log(K_s);
    result_.parameters(cutting_r_1) = solution.determined(1) ? solution.parameters(1) / K_s : Scalar(0);
    if (linear_edge) {
        belief_weight_(cutting_p_s) = belief_weight_(cutting_p_1) = pinned;
        return true;
    }
    const bool combined = options_.form == CuttingLawForm::combined;
    const Scalar edge_weight = combined ? Scalar(1) / (options_.edge_thickness_sd_mm * K_s) : pinned;
    belief_weight_(cutting_K_te) = belief_weight_(cutting_K_re) = edge_weight;
    if (combined) {
        belief_weight_(cutting_p_s) = Scalar(1) / options_.p_s_sd;
        belief_weight_(cutting_p_1) = Scalar(1) / options_.p_1_sd;
    }
    return true;
}

template <typename Scalar>
void CuttingFitSolver<Scalar>::add_beliefs(LeastSquares<Scalar, cutting_parameter_count>& fit,
                                           bool steps_from_here) const {
    for (int j = 0; j < cutting_parameter_count; ++j) {
        if (belief_weight_(j) > Scalar(0)) {
            fit.add_prior(j, steps_from_here ? belief_mean_(j) - result_.parameters(j) : Scalar(0), belief_weight_(j));
        }
    }
}

/// How many parameters the cuts, and not the beliefs, decide.
template <typename Scalar>
Scalar CuttingFitSolver<Scalar>::free_parameters() const {
    Scalar sum{0};
    for (int j = 0; j < cutting_parameter_count; ++j) {
        const Scalar believed = result_.covariance(j, j) * belief_weight_(j) * belief_weight_(j);
        sum += believed < Scalar(1) ? Scalar(1) - believed : Scalar(0);
    }
    return sum;
}

/// Scatter of each channel by Huber's proposal 2: Σ min(z², k²) = 0.7102 (n − p) for k = 1.345 and normal errors.
template <typename Scalar>
void CuttingFitSolver<Scalar>::measure_scatter() {
    using std::abs;
    using std::erfc;
    using std::exp;
    using std::sqrt;
    const Scalar k = options_.huber_limit;
    const Scalar outside = erfc(k / sqrt(Scalar(2)));
    const Scalar density = exp(-k * k / 2) * sqrt(Scalar(2) / pi<Scalar>);
    const Scalar expected = Scalar(1) - outside - k * density + k * k * outside;
    const Scalar least_scale = Scalar(1e-5);
    for (Channel& channel : channels_) {
        channel.sum_of_clipped_squares = channel.sum_of_relative_squares = Scalar(0);
        channel.unclipped = channel.odd = 0;
    }
    for_each_row([&](const Row& r) {
        Channel& channel = channels_[static_cast<std::size_t>(r.channel)];
        const Scalar error = abs(r.measured - r.model) / error_sd(r);
        const Scalar z = error / channel.scale;
        channel.sum_of_relative_squares += error * error;
        channel.sum_of_clipped_squares += z < k ? z * z : k * k;
        channel.unclipped += z < k ? 1 : 0;
        channel.odd += z > k + Scalar(3) ? 1 : 0;
    });
    const Scalar spent = free_parameters() / static_cast<Scalar>(rows_);
    for (Channel& channel : channels_) {
        const Scalar free_rows = static_cast<Scalar>(channel.cuts) * (spent < Scalar(0.9F) ? 1 - spent : Scalar(0.1F));
        if (channel.cuts > 0) {
            channel.scale *= sqrt(channel.sum_of_clipped_squares / (expected * free_rows));
            channel.scale = channel.scale < least_scale ? least_scale : channel.scale;
        }
    }
}

/// One Gauss–Newton step with Huber weights; returns its length in standard errors.
template <typename Scalar>
Scalar CuttingFitSolver<Scalar>::step() {
    using std::abs;
    using std::sqrt;
    LeastSquares<Scalar, cutting_parameter_count> fit;
    for_each_row([&](const Row& r) {
        const Scalar sd = error_sd(r) * channels_[static_cast<std::size_t>(r.channel)].scale;
        const Scalar z = abs(r.measured - r.model) / sd;
        const Scalar huber = z > options_.huber_limit ? sqrt(options_.huber_limit / z) : Scalar(1);
        fit.add(r.derivatives, r.measured - r.model, huber / sd);
    });
    add_beliefs(fit, true);
    const auto solution = fit.solve(Scalar(1e6));
    Scalar shrink{1};
    for (const int exponent : {cutting_ln_K_s, cutting_p_s, cutting_p_1}) {
        const Scalar move = abs(solution.parameters(exponent));
        shrink = move * shrink > Scalar(0.5F) ? Scalar(0.5F) / move : shrink;
    }
    result_.parameters += shrink * solution.parameters;
    Scalar length{0};
    const Scalar unit = solution.residual_sd * solution.residual_sd;
    for (int j = 0; j < cutting_parameter_count; ++j) {
        const Scalar variance = solution.covariance(j, j) / unit;
        if (variance > Scalar(0)) {
            const Scalar move = solution.parameters(j) * solution.parameters(j) / variance;
            length = move > length ? move : length;
            result_.covariance(j, j) = variance;
        }
    }
    return sqrt(length);
}

/// Covariance of the estimates: (e JᵀJ + beliefs)⁻¹, e = (share of rows within the limit)²/E[ψ²] of Huber's estimator.
template <typename Scalar>
void CuttingFitSolver<Scalar>::conclude() {
    using std::sqrt;
    Scalar clipped_squares{0};
    int unclipped = 0;
    for (const Channel& channel : channels_) {
        clipped_squares += channel.sum_of_clipped_squares;
        unclipped += channel.unclipped;
    }
    const Scalar n = static_cast<Scalar>(rows_);
    const Scalar spent = smaller(free_parameters() / n, Scalar(0.9F));
    const Scalar within = static_cast<Scalar>(unclipped) / n;
    const Scalar efficiency = within * within * (Scalar(1) - spent) * n / clipped_squares;
    LeastSquares<Scalar, cutting_parameter_count> fit;
    for_each_row([&](const Row& r) {
        const Scalar sd = error_sd(r) * channels_[static_cast<std::size_t>(r.channel)].scale;
        fit.add(r.derivatives, (r.measured - r.model), sqrt(smaller(efficiency, Scalar(1))) / sd);
    });
    add_beliefs(fit, false);
    const auto solution = fit.solve(Scalar(1e6));
    result_.covariance = solution.covariance / (solution.residual_sd * solution.residual_sd);
    result_.undetermined |= solution.undetermined;
}

template <typename Scalar>
void CuttingFitSolver<Scalar>::find_undetermined() {
    const auto flag = [this](int j) { result_.undetermined |= 1U << static_cast<unsigned>(j); };
    const auto vague = [this](int j, Scalar limit) { return !(result_.standard_error(j) < limit); };
    if (vague(cutting_ln_K_s, Scalar(0.5F))) {
        flag(cutting_ln_K_s);
    }
    if (vague(cutting_r_1, Scalar(0.5F))) {
        flag(cutting_r_1);
    }
    if (!result_.determined(cutting_r_1)) {
        flag(cutting_p_1);
        flag(cutting_K_re);
    }
    const bool by_thickness = options_.form == CuttingLawForm::power;
    const Scalar smallest = by_thickness ? thinnest_mm_ : result_.minimum_feed_per_tooth_mm;
    const Scalar largest = by_thickness ? thickest_mm_ : result_.maximum_feed_per_tooth_mm;
    if (!(largest > options_.minimum_feed_ratio * smallest)) {
        for (const int j : {cutting_p_s, cutting_p_1, cutting_K_te, cutting_K_re}) {
            flag(j);
        }
    }
}

template <typename Scalar>
void CuttingFitSolver<Scalar>::fill_law() {
    using std::exp;
    const Vector& p = result_.parameters;
    CuttingLaw<Scalar>& law = result_.law;
    law.p_s = p(cutting_p_s);
    law.p_1 = p(cutting_p_1);
    law.k_s_N_per_mm2 = exp(p(cutting_ln_K_s) - law.p_s * ln_t_ref_);
    law.k_1 = p(cutting_r_1) * exp(-law.p_1 * ln_t_ref_);
    law.K_te_N_per_mm = p(cutting_K_te);
    law.K_re_N_per_mm = p(cutting_K_re);
    law.minimum_chip_thickness_mm = thinnest_mm_;
    law.maximum_chip_thickness_mm = thickest_mm_;
    using std::sqrt;
    const auto scatter = [](const Channel& channel) {
        const Scalar n = static_cast<Scalar>(channel.cuts);
        return CuttingScatter<Scalar>{channel.scale,
                                      channel.cuts > 0 ? sqrt(channel.sum_of_relative_squares / n) : Scalar(0),
                                      channel.floor_N, channel.cuts, channel.odd};
    };
    result_.tangential = scatter(channels_[0]);
    result_.feed = scatter(channels_[1]);
    result_.normal = scatter(channels_[2]);
}

template <typename Scalar>
CuttingFit<Scalar> CuttingFitSolver<Scalar>::run() {
    constexpr int most_steps = 60;
    if (!survey() || !start()) {
        result_.undetermined = (1U << static_cast<unsigned>(cutting_parameter_count)) - 1U;
        return result_;
    }
    for (int k = 0; k < most_steps && !(k > 5 && result_.converged); ++k) {
        result_.converged = step() < Scalar(0.01F);
        measure_scatter();
    }
    conclude();
    find_undetermined();
    fill_law();
    fill_doubts();
    return result_;
}

}  // namespace millforce::estimation::detail

#include "estimation_calibration/detail/cutting_fit_doubt.hpp"

namespace millforce::estimation {

template <typename Scalar>
CuttingFit<Scalar> fit_cutting_law(std::span<const CuttingMeasurement<Scalar>> cuts,
                                   const CuttingFitOptions<Scalar>& options) {
    return detail::CuttingFitSolver<Scalar>(cuts, options).run();
}

}  // namespace millforce::estimation
