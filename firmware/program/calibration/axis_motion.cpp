// SPDX-License-Identifier: Apache-2.0
#include "calibration/axis_motion.hpp"

#include "calibration/plausible_drives.hpp"
#include "calibration/signal.hpp"
#include "calibration/steady_feed_finder.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace millforce::host {

namespace {

void check_even_spacing(const CsvReader& csv, const std::vector<double>& time_s,
                        const std::vector<std::size_t>& lines) {
    const double mean = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
    for (std::size_t k = 1; k < time_s.size(); ++k) {
        const double step = time_s[k] - time_s[k - 1];
        if (!(std::abs(step - mean) <= 0.01 * mean + 1e-9)) {
            throw InputError(
                fmt::format("{}:{}: column 'time_s': a step of {:.6g} s from the line before; expected even "
                            "steps of {:.6g} s",
                            csv.file_name(), lines[k], step, mean));
        }
    }
}

void refuse_implausible_speed(const CsvReader& csv, const std::vector<double>& velocity_m_s) {
    constexpr double fastest_m_s = 5.0;
    const double largest = std::abs(*std::max_element(velocity_m_s.begin(), velocity_m_s.end(),
                                                      [](double a, double b) { return std::abs(a) < std::abs(b); }));
    if (largest > fastest_m_s) {
        throw InputError(
            fmt::format("{}: column 'position_m': the axis moves at up to {:.4g} m/s; expected at most {:g} "
                        "m/s; is it in mm, or time_s in min?",
                        csv.file_name(), largest, fastest_m_s));
    }
}

double longest_travel_m(const std::vector<SteadyFeed>& feeds) {
    constexpr double s_per_min = 60.0;
    double longest = 0.0;
    for (const SteadyFeed& feed : feeds) {
        longest = std::max(longest, std::abs(feed.feed_m_per_min) / s_per_min * feed.duration_s);
    }
    return longest;
}

}  // namespace

bool is_axis_motion(const std::filesystem::path& file) {
    const CsvReader csv(file);
    return csv.find("position_m").has_value();
}

AxisMotion read_axis_motion(const std::filesystem::path& file, double low_pass_hz) {
    CsvReader csv(file);
    const CsvColumn time = csv.require("time_s");
    const CsvColumn position = csv.require("position_m");
    const CsvColumn force = csv.require("motor_force_N");
    std::vector<double> time_s;
    std::vector<double> position_m;
    std::vector<double> force_N;
    std::vector<std::size_t> lines;
    Progress progress("reading " + csv.file_name());
    while (csv.next_row()) {
        time_s.push_back(csv.required_number(time, -1e9, 1e9));
        position_m.push_back(csv.required_number(position, -1e4, 1e4));
        force_N.push_back(csv.required_number(force, -1e9, 1e9));
        lines.push_back(csv.line_number());
        progress.update(csv.fraction_read());
    }
    constexpr std::size_t fewest = 20;
    if (time_s.size() < fewest) {
        throw InputError(fmt::format("{}:{}: {} rows; expected at least {}", csv.file_name(), csv.line_number(),
                                     time_s.size(), fewest));
    }
    check_even_spacing(csv, time_s, lines);
    AxisMotion motion;
    motion.dt_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
    refuse_implausible_interval(csv.file_name(), motion.dt_s);
    const double rate_hz = 1.0 / motion.dt_s;
    motion.velocity_m_s = derivative(zero_phase_low_pass(position_m, low_pass_hz, rate_hz), motion.dt_s);
    refuse_implausible_speed(csv, motion.velocity_m_s);
    motion.acceleration_m_s2 = derivative(motion.velocity_m_s, motion.dt_s);
    motion.motor_force_N = zero_phase_low_pass(force_N, low_pass_hz, rate_hz);
    return motion;
}

RecordedFeeds read_steady_feeds(const std::filesystem::path& file, char axis, double minimum_speed_mm_s) {
    CsvReader csv(file);
    const CsvColumn time = csv.require("time_s");
    const auto velocity = csv.find(fmt::format("{}_velocity_mm_s", axis));
    const auto current = csv.find(fmt::format("{}_current_A", axis));
    if (!velocity || !current) {
        return {};
    }
    SteadyFeedFinder finder(minimum_speed_mm_s);
    AxisMotionUnits units;
    Progress progress("reading " + csv.file_name());
    double last_s = -std::numeric_limits<double>::infinity();
    while (csv.next_row()) {
        const double time_s = csv.required_number(time, -1e12, 1e12);
        if (time_s < last_s) {
            csv.fail(time, fmt::format("{} s after {} s; expected time to grow", time_s, last_s));
        }
        last_s = time_s;
        constexpr double fastest_mm_s = 3000.0;
        const double v = csv.number(velocity);
        if (std::abs(v) > fastest_mm_s) {
            csv.fail(*velocity,
                     fmt::format("{:.6g} mm/s; expected at most {:g} mm/s; is it in mm/min?", v, fastest_mm_s));
        }
        const double i = csv.number(current);
        if (std::isnan(v) || std::isnan(i)) {
            finder.close();
            units.interrupt();
        } else {
            finder.add(time_s, v, i);
            units.look_at(time_s, v);
        }
        progress.update(csv.fraction_read());
    }
    RecordedFeeds recorded{true, finder.finish(), {}};
    units.refuse_implausible(csv.file_name(), axis, longest_travel_m(recorded.feeds));
    if (!recorded.feeds.empty()) {
        recorded.questions = units.questions(axis);
    }
    return recorded;
}

}  // namespace millforce::host
