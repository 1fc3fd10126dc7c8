// SPDX-License-Identifier: Apache-2.0
#include "calibration/motion_friction.hpp"

#include "calibration/axis_motion.hpp"
#include "calibration/calibration_report.hpp"
#include "calibration/plausible_drives.hpp"
#include "calibration/signal.hpp"
#include "estimation_calibration/friction_fit.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace millforce::host {

namespace {

using estimation::MechanicalFrictionFit;

/// One form of the friction, without the terms that the motion does not determine.
template <int N>
struct FormFit {
    estimation::LeastSquaresSolution<double, N> solution{};
    double correlation = 1.0;  ///< samples worth one independent sample
    unsigned held_at_zero = 0;
    std::vector<FittedValue> left_out;

    [[nodiscard]] bool is_held(std::size_t j) const { return ((held_at_zero >> j) & 1U) != 0U; }
    [[nodiscard]] double standard_error(int j) const { return solution.standard_error(j) * std::sqrt(correlation); }
};

struct MechanicalResult {
    FormFit<4> symmetric;
    FormFit<5> directional;
};

/// The samples [from, to) of each recording, as shares of its length, that are faster than the minimum.
template <typename Take>
void for_each_sample(const std::vector<AxisMotion>& motions, double from, double to, double minimum_speed_m_s,
                     Take take) {
    for (const AxisMotion& motion : motions) {
        const auto n = static_cast<double>(motion.velocity_m_s.size());
        for (auto k = static_cast<std::size_t>(from * n); k < static_cast<std::size_t>(to * n); ++k) {
            if (std::abs(motion.velocity_m_s[k]) > minimum_speed_m_s) {
                take(motion.velocity_m_s[k], motion.acceleration_m_s2[k], motion.motor_force_N[k]);
            }
        }
    }
}

MechanicalFrictionFit squares_of(const std::vector<AxisMotion>& motions, double from, double to,
                                 double minimum_speed_m_s) {
    MechanicalFrictionFit fit(minimum_speed_m_s);
    for_each_sample(motions, from, to, minimum_speed_m_s, [&](double v, double a, double F) { fit.add(v, a, F); });
    return fit;
}

template <typename Friction>
double correlation_of(const std::vector<AxisMotion>& motions, double from, double to, double minimum_speed_m_s,
                      const Friction& friction) {
    std::vector<double> residuals;
    for_each_sample(motions, from, to, minimum_speed_m_s,
                    [&](double v, double a, double F) { residuals.push_back(F - friction.force_N(v, a)); });
    return correlated_samples(residuals);
}

/// Terms that are smaller than their standard error are left out, one by one; the mass, the first, stays.
template <int N, typename Keys, typename Solve>
void leave_out_vague_terms(FormFit<N>& fit, const Keys& keys, Solve solve) {
    std::vector<int> candidates;
    for (int j = 1; j < N; ++j) {
        candidates.push_back(j);
    }
    while (const auto vague = most_vague(fit.solution, candidates, std::sqrt(fit.correlation))) {
        std::erase(candidates, *vague);
        fit.left_out.push_back(
            {keys[static_cast<std::size_t>(*vague)], fit.solution.parameters(*vague), fit.standard_error(*vague)});
        fit.held_at_zero |= 1U << static_cast<unsigned>(*vague);
        fit.solution = solve(fit.held_at_zero);
    }
}

[[noreturn]] void refuse(const std::vector<std::filesystem::path>& files, std::string_view parameter,
                         std::string_view why) {
    throw InputError(fmt::format("{}: '{}' cannot be determined: {}", files.front().string(), parameter, why));
}

void refuse_what_motion_lacks(const FrictionCalibrationOptions& options, const MechanicalResult& result) {
    const auto& s = result.symmetric.solution;
    if (s.rows == 0) {
        refuse(
            options.data, "coulomb_N",
            fmt::format("the axis is never faster than {} mm/s; expected travel in both directions at several speeds",
                        options.minimum_speed_mm_s));
    }
    if (!result.directional.solution.determined(estimation::positive_coulomb)) {
        refuse(options.data, "positive_coulomb_N",
               "no travel in + direction, or at one speed only; expected two speeds");
    }
    if (!result.directional.solution.determined(estimation::negative_coulomb)) {
        refuse(options.data, "negative_coulomb_N",
               "no travel in − direction, or at one speed only; expected two speeds");
    }
    const double mass = s.parameters(estimation::symmetric_mass);
    if (!s.determined(estimation::symmetric_mass) ||
        !(result.symmetric.standard_error(estimation::symmetric_mass) < std::abs(mass) / 3.0)) {
        refuse(options.data, "mass_kg", "its force is lost in the noise; expected acceleration and braking");
    }
    for (const int j : {estimation::symmetric_viscous, estimation::symmetric_coulomb}) {
        if (!s.determined(j)) {
            refuse(options.data, symmetric_friction_keys[static_cast<std::size_t>(j)].name,
                   "the speeds are too much alike; expected several speeds in both directions");
        }
    }
}

/// What only a wrong sign gives.
void refuse_reversed_signs(const FrictionCalibrationOptions& options, const std::vector<AxisMotion>& motions,
                           const MechanicalResult& result) {
    const auto friction = estimation::symmetric_friction(result.symmetric.solution);
    double along_N = 0.0;
    double count = 0.0;
    for_each_sample(motions, 0.0, 1.0, options.minimum_speed_mm_s / 1000.0, [&](double v, double, double) {
        along_N += friction.coulomb_N + friction.viscous_N_s_per_m * std::abs(v);
        count += 1.0;
    });
    along_N /= count;
    const std::string file = options.data.front().string();
    if (along_N < 0.0) {
        throw InputError(
            fmt::format("{}: the motor's force is opposite to the motion: {:.4g} N of friction on average, "
                        "mass_kg = {:.4g}; expected a positive motor_force_N for travel in +; is the sign of "
                        "motor_force_N or of position_m reversed?",
                        file, along_N, friction.mass_kg));
    }
    if (friction.mass_kg < 0.0) {
        throw InputError(
            fmt::format("{}: 'mass_kg' = {:.4g}: the motor's force is opposite to the acceleration; expected "
                        "a positive mass; is the sign of the acceleration's share of motor_force_N reversed?",
                        file, friction.mass_kg));
    }
}

MechanicalResult fit_or_refuse(const FrictionCalibrationOptions& options, const std::vector<AxisMotion>& motions) {
    const double minimum_speed_m_s = options.minimum_speed_mm_s / 1000.0;
    const MechanicalFrictionFit squares = squares_of(motions, 0.0, 1.0, minimum_speed_m_s);
    MechanicalResult result;
    result.symmetric.solution = squares.symmetric();
    result.directional.solution = squares.directional();
    result.symmetric.correlation =
        correlation_of(motions, 0.0, 1.0, minimum_speed_m_s, estimation::symmetric_friction(result.symmetric.solution));
    result.directional.correlation = correlation_of(motions, 0.0, 1.0, minimum_speed_m_s,
                                                    estimation::directional_friction(result.directional.solution));
    refuse_what_motion_lacks(options, result);
    refuse_reversed_signs(options, motions, result);
    leave_out_vague_terms(result.symmetric, symmetric_friction_keys,
                          [&](unsigned held) { return squares.symmetric(held); });
    leave_out_vague_terms(result.directional, directional_friction_keys,
                          [&](unsigned held) { return squares.directional(held); });
    return result;
}

/// The second half of each recording against what its first half predicts.
struct SecondHalf {
    bool is_there = false;
    double phantom_N = 0.0;  ///< force that the axis seems to feel, rms
    double bound_N = 0.0;    ///< 1.5 times the residual of all samples and the first half's standard errors
    double excess = 0.0;     ///< friction more than predicted, as a share of the predicted
    double excess_sd = 0.0;  ///< standard deviation of that

