// SPDX-License-Identifier: Apache-2.0
#include "calibration/friction_calibration.hpp"

#include "calibration/axis_motion.hpp"
#include "calibration/calibration_report.hpp"
#include "calibration/motion_friction.hpp"
#include "calibration/plausible_drives.hpp"
#include "estimation/number/student_t.hpp"
#include "estimation_calibration/friction_fit.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace millforce::host {

namespace {

using estimation::FeedCurrentFit;

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
                "'{}.gravity_A' cannot be separated from K_x3_A: no steady travel in air in {}{}; "
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

/// The friction current of an axis, without the terms that the feeds do not determine.
struct AxisFit {
    estimation::LeastSquaresSolution<double, 6> solution{};
    unsigned held_at_zero = 0;
    std::vector<FittedValue> left_out;
    double curvature_sd = 0.0;  ///< of K_x1, the larger of both directions, before any term was left out

    [[nodiscard]] bool is_held(int j) const { return ((held_at_zero >> static_cast<unsigned>(j)) & 1U) != 0U; }
    /// Along the motion: positive, unless a sign is reversed.
    [[nodiscard]] double friction_A(double feed_m_per_min) const {
        const double current_A = estimation::feed_friction_current_A(solution.parameters, feed_m_per_min) -
                                 solution.parameters(estimation::gravity_offset);
        return std::copysign(1.0, feed_m_per_min) * current_A;
    }
};

AxisFit fit_what_is_determined(const std::vector<SteadyFeed>& feeds) {
    FeedCurrentFit fit;
    for (const SteadyFeed& feed : feeds) {
        fit.add(feed.feed_m_per_min, feed.current_A);
    }
    AxisFit result;
    result.solution = fit.solve();
    result.curvature_sd = std::max(result.solution.standard_error(estimation::positive_K_x1),
                                   result.solution.standard_error(estimation::negative_K_x1));
    const auto leave_out = [&](std::vector<int> candidates, auto band) {
        while (const auto vague = most_vague(result.solution, candidates, band())) {
            std::erase(candidates, *vague);
            result.left_out.push_back({feed_current_keys[static_cast<std::size_t>(*vague)],
                                       result.solution.parameters(*vague), result.solution.standard_error(*vague)});
            result.held_at_zero |= 1U << static_cast<unsigned>(*vague);
            result.solution = fit.solve(result.held_at_zero);
        }
    };
    // Over a short range of feeds a parabola and a line of opposite signs fit the noise: beyond it they are far off.
    leave_out({estimation::positive_K_x1, estimation::negative_K_x1}, [&] {
        const auto parameters = static_cast<double>(feed_current_keys.size() - result.left_out.size());
        return estimation::student_t_975(static_cast<double>(feeds.size()) - parameters);
    });
    leave_out(
        {estimation::positive_K_x2, estimation::negative_K_x2, estimation::common_K_x3, estimation::gravity_offset},
        [] { return 1.0; });
    return result;
}

/// Over all feeds, along the motion.
double mean_friction_A(const std::vector<SteadyFeed>& feeds, const AxisFit& fit) {
    double friction_A = 0.0;
    for (const SteadyFeed& feed : feeds) {
        friction_A += fit.friction_A(feed.feed_m_per_min) / static_cast<double>(feeds.size());
    }
    return friction_A;
}

void refuse_what_no_axis_has(const std::string& file, char axis, const std::vector<SteadyFeed>& feeds,
                             const AxisFit& fit) {
    constexpr double largest_current_A = 100.0;
    const double friction_A = mean_friction_A(feeds, fit);
    if (friction_A < 0.0) {
        throw InputError(fmt::format(
            "{}: {}: the current is opposite to the motion: {:.4g} A of friction on average; expected a "
            "positive current for travel in +{}; is the sign of {}_current_A or of {}_velocity_mm_s reversed?",
            file, axis, friction_A, axis, axis, axis));
    }
    if (friction_A > largest_current_A) {
        throw InputError(
            fmt::format("{}: {}: {:.4g} A of friction on average; expected at most {:g} A; is {}_current_A in mA?",
                        file, axis, friction_A, largest_current_A, axis));
    }
    for (const auto& [linear, quadratic] : {std::pair(estimation::positive_K_x2, estimation::positive_K_x1),
                                            std::pair(estimation::negative_K_x2, estimation::negative_K_x1)}) {
        if (fit.is_held(estimation::common_K_x3) && fit.is_held(linear) && fit.is_held(quadratic)) {
            throw InputError(
                fmt::format("{}: '{}.K_x3_A' cannot be determined: no friction beyond the noise of the "
                            "current; expected longer stretches at steady feed",
                            file, axis));
        }
    }
}

/// How the friction changed from the first to the last stretch, as a share of itself.
struct FrictionDrift {
    double share = no_estimate;
    double standard_error = no_estimate;
    double degrees_of_freedom = 0.0;
};

/// Fitted beside the friction itself, because feeds and time mostly rise together: where they do so too closely, the
/// standard error is large.
FrictionDrift drift_of(const std::vector<SteadyFeed>& feeds, const AxisFit& fit) {
    constexpr int drift = 6;  // after the six of FeedCurrentIndex
    const auto [first, last] = std::minmax_element(
        feeds.begin(), feeds.end(), [](const SteadyFeed& a, const SteadyFeed& b) { return a.middle_s < b.middle_s; });
    const double length_s = last->middle_s - first->middle_s;
    estimation::LeastSquares<double, 7> squares;
    for (const SteadyFeed& feed : feeds) {
        const double w = feed.feed_m_per_min;
        Eigen::Matrix<double, 7, 1> row;
        row << estimation::feed_current_regressors(w),
            (feed.middle_s - first->middle_s) / length_s * std::copysign(fit.friction_A(w), w);
        squares.add(row, feed.current_A);
    }
    int free_rows = squares.rows() - 7;
    for (int j = 0; j < drift; ++j) {
        if (fit.is_held(j)) {
            constexpr double holding_weight = 1e9;
            squares.add_prior(j, 0.0, holding_weight);
            ++free_rows;
        }
    }
    const auto solution = squares.solve();
    return free_rows > 0 && solution.determined(drift)
               ? FrictionDrift{solution.parameters(drift), solution.standard_error(drift),
                               static_cast<double>(free_rows)}
               : FrictionDrift{};
}

/// Prints whether the friction kept; returns false where it did not.
bool check_drift(std::ostream& out, const FrictionDrift& drift) {
    constexpr double largest_change = 0.1;
    if (std::isnan(drift.standard_error)) {
        out << "  cannot tell whether the friction changed: too few steady feeds\n";
        return true;
    }
    const double half_band = estimation::student_t_975(drift.degrees_of_freedom) * drift.standard_error;
    const bool changed = std::abs(drift.share) > std::max(largest_change, 2.0 * half_band);
    const bool is_certain = changed || half_band < largest_change;
    out << fmt::format("  friction from the first stretch to the last: {:+.1f} ± {:.1f} %, bound {:.0f} %: {}\n",
                       100.0 * drift.share, 100.0 * half_band, 100.0 * largest_change,
                       changed      ? "BROKEN: the friction changed"
                       : is_certain ? "holds"
                                    : "cannot tell, since feed and time rise together or the feeds are few");
    return !changed;
}

/// The feeds from which the friction is known, and how uncertain it is beyond them.
void write_range(const std::vector<SteadyFeed>& feeds, const AxisFit& fit, TomlWriter& toml, std::ostream& out) {
    const auto [slowest, fastest] =
        std::minmax_element(feeds.begin(), feeds.end(), [](const SteadyFeed& a, const SteadyFeed& b) {
            return std::abs(a.feed_m_per_min) < std::abs(b.feed_m_per_min);
        });
    const double slow = std::abs(slowest->feed_m_per_min);
    const double fast = std::abs(fastest->feed_m_per_min);
    toml.key(slowest_friction_feed_key.name, slow);
    toml.key(fastest_friction_feed_key.name, fast);
    toml.key(friction_curvature_sd_key.name, fit.curvature_sd);
    const auto doubt_at_A = [&](double w) { return fit.curvature_sd * (w - fast) * (w - slow); };
    out << fmt::format("  known from {:.3g} to {:.3g} m/min; at {:.3g} m/min ± {:.2g} A, at {:.3g} m/min ± {:.2g} A\n",
                       slow, fast, 2.0 * fast, doubt_at_A(2.0 * fast), 10.0 * fast, doubt_at_A(10.0 * fast));
}

/// Writes the axis' table; returns whether its friction kept.
bool fit_axis(const std::string& file, char axis, const std::vector<SteadyFeed>& feeds, TomlWriter& toml,
              std::ostream& out, UnitQuestions& questions) {
    const AxisFit fit = fit_what_is_determined(feeds);
    refuse_what_no_axis_has(file, axis, feeds, fit);
    append(questions, ask_about_axis_friction(axis, mean_friction_A(feeds, fit)));
    toml.table(std::string_view(&axis, 1));
    out << fmt::format("{}: I_f(w) = K_x1 w² + K_x2 w + K_x3, w in m/min, {} steady feeds in air\n", axis,
                       feeds.size());
    for (std::size_t j = 0; j < feed_current_keys.size(); ++j) {
        const int index = static_cast<int>(j);
        if (!fit.is_held(index)) {
            const FittedValue fitted{feed_current_keys[j], fit.solution.parameters(index),
                                     fit.solution.standard_error(index)};
            print_fitted(out, fitted);
            write_fitted(toml, fitted);
        }
    }
    for (const FittedValue& left_out : fit.left_out) {
        print_left_out(out, left_out);
    }
    write_range(feeds, fit, toml, out);
    toml.key(friction_current_residual_key.name, fit.solution.residual_rms);
    out << fmt::format("  residual {:.4g} A rms\n", fit.solution.residual_rms);
    return check_drift(out, drift_of(feeds, fit));
}

/// Steady feeds of all files, each file after the one before. A file given twice would make the standard errors too
/// small: what was there already is left out.
RecordedFeeds steady_feeds_of_all(const FrictionCalibrationOptions& options, char axis, std::ostream& out) {
    RecordedFeeds all;
    std::vector<SteadyFeed>& feeds = all.feeds;
    double offset_s = 0.0;
    for (const auto& file : options.data) {
        auto [is_recorded, found, questions] = read_steady_feeds(file, axis, options.minimum_speed_mm_s);
        all.is_recorded = all.is_recorded || is_recorded;
        append(all.questions, questions);
        const auto before = feeds;
        const auto copies = std::erase_if(found, [&](const SteadyFeed& feed) {
            return std::any_of(before.begin(), before.end(), [&](const SteadyFeed& b) {
                return b.feed_m_per_min == feed.feed_m_per_min && b.current_A == feed.current_A &&
                       b.duration_s == feed.duration_s;
            });
        });
        if (copies > 0) {
            out << fmt::format("{}: {}: {} steady feeds repeat earlier ones exactly and are not counted again\n",
                               file.filename().string(), axis, copies);
        }
        double last_s = 0.0;
        for (SteadyFeed& feed : found) {
            last_s = std::max(last_s, feed.middle_s + 0.5 * feed.duration_s);
            feed.middle_s += offset_s;
        }
        offset_s += last_s;
        feeds.insert(feeds.end(), found.begin(), found.end());
    }
    return all;
}

void print_standing_axis(std::ostream& out, char axis, bool is_recorded, double minimum_speed_mm_s) {
    if (is_recorded) {
        out << fmt::format(
            "{}: left out: no steady feed faster than {:g} mm/s; if it moved, is {}_velocity_mm_s in m/s?\n", axis,
            minimum_speed_mm_s, axis);
    }
}

int calibrate_recording(const FrictionCalibrationOptions& options, std::ostream& out) {
    std::ostringstream fitted_text;
    TomlWriter fitted_toml(fitted_text);
    std::string first_refusal;
    UnitQuestions questions;
    bool any = false;
    bool holds = true;
    for (const char axis : {'x', 'y', 'z'}) {
        const auto [is_recorded, feeds, of_motion] = steady_feeds_of_all(options, axis, out);
        if (feeds.empty()) {
            print_standing_axis(out, axis, is_recorded, options.minimum_speed_mm_s);
            continue;
        }
        const std::string lack = what_the_axis_lacks(axis, feeds);
        if (lack.empty()) {
            holds = fit_axis(options.data.front().string(), axis, feeds, fitted_toml, out, questions) && holds;
            append(questions, of_motion);
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
                                          "feeds in each direction; is a velocity in m/s, or time_s in min?")
                            : first_refusal));
    }
    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Friction current of feed drives in air: I_f(w) = K_x1 w^2 + K_x2 w + K_x3, w in m/min, I in A.");
    toml.comment("Fitted from " + list_of_files(options.data));
    file.stream() << fitted_text.str();
    file.commit();
    return ask(out, questions, holds ? exit_done : exit_bound_broken);
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
    return motion ? calibrate_motion_friction(options, out) : calibrate_recording(options, out);
}

}  // namespace millforce::host
