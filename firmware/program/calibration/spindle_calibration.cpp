// SPDX-License-Identifier: Apache-2.0
#include "calibration/spindle_calibration.hpp"

#include "calibration/calibration_report.hpp"
#include "calibration/signal.hpp"
#include "estimation_calibration/spindle_fit.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace millforce::host {

namespace {

using Sample = estimation::SpindleSample;

/// Columns as in the file; NaN for an empty cell.
struct SpindleRows {
    std::vector<double> time_s;
    std::vector<double> angle_rad;
    std::vector<Sample> samples;
    bool by_angle = false;
};

SpindleRows read_rows(const std::filesystem::path& path) {
    CsvReader csv(path);
    const CsvColumn current = csv.require("spindle_current_A");
    const CsvColumn torque = csv.require("spindle_torque_Nm", "the known torque of each row");
    const auto speed = csv.find("spindle_speed_rad_s");
    const auto angle = csv.find("spindle_angle_rad");
    const auto acceleration = csv.find("spindle_acceleration_rad_s2");
    SpindleRows rows;
    rows.by_angle = !speed;
    if (rows.by_angle && !angle) {
        csv.require("spindle_speed_rad_s", "nor 'spindle_angle_rad'");
    }
    const auto time =
        rows.by_angle ? std::optional(csv.require("time_s", "needed with spindle_angle_rad")) : std::nullopt;
    Progress progress("reading " + csv.file_name());
    while (csv.next_row()) {
        progress.update(csv.fraction_read());
        Sample sample;
        sample.current_A = csv.number(current);
        sample.torque_Nm = csv.number(torque);
        sample.speed_rad_s = rows.by_angle ? 0.0 : csv.required_number(*speed, 0.0, 1e6);
        sample.acceleration_rad_s2 = acceleration ? csv.number(acceleration) : 0.0;
        if (rows.by_angle) {
            rows.time_s.push_back(csv.required_number(*time, -1e9, 1e9));
            rows.angle_rad.push_back(csv.required_number(*angle));
            const std::size_t n = rows.time_s.size();
            if (n > 1 && !(rows.time_s[n - 1] > rows.time_s[n - 2])) {
                csv.fail(*time,
                         fmt::format("{} s after {} s; expected time to grow", rows.time_s[n - 1], rows.time_s[n - 2]));
            }
            if (std::isnan(sample.current_A)) {
                csv.required_number(current);
            }
        }
        rows.samples.push_back(sample);
    }
    return rows;
}

/// An angle that starts again at 0 after a revolution, as one that does not.
void unwrap(std::vector<double>& angle_rad) {
    constexpr double turn = 2.0 * std::numbers::pi;
    for (std::size_t k = 1; k < angle_rad.size(); ++k) {
        angle_rad[k] -= turn * std::round((angle_rad[k] - angle_rad[k - 1]) / turn);
    }
}

/// Speed and acceleration from the angle; everything through the same low-pass. Where the torque is not known, the
/// filter sees the last known one, and the rows within its reach are left out.
void differentiate(SpindleRows& rows, const std::filesystem::path& path, double low_pass_hz) {
    const std::size_t n = rows.samples.size();
    constexpr std::size_t fewest = 20;
    if (n < fewest) {
        throw InputError(
            fmt::format("{}: {} rows with 'spindle_angle_rad'; expected at least {}", path.string(), n, fewest));
    }
    const double dt_s = (rows.time_s.back() - rows.time_s.front()) / static_cast<double>(n - 1);
    for (std::size_t k = 1; k < n; ++k) {
        if (std::abs(rows.time_s[k] - rows.time_s[k - 1] - dt_s) > 0.05 * dt_s) {
            throw InputError(fmt::format("{}: row {}: column 'time_s': uneven step of {:.6g} s; expected {:.6g} s",
                                         path.string(), k + 1, rows.time_s[k] - rows.time_s[k - 1], dt_s));
        }
    }
    unwrap(rows.angle_rad);
    std::vector<double> current(n);
    std::vector<double> torque(n);
    double last_torque = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        current[k] = rows.samples[k].current_A;
        last_torque = std::isnan(rows.samples[k].torque_Nm) ? last_torque : rows.samples[k].torque_Nm;
        torque[k] = last_torque;
    }
    const double rate_hz = 1.0 / dt_s;
    const auto speed = derivative(zero_phase_low_pass(rows.angle_rad, low_pass_hz, rate_hz), dt_s);
    const auto acceleration = derivative(speed, dt_s);
    current = zero_phase_low_pass(current, low_pass_hz, rate_hz);
    torque = zero_phase_low_pass(torque, low_pass_hz, rate_hz);
    const auto reach = std::min(n, static_cast<std::size_t>(rate_hz / low_pass_hz));
    std::vector<bool> known(n, true);
    for (std::size_t k = 0; k < n; ++k) {
        if (std::isnan(rows.samples[k].torque_Nm)) {
            const std::size_t first = k > reach ? k - reach : 0;
            std::fill(known.begin() + static_cast<std::ptrdiff_t>(first),
                      known.begin() + static_cast<std::ptrdiff_t>(std::min(n, k + reach + 1)), false);
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        rows.samples[k] = {current[k], std::abs(speed[k]), speed[k] < 0.0 ? -acceleration[k] : acceleration[k],
                           known[k] ? torque[k] : no_estimate};
    }
}

bool is_complete(const Sample& s) {
    return std::isfinite(s.current_A) && std::isfinite(s.speed_rad_s) && std::isfinite(s.acceleration_rad_s2) &&
           std::isfinite(s.torque_Nm);
}

estimation::SpindleFitTerms terms_for(const std::vector<Sample>& samples) {
    double slowest = samples.front().speed_rad_s;
    double fastest = slowest;
    double acceleration = 0.0;
    for (const Sample& s : samples) {
        slowest = std::min(slowest, s.speed_rad_s);
        fastest = std::max(fastest, s.speed_rad_s);
        acceleration = std::max(acceleration, std::abs(s.acceleration_rad_s2));
    }
    return {fastest > 1.1 * slowest, acceleration > 1.0, fastest > 1.2 * slowest};
}

double correlation(const std::vector<Sample>& samples, const estimation::SpindleFit& fit) {
    const auto& p = fit.solution.parameters;
    std::vector<double> residuals;
    for (const Sample& s : samples) {
        const double gain = estimation::field_weakening_gain(p(estimation::spindle_base_speed), s.speed_rad_s);
        residuals.push_back(s.torque_Nm - p(estimation::spindle_K_t1) * gain * s.current_A -
                            p(estimation::spindle_K_t2) + p(estimation::spindle_idle_slope) * s.speed_rad_s +
                            p(estimation::spindle_inertia) * s.acceleration_rad_s2);
    }
    return correlated_samples(residuals);
}

void refuse_what_is_missing(const SpindleCalibrationOptions& options, const std::vector<Sample>& samples,
                            const estimation::SpindleFit& fit, double correlated) {
    const auto refuse = [&](int j, std::string_view why) {
        throw InputError(fmt::format("{}: '{}' cannot be determined: {}", options.data.front().string(),
                                     spindle_keys[static_cast<std::size_t>(j)].name, why));
    };
    const auto [low, high] = std::minmax_element(
        samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.torque_Nm < b.torque_Nm; });
    const auto& s = fit.solution;
    const double gain = s.parameters(estimation::spindle_K_t1);
    const double error = s.standard_error(estimation::spindle_K_t1) * std::sqrt(correlated);
    if (!s.determined(estimation::spindle_K_t1) || !(error < gain / 3.0)) {
        refuse(
            estimation::spindle_K_t1,
            fmt::format("over torques from {:.4g} to {:.4g} N·m the current does not rise with the torque beyond the "
                        "noise; expected idle running and cuts of clearly different known torque",
                        low->torque_Nm, high->torque_Nm));
    }
    if (!s.determined(estimation::spindle_K_t2) || !s.determined(estimation::spindle_idle_slope)) {
        refuse(estimation::spindle_idle_slope,
               "idle torque and load change together with speed; expected idle running "
               "and a cut at each of two speeds");
    }
    if (!s.determined(estimation::spindle_inertia)) {
        refuse(estimation::spindle_inertia,
               "acceleration goes together with speed or current; expected a run-up in air");
    }
}

}  // namespace

