// SPDX-License-Identifier: Apache-2.0
#include "calibration/spindle_rows.hpp"

#include "calibration/duplicate_rows.hpp"
#include "calibration/plausible_units.hpp"
#include "calibration/signal.hpp"
#include "estimation/number/circle.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace millforce::host {

namespace {

using Sample = estimation::SpindleSample;

/// Columns as in the file; NaN for an empty cell.
struct SpindleRows {
    std::vector<double> time_s;
    std::vector<double> angle_rad;
    std::vector<Sample> samples;
    std::vector<std::string> places;  ///< "spindle.csv:3"
    bool by_angle = false;
};

SpindleRows read_rows(const std::filesystem::path& path, DuplicateRows& duplicates) {
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
    AngleUnit angle_unit;
    while (csv.next_row()) {
        progress.update(csv.fraction_read());
        if (!rows.by_angle && duplicates.is_copy(csv)) {
            continue;
        }
        Sample sample;
        sample.current_A = csv.number(current);
        sample.torque_Nm = csv.number(torque);
        sample.speed_rad_s = rows.by_angle ? 0.0 : csv.required_number(*speed, 0.0, 1e6);
        sample.acceleration_rad_s2 = acceleration ? csv.number(acceleration) : 0.0;
        if (rows.by_angle) {
            rows.time_s.push_back(csv.required_number(*time, -1e9, 1e9));
            rows.angle_rad.push_back(csv.required_number(*angle));
            angle_unit.look_at(csv, *angle, rows.angle_rad.back());
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
        rows.places.push_back(row_place(csv));
    }
    angle_unit.look_at_end(csv);
    return rows;
}

/// An angle that starts again at 0 after a revolution, as one that does not.
void unwrap(std::vector<double>& angle_rad) {
    constexpr double turn_rad = estimation::turn_rad<double>;
    for (std::size_t k = 1; k < angle_rad.size(); ++k) {
        angle_rad[k] -= turn_rad * std::round((angle_rad[k] - angle_rad[k - 1]) / turn_rad);
    }
}

/// Speed and acceleration from the angle; everything through the same low-pass. Where the torque is not known, the
/// filter sees the last known one, and the rows within its reach are left out. Returns the places of spikes of the
/// current, which the low-pass would have smeared: they were replaced first.
std::vector<std::string> differentiate(SpindleRows& rows, const std::filesystem::path& path, double low_pass_hz) {
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
    std::vector<std::string> spikes;
    for (const std::size_t k : replace_spikes(current)) {
        spikes.push_back(rows.places[k]);
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
    return spikes;
}

void refuse_implausible_units(const std::string& place, const Sample& sample) {
    constexpr double largest_current_A = 1000.0;
    constexpr double largest_power_W = 300e3;
    if (std::abs(sample.current_A) > largest_current_A) {
        throw InputError(fmt::format("{}: column 'spindle_current_A': {:.5g} A; expected at most {:g} A; is it in mA?",
                                     place, sample.current_A, largest_current_A));
    }
    if (std::abs(sample.torque_Nm) * sample.speed_rad_s > largest_power_W) {
        throw InputError(fmt::format(
            "{}: column 'spindle_torque_Nm': {:.5g} N·m at {:.5g} rad/s is {:.4g} kW; expected at most {:g} kW; is "
            "spindle_speed_rad_s in 1/min, or spindle_torque_Nm in N·cm or N·mm?",
            place, sample.torque_Nm, sample.speed_rad_s, std::abs(sample.torque_Nm) * sample.speed_rad_s / 1000.0,
            largest_power_W / 1000.0));
    }
}

bool is_complete(const Sample& s) {
    return std::isfinite(s.current_A) && std::isfinite(s.speed_rad_s) && std::isfinite(s.acceleration_rad_s2) &&
           std::isfinite(s.torque_Nm);
}

}  // namespace

KnownSpindleTorques read_known_spindle_torques(const std::vector<std::filesystem::path>& data, double low_pass_hz,
                                               std::ostream& out) {
    KnownSpindleTorques known;
    DuplicateRows duplicates;
    std::vector<std::string> spikes;
    for (const auto& path : data) {
        SpindleRows rows = read_rows(path, duplicates);
        known.by_angle = known.by_angle || rows.by_angle;
        if (rows.by_angle) {
            const auto found = differentiate(rows, path, low_pass_hz);
            spikes.insert(spikes.end(), found.begin(), found.end());
        }
        for (std::size_t k = 0; k < rows.samples.size(); ++k) {
            if (is_complete(rows.samples[k])) {
                refuse_implausible_units(rows.places[k], rows.samples[k]);
                known.samples.push_back(rows.samples[k]);
                known.places.push_back(rows.places[k]);
            }
        }
    }
    duplicates.report(out);
    if (!spikes.empty()) {
        out << fmt::format("{} spikes of the current were replaced: {}\n", spikes.size(), list_of_places(spikes));
    }
    if (known.samples.size() < 4) {
        throw InputError(
            fmt::format("{}: 'K_t1_Nm_per_A' cannot be determined: {} rows with a known torque; expected at "
                        "least 4",
                        data.front().string(), known.samples.size()));
    }
    return known;
}

}  // namespace millforce::host