    [[nodiscard]] bool has_changed() const {
        constexpr double significance = 4.0;
        return is_there &&
               (phantom_N > bound_N || std::abs(excess) > std::max(largest_change, significance * excess_sd));
    }
    /// A change by the bound would be seen.
    [[nodiscard]] bool is_certain() const { return is_there && (has_changed() || 2.0 * excess_sd < largest_change); }

    static constexpr double largest_change = 0.1;
};

SecondHalf second_half(const std::vector<AxisMotion>& motions, double minimum_speed_m_s, double residual_N) {
    constexpr double fewest_independent = 10.0;
    constexpr double allowed_ratio = 1.5;
    const auto first = squares_of(motions, 0.0, 0.5, minimum_speed_m_s).directional();
    if (first.undetermined != 0U) {
        return {};
    }
    const auto friction = estimation::directional_friction(first);
    const double correlation = correlation_of(motions, 0.0, 0.5, minimum_speed_m_s, friction);
    std::vector<double> excess_N;
    double squares = 0.0;
    double predicted_N = 0.0;
    double prediction_variance = 0.0;
    Eigen::Matrix<double, 5, 1> mean_row = Eigen::Matrix<double, 5, 1>::Zero();
    for_each_sample(motions, 0.5, 1.0, minimum_speed_m_s, [&](double v, double a, double F) {
        const double direction = std::copysign(1.0, v);
        const auto row = estimation::directional_regressors(v, a);
        const double phantom_N = F - friction.force_N(v, a);
        excess_N.push_back(direction * phantom_N);
        squares += phantom_N * phantom_N;
        predicted_N += direction * (friction.force_N(v, a) - friction.mass_kg * a);
        prediction_variance += correlation * row.dot(first.covariance * row);
        mean_row += direction * row;
    });
    const auto n = static_cast<double>(excess_N.size());
    if (n / correlation < fewest_independent || first.rows / correlation < fewest_independent) {
        return {};
    }
    double mean_N = 0.0;
    for (const double excess : excess_N) {
        mean_N += excess / n;
    }
    for (double& excess : excess_N) {
        excess -= mean_N;
    }
    mean_row /= n;
    const double variance = std::max(0.0, squares / n - mean_N * mean_N);
    const double mean_variance =
        correlation * mean_row.dot(first.covariance * mean_row) + variance * correlated_samples(excess_N) / n;
    SecondHalf result;
    result.is_there = predicted_N > 0.0;
    result.phantom_N = std::sqrt(squares / n);
    result.bound_N = allowed_ratio * std::sqrt(residual_N * residual_N + prediction_variance / n);
    result.excess = mean_N * n / predicted_N;
    result.excess_sd = std::sqrt(mean_variance) * n / predicted_N;
    return result;
}

/// Prints whether the friction kept; returns false where it did not.
bool check_second_half(std::ostream& out, const SecondHalf& half) {
    if (!half.is_there) {
        out << "cannot tell whether the friction changed: one half of the data alone does not determine it\n";
        return true;
    }
    out << fmt::format(
        "fitted on the first half, phantom force in the second: {:.2f} N rms, bound {:.2f} N; friction {:+.1f} ± "
        "{:.1f} %, bound {:.0f} %: {}\n",
        half.phantom_N, half.bound_N, 100.0 * half.excess, 200.0 * half.excess_sd, 100.0 * SecondHalf::largest_change,
        half.has_changed()  ? "BROKEN: the friction changed"
        : half.is_certain() ? "holds"
                            : "cannot tell, the first half does not determine the friction well enough");
    return !half.has_changed();
}

template <int N, typename Keys>
void report(std::ostream& out, TomlWriter& toml, const Keys& keys, const FormFit<N>& fit) {
    for (std::size_t j = 0; j < keys.size(); ++j) {
        const int index = static_cast<int>(j);
        if (!fit.is_held(j)) {
            const FittedValue fitted{keys[j], fit.solution.parameters(index), fit.standard_error(index)};
            print_fitted(out, fitted);
            write_fitted(toml, fitted);
        }
    }
    for (const FittedValue& left_out : fit.left_out) {
        print_left_out(out, left_out);
    }
    out << fmt::format("  residual {:.2f} N rms\n", fit.solution.residual_rms);
}

/// The same friction as the current that the controller takes off: I_f = K_x2 w + K_x3 by direction. What pulls one way
/// is in gravity_A (estimation/drives/feed_drive.hpp).
void write_as_current(std::ostream& out, TomlWriter& toml, const FormFit<5>& fit, double force_constant_N_per_A) {
    constexpr double m_s_per_m_min = 1.0 / 60.0;
    const double A_per_N = 1.0 / force_constant_N_per_A;
    const auto value = [&](int j) { return fit.solution.parameters(j) * A_per_N; };
    const auto error = [&](int j) { return fit.standard_error(j) * A_per_N; };
    const double dry_A = 0.5 * std::hypot(error(estimation::positive_coulomb), error(estimation::negative_coulomb));
    using estimation::negative_coulomb;
    using estimation::positive_coulomb;
    out << fmt::format("as a current, by {:g} N/A:\n", force_constant_N_per_A);
    for (const FittedValue& fitted :
         {FittedValue{feed_current_keys[estimation::positive_K_x2], value(estimation::positive_viscous) * m_s_per_m_min,
                      error(estimation::positive_viscous) * m_s_per_m_min},
          FittedValue{feed_current_keys[estimation::negative_K_x2], value(estimation::negative_viscous) * m_s_per_m_min,
                      error(estimation::negative_viscous) * m_s_per_m_min},
          FittedValue{feed_current_keys[estimation::common_K_x3],
                      0.5 * (value(positive_coulomb) + value(negative_coulomb)), dry_A},
          FittedValue{feed_current_keys[estimation::gravity_offset],
                      0.5 * (value(positive_coulomb) - value(negative_coulomb)), dry_A}}) {
        print_fitted(out, fitted);
        write_fitted(toml, fitted);
    }
    toml.key(feed_gain_key.name, force_constant_N_per_A);
}

void refuse_files_given_twice(const std::vector<std::filesystem::path>& files) {
    for (std::size_t k = 0; k < files.size(); ++k) {
        for (std::size_t j = 0; j < k; ++j) {
            std::error_code none;
            if (std::filesystem::equivalent(files[j], files[k], none)) {
                throw InputError(fmt::format("{}: given twice; expected each recording once", files[k].string()));
            }
        }
    }
}

}  // namespace