int calibrate_spindle(const SpindleCalibrationOptions& options, std::ostream& out) {
    if (options.data.empty()) {
        throw InputError("calibrate spindle: no data file; expected at least one CSV file");
    }
    std::vector<Sample> samples;
    for (const auto& path : options.data) {
        SpindleRows rows = read_rows(path);
        if (rows.by_angle) {
            differentiate(rows, path, options.low_pass_hz);
        }
        std::copy_if(rows.samples.begin(), rows.samples.end(), std::back_inserter(samples), is_complete);
    }
    if (samples.size() < 4) {
        throw InputError(
            fmt::format("{}: 'K_t1_Nm_per_A' cannot be determined: {} rows with a known torque; expected at "
                        "least 4",
                        options.data.front().string(), samples.size()));
    }
    const estimation::SpindleFitTerms terms = terms_for(samples);
    const auto fit = estimation::fit_spindle(samples, terms);
    const double correlated = correlation(samples, fit);
    refuse_what_is_missing(options, samples, fit, correlated);

    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Spindle drive: T = K_t1 g(w) I + K_t2 - k w - J dw/dt; g = 1 up to the base speed, base/w above.");
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.table("spindle");
    out << fmt::format("T = K_t1 g(ω) I + K_t2 − k ω − J dω/dt, {} rows\n", samples.size());
    const bool weakened = fit.solution.parameters(estimation::spindle_base_speed) > 0.0;
    const std::array<bool, estimation::spindle_parameter_count> asked{true, true, terms.idle_slope, terms.inertia,
                                                                      weakened};
    for (std::size_t j = 0; j < asked.size(); ++j) {
        const int index = static_cast<int>(j);
        const bool at_edge = index == estimation::spindle_base_speed && fit.nothing_below_base_speed;
        const double error =
            asked[j] && !at_edge ? fit.solution.standard_error(index) * std::sqrt(correlated) : no_estimate;
        const FittedValue fitted{spindle_keys[j], fit.solution.parameters(index), error};
        write_fitted(toml, fitted);
        if (asked[j]) {
            print_fitted(out, fitted);
        }
    }
    toml.key(torque_residual_key.name, fit.solution.residual_rms);
    file.commit();
    out << fmt::format("  residual {:.4g} N·m rms\n", fit.solution.residual_rms);
    if (!terms.idle_slope) {
        out << "  one speed only: idle_torque_slope_Nm_s is taken as 0, and field weakening cannot be seen\n";
    } else if (terms.field_weakening && !weakened) {
        out << "  no field weakening seen between the slowest and the fastest cut\n";
    }
    if (fit.nothing_below_base_speed) {
        out << "  every speed is in field weakening: K_t1_Nm_per_A holds at base_speed_rad_s and falls above it; below "
               "it "
               "nothing is known\n";
    }
    return exit_done;
}

}  // namespace millforce::host
