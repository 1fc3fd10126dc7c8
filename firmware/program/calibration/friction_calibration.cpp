// SPDX-License-Identifier: Apache-2.0
#include "calibration/friction_calibration.hpp"

#include "calibration/axis_motion.hpp"
#include "calibration/calibration_report.hpp"
#include "calibration/signal.hpp"
#include "estimation_calibration/friction_fit.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace millforce::host {

namespace {

using estimation::FeedCurrentFit;
using estimation::MechanicalFrictionFit;

struct MechanicalResult {
    estimation::LeastSquaresSolution<double, 4> symmetric;
    estimation::LeastSquaresSolution<double, 5> directional;
    double symmetric_correlation = 1.0;  ///< samples worth one independent sample
    double directional_correlation = 1.0;
};

/// Samples [from, to) of each recording, as shares of its length.
MechanicalResult fit_motion(const std::vector<AxisMotion>& motions, double from, double to, double minimum_speed_m_s) {
    MechanicalFrictionFit fit(minimum_speed_m_s);
    const auto for_each = [&](auto f) {
        for (const AxisMotion& motion : motions) {
            const auto n = static_cast<double>(motion.velocity_m_s.size());
            for (auto k = static_cast<std::size_t>(from * n); k < static_cast<std::size_t>(to * n); ++k) {
                f(motion.velocity_m_s[k], motion.acceleration_m_s2[k], motion.motor_force_N[k]);
            }
        }
    };
    for_each([&](double v, double a, double F) { fit.add(v, a, F); });
    MechanicalResult result{fit.symmetric(), fit.directional(), 1.0, 1.0};
    const auto symmetric = estimation::symmetric_friction(result.symmetric);
    const auto directional = estimation::directional_friction(result.directional);
    std::vector<double> symmetric_residuals;
    std::vector<double> directional_residuals;
    for_each([&](double v, double a, double F) {
        if (std::abs(v) > minimum_speed_m_s) {
            symmetric_residuals.push_back(F - symmetric.force_N(v, a));
            directional_residuals.push_back(F - directional.force_N(v, a));
        }
    });
    result.symmetric_correlation = correlated_samples(symmetric_residuals);
    result.directional_correlation = correlated_samples(directional_residuals);
    return result;
}

/// The force that the axis seems to feel in the second half of each recording, by the friction of the first half. N
/// rms.
double phantom_force_N(const std::vector<AxisMotion>& motions, double minimum_speed_m_s) {
    const auto first = fit_motion(motions, 0.0, 0.5, minimum_speed_m_s);
    if (first.directional.undetermined != 0U) {
        return no_estimate;
    }
    const auto friction = estimation::directional_friction(first.directional);
    double sum = 0.0;
    double count = 0.0;
    for (const AxisMotion& motion : motions) {
        for (std::size_t k = motion.velocity_m_s.size() / 2; k < motion.velocity_m_s.size(); ++k) {
            if (std::abs(motion.velocity_m_s[k]) > minimum_speed_m_s) {
                const double phantom =
                    motion.motor_force_N[k] - friction.force_N(motion.velocity_m_s[k], motion.acceleration_m_s2[k]);
                sum += phantom * phantom;
                count += 1.0;
            }
        }
    }
    return count > 0.0 ? std::sqrt(sum / count) : no_estimate;
}

[[noreturn]] void refuse(const std::vector<std::filesystem::path>& files, std::string_view parameter,
                         std::string_view why) {
    throw InputError(fmt::format("{}: '{}' cannot be determined: {}", files.front().string(), parameter, why));
}

void refuse_what_motion_lacks(const FrictionCalibrationOptions& options, const MechanicalResult& result) {
    const auto& s = result.symmetric;
    if (s.rows == 0) {
        refuse(
            options.data, "coulomb_N",
            fmt::format("the axis is never faster than {} mm/s; expected travel in both directions at several speeds",
                        options.minimum_speed_mm_s));
    }
    if (!result.directional.determined(estimation::positive_coulomb)) {
        refuse(options.data, "positive_coulomb_N",
               "no travel in + direction, or at one speed only; expected two speeds");
    }
    if (!result.directional.determined(estimation::negative_coulomb)) {
        refuse(options.data, "negative_coulomb_N",
               "no travel in − direction, or at one speed only; expected two speeds");
    }
    const auto vague = [&](int j) {
        return !s.determined(j) ||
               !(s.standard_error(j) * std::sqrt(result.symmetric_correlation) < std::abs(s.parameters(j)) / 3.0);
    };
    if (vague(estimation::symmetric_mass)) {
        refuse(options.data, "mass_kg", "its force is lost in the noise; expected acceleration and braking");
    }
    for (const int j : {estimation::symmetric_viscous, estimation::symmetric_coulomb}) {
        if (!s.determined(j)) {
            refuse(options.data, symmetric_friction_keys[static_cast<std::size_t>(j)].name,
                   "the speeds are too much alike; expected several speeds in both directions");
        }
    }
}

int calibrate_motion(const FrictionCalibrationOptions& options, std::ostream& out) {
    const double minimum_speed_m_s = options.minimum_speed_mm_s / 1000.0;
    std::vector<AxisMotion> motions;
    for (const auto& file : options.data) {
        motions.push_back(read_axis_motion(file, options.low_pass_hz));
    }
    const MechanicalResult result = fit_motion(motions, 0.0, 1.0, minimum_speed_m_s);
    refuse_what_motion_lacks(options, result);
    const double phantom_N = phantom_force_N(motions, minimum_speed_m_s);

    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Friction of a feed axis without load: F = M a + F_v v + F_c sign(v) + offset, and by direction.");
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.table(options.axis);
    out << fmt::format("{}: F = M a + F_v v + F_c sign(v) + offset, {} samples faster than {} mm/s, low-pass {} Hz\n",
                       options.axis, result.symmetric.rows, options.minimum_speed_mm_s, options.low_pass_hz);
    const auto report = [&](const auto& keys, const auto& solution, double correlation) {
        for (std::size_t j = 0; j < keys.size(); ++j) {
            const int index = static_cast<int>(j);
            const FittedValue fitted{keys[j], solution.parameters(index),
                                     solution.standard_error(index) * std::sqrt(correlation)};
            print_fitted(out, fitted);
            write_fitted(toml, fitted);
        }
        out << fmt::format("  residual {:.2f} N rms\n", solution.residual_rms);
    };
    report(symmetric_friction_keys, result.symmetric, result.symmetric_correlation);
    out << "by direction:\n";
    report(directional_friction_keys, result.directional, result.directional_correlation);
    toml.key(friction_force_residual_key.name, result.directional.residual_rms);
    file.commit();

    const double bound_N = 1.5 * result.directional.residual_rms;
    const bool holds = !(phantom_N > bound_N);
    out << (std::isnan(phantom_N)
                ? std::string("the first half alone cannot determine the friction: no check on the second half\n")
                : fmt::format(
                      "fitted on the first half, phantom force in the second: {:.2f} N rms, bound {:.2f} N: {}\n",
                      phantom_N, bound_N, holds ? "holds" : "BROKEN: the friction changed"));
    return holds ? exit_done : exit_bound_broken;
}

/// Feeds of one direction that differ from each other by more than a tenth.
std::size_t distinct_feeds(const std::vector<SteadyFeed>& feeds, double direction) {
    std::vector<double> sizes;
    for (const SteadyFeed& feed : feeds) {
        if (feed.feed_m_per_min * direction > 0.0) {
            sizes.push_back(std::abs(feed.feed_m_per_min));
        }
    }
    std::sort(sizes.begin(), sizes.end());
    std::size_t count = 0;
    double last = 0.0;
    for (const double size : sizes) {
        if (size > 1.1 * last) {
            ++count;
            last = size;
        }
    }
    return count;
}

/// Why an axis cannot be fitted; empty where it can.
std::string what_the_axis_lacks(char axis, const std::vector<SteadyFeed>& feeds) {
    for (const double direction : {1.0, -1.0}) {
        const std::size_t count = distinct_feeds(feeds, direction);
        const char sign = direction > 0.0 ? '+' : '-';
        if (count == 0) {
            return fmt::format(
                "'{}.gravity_A' cannot be told from K_x3_A: no steady travel in air in {}{}; "
                "expected at least three different feeds in each direction",
                axis, sign, axis);
        }
        if (count < 3) {
            return fmt::format(
                "'{}.K_x1_{}_A_min2_per_m2' cannot be determined: {} steady feed(s) in air in "
                "{}{}; expected at least three different ones",
                axis, direction > 0.0 ? "positive" : "negative", count, sign, axis);
        }
    }
    if (feeds.size() < feed_current_keys.size() + 1) {
        return fmt::format("'{}': six steady feeds leave no residual; expected at least one more", axis);
    }
    return {};
}

void fit_axis(char axis, const std::vector<SteadyFeed>& feeds, TomlWriter& toml, std::ostream& out) {
    FeedCurrentFit fit;
    for (const SteadyFeed& feed : feeds) {
        fit.add(feed.feed_m_per_min, feed.current_A);
    }
    const auto solution = fit.solve();
    toml.table(std::string_view(&axis, 1));
    out << fmt::format("{}: I_f(w) = K_x1 w² + K_x2 w + K_x3, w in m/min, {} steady feeds in air\n", axis,
                       feeds.size());
    for (std::size_t j = 0; j < feed_current_keys.size(); ++j) {
        const int index = static_cast<int>(j);
        const FittedValue fitted{feed_current_keys[j], solution.parameters(index), solution.standard_error(index)};
        print_fitted(out, fitted);
        write_fitted(toml, fitted);
    }
    toml.key(friction_current_residual_key.name, solution.residual_rms);
    out << fmt::format("  residual {:.4g} A rms\n", solution.residual_rms);
}

int calibrate_recording(const FrictionCalibrationOptions& options, std::ostream& out) {
    std::ostringstream fitted_text;
    TomlWriter fitted_toml(fitted_text);
    std::string first_refusal;
    bool any = false;
    for (const char axis : {'x', 'y', 'z'}) {
        std::vector<SteadyFeed> feeds;
        for (const auto& file : options.data) {
            const auto found = read_steady_feeds(file, axis, options.minimum_speed_mm_s);
            feeds.insert(feeds.end(), found.begin(), found.end());
        }
        if (feeds.empty()) {
            continue;
        }
        const std::string lack = what_the_axis_lacks(axis, feeds);
        if (lack.empty()) {
            fit_axis(axis, feeds, fitted_toml, out);
            any = true;
        } else {
            first_refusal = first_refusal.empty() ? lack : first_refusal;
            out << fmt::format("{}: left out: {}\n", axis, lack);
        }
    }
    if (!any) {
        throw InputError(
            fmt::format("{}: {}", options.data.front().string(),
                        first_refusal.empty()
                            ? std::string("'K_x1' to 'K_x3' cannot be determined: no axis with AXIS_velocity_mm_s "
                                          "and AXIS_current_A moves steadily for 0.3 s; expected air cuts at three "
                                          "feeds in each direction")
                            : first_refusal));
    }
    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Friction current of feed drives in air: I_f(w) = K_x1 w^2 + K_x2 w + K_x3, w in m/min, I in A.");
    toml.comment("Fitted from " + list_of_files(options.data));
    file.stream() << fitted_text.str();
    file.commit();
    return exit_done;
}

}  // namespace

int calibrate_friction(const FrictionCalibrationOptions& options, std::ostream& out) {
    if (options.data.empty()) {
        throw InputError("calibrate friction: no data file; expected at least one CSV file");
    }
    const bool motion = is_axis_motion(options.data.front());
    for (const auto& file : options.data) {
        if (is_axis_motion(file) != motion) {
            throw InputError(
                fmt::format("{}:1: the columns are of another kind than those of {}; expected position_m in "
                            "all files or in none",
                            file.string(), options.data.front().string()));
        }
    }
    return motion ? calibrate_motion(options, out) : calibrate_recording(options, out);
}

}  // namespace millforce::host