int calibrate_motion_friction(const FrictionCalibrationOptions& options, std::ostream& out) {
    refuse_files_given_twice(options.data);
    std::vector<AxisMotion> motions;
    for (const auto& file : options.data) {
        motions.push_back(read_axis_motion(file, options.low_pass_hz));
    }
    const MechanicalResult result = fit_or_refuse(options, motions);
    const UnitQuestions questions = look_at_axis_mass(options.data.front().string(),
                                                      result.symmetric.solution.parameters(estimation::symmetric_mass));

    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Friction of a feed axis without load: F = M a + F_v v + F_c sign(v) + offset, and by direction.");
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.table(options.axis);
    out << fmt::format("{}: F = M a + F_v v + F_c sign(v) + offset, {} samples faster than {} mm/s, low-pass {} Hz\n",
                       options.axis, result.symmetric.solution.rows, options.minimum_speed_mm_s, options.low_pass_hz);
    report(out, toml, symmetric_friction_keys, result.symmetric);
    out << "by direction:\n";
    report(out, toml, directional_friction_keys, result.directional);
    toml.key(friction_force_residual_key.name, result.directional.solution.residual_rms);
    if (options.force_constant_N_per_A) {
        write_as_current(out, toml, result.directional, *options.force_constant_N_per_A);
    } else {
        out << "the controller does not use friction in newtons: with --force-constant K_x2, K_x3, gravity_A and K_x4 "
               "are written, too\n";
    }
    file.commit();
    const bool holds = check_second_half(
        out, second_half(motions, options.minimum_speed_mm_s / 1000.0, result.directional.solution.residual_rms));
    return ask(out, questions, holds ? exit_done : exit_bound_broken);
}

}  // namespace millforce::host
