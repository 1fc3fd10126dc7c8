// SPDX-License-Identifier: Apache-2.0
#include "calibration/recorded_cuts.hpp"

#include "calibration/duplicate_rows.hpp"
#include "calibration/plausible_units.hpp"
#include "estimation/number/circle.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace millforce::host {

namespace {

constexpr std::array<char, 3> axis_letters{'x', 'y', 'z'};

/// The recording that a row of the table names, or the only one.
std::string named_recording(const CsvReader& csv, std::optional<CsvColumn> column,
                            const std::vector<std::filesystem::path>& recordings) {
    std::string name = column ? std::string(csv.text(*column)) : std::string();
    if (name.empty()) {
        if (recordings.size() > 1) {
            throw InputError(
                fmt::format("{}:{}: column 'recording': empty; expected the name of one of the {} recordings",
                            csv.file_name(), csv.line_number(), recordings.size()));
        }
        return recordings.front().filename().string();
    }
    const bool given = std::any_of(recordings.begin(), recordings.end(),
                                   [&](const auto& path) { return path.filename() == name || path.string() == name; });
    if (!given) {
        throw InputError(fmt::format("{}:{}: column 'recording': '{}' is none of the recordings given; expected {}",
                                     csv.file_name(), csv.line_number(), name, recordings.front().string()));
    }
    return name;
}

/// The columns of a recording.
struct RecordingColumns {
    explicit RecordingColumns(const CsvReader& csv)
        : time(csv.require("time_s")),
          angle(csv.require("spindle_angle_rad", "the spindle's speed comes from it")),
          spindle_current(csv.require("spindle_current_A")) {
        bool any = false;
        for (std::size_t k = 0; k < axis_letters.size(); ++k) {
            current[k] = csv.find(fmt::format("{}_current_A", axis_letters[k]));
            velocity[k] = csv.find(fmt::format("{}_velocity_mm_s", axis_letters[k]));
            any = any || (current[k] && velocity[k]);
        }
        if (!any) {
            csv.require("x_current_A", "or current and velocity of another axis: the feed force comes from it");
        }
    }

    [[nodiscard]] DriveReading read(const CsvReader& csv) const {
        DriveReading reading;
        reading.time_s = csv.required_number(time, -1e9, 1e9);
        reading.spindle_angle_rad = csv.number(angle);
        reading.spindle_current_A = csv.number(spindle_current);
        for (std::size_t k = 0; k < axis_letters.size(); ++k) {
            const bool present = current[k] && velocity[k];
            reading.axis_current_A[k] = present ? csv.number(*current[k]) : no_estimate;
            reading.axis_velocity_mm_s[k] = present ? csv.number(*velocity[k]) : no_estimate;
        }
        return reading;
    }

    CsvColumn time, angle, spindle_current;
    std::array<std::optional<CsvColumn>, 3> current, velocity;
};

/// Averages the stretches of one recording; they may overlap, and be in any order.
void average_recording(const std::filesystem::path& path, const std::vector<StretchConditions>& table,
                       std::vector<StretchAverage>& averages) {
    CsvReader csv(path);
    const RecordingColumns columns(csv);
    Progress progress("reading " + csv.file_name());
    AngleUnit angle_unit;
    double last_s = -std::numeric_limits<double>::infinity();
    while (csv.next_row()) {
        progress.update(csv.fraction_read());
        const DriveReading reading = columns.read(csv);
        angle_unit.look_at(csv, columns.angle, reading.spindle_angle_rad);
        if (!(reading.time_s > last_s)) {
            csv.fail(columns.time, fmt::format("{} s after {} s; expected time to grow", reading.time_s, last_s));
        }
        last_s = reading.time_s;
        if (!std::isfinite(reading.spindle_angle_rad) || !std::isfinite(reading.spindle_current_A)) {
            continue;
        }
        for (std::size_t k = 0; k < table.size(); ++k) {
            const bool here = table[k].recording == path.filename() || table[k].recording == path.string();
            if (here && reading.time_s >= table[k].start_s && reading.time_s <= table[k].end_s) {
                averages[k].add(reading);
            }
        }
    }
    angle_unit.look_at_end(csv);
}

}  // namespace

double RecordedStretch::feed_per_tooth_mm() const {
    return std::abs(feed_mm_s) * estimation::turn_rad<double> / (conditions.flutes * spindle_rad_s);
}

void StretchAverage::add(const DriveReading& reading) {
    if (samples_ == 0) {
        first_ = reading;
    } else {
        const double step = reading.spindle_angle_rad - last_.spindle_angle_rad;
        turned_rad_ += step < 0.0 ? step + estimation::turn_rad<double> : step;
    }
    last_ = reading;
    ++samples_;
    spindle_current_ += reading.spindle_current_A;
    for (std::size_t k = 0; k < current_.size(); ++k) {
        current_[k] += reading.axis_current_A[k];
        velocity_[k] += reading.axis_velocity_mm_s[k];
    }
    velocities_.push_back(reading.axis_velocity_mm_s);
}

std::size_t StretchAverage::feeding_axis(const StretchConditions& conditions) const {
    const auto speed = [&](std::size_t k) { return std::isfinite(velocity_[k]) ? std::abs(velocity_[k]) : 0.0; };
    std::size_t fastest = 0;
    for (std::size_t k = 1; k < velocity_.size(); ++k) {
        fastest = speed(k) > speed(fastest) ? k : fastest;
    }
    const double count = static_cast<double>(samples_);
    if (!(speed(fastest) > 0.01 * count)) {
        throw InputError(fmt::format("{}: no axis moves from {} to {} s; expected a steady feed", conditions.place,
                                     conditions.start_s, conditions.end_s));
    }
    for (std::size_t k = 0; k < velocity_.size(); ++k) {
        if (k != fastest && speed(k) > 0.02 * speed(fastest)) {
            throw InputError(fmt::format("{}: {} and {} both move from {} to {} s; expected a feed along one axis",
                                         conditions.place, axis_letters[fastest], axis_letters[k], conditions.start_s,
                                         conditions.end_s));
        }
    }
    return fastest;
}

RecordedStretch StretchAverage::stretch(const StretchConditions& conditions) const {
    constexpr std::size_t fewest = 20;
    if (samples_ < fewest) {
        throw InputError(fmt::format("{}: {} samples from {} to {} s of the recording; expected at least {}",
                                     conditions.place, samples_, conditions.start_s, conditions.end_s, fewest));
    }
    const double count = static_cast<double>(samples_);
    RecordedStretch result;
    result.conditions = conditions;
    result.axis = feeding_axis(conditions);
    result.duration_s = last_.time_s - first_.time_s;
    result.middle_s = 0.5 * (last_.time_s + first_.time_s);
    result.spindle_current_A = spindle_current_ / count;
    result.spindle_rad_s = turned_rad_ / result.duration_s;
    result.axis_current_A = current_[result.axis] / count;
    result.feed_mm_s = velocity_[result.axis] / count;
    if (!(result.spindle_rad_s > 1.0)) {
        throw InputError(fmt::format("{}: the spindle turns at {:.3g} rad/s from {} to {} s; expected it to run",
                                     conditions.place, result.spindle_rad_s, conditions.start_s, conditions.end_s));
    }
    const auto mean_of = [&](std::size_t from, std::size_t to) {
        double sum = 0.0;
        for (std::size_t k = from; k < to; ++k) {
            sum += velocities_[k][result.axis];
        }
        return sum / static_cast<double>(to - from);
    };
    const std::size_t tenth = samples_ / 10;
    for (const double end : {mean_of(0, tenth), mean_of(samples_ - tenth, samples_)}) {
        if (std::abs(end - result.feed_mm_s) > 0.1 * std::abs(result.feed_mm_s)) {
            throw InputError(
                fmt::format("{}: {} feeds at {:.3g} mm/s at one end of {} to {} s and at {:.3g} mm/s on "
                            "average; expected a steady feed",
                            conditions.place, axis_letters[result.axis], end, conditions.start_s, conditions.end_s,
                            result.feed_mm_s));
        }
    }
    return result;
}

std::vector<StretchConditions> read_cut_table(const std::filesystem::path& table,
                                              const std::vector<std::filesystem::path>& recordings) {
    CsvReader csv(table);
    const auto recording = csv.find("recording");
    const CsvColumn start = csv.require("start_s");
    const CsvColumn end = csv.require("end_s");
    const CsvColumn diameter = csv.require("tool_diameter_mm");
    const CsvColumn flutes = csv.require("flutes");
    const CsvColumn depth = csv.require("axial_depth_mm");
    const CsvColumn width = csv.require("radial_width_mm");
    std::vector<StretchConditions> rows;
    DuplicateRows duplicates;
    while (csv.next_row()) {
        if (duplicates.is_copy(csv)) {
            csv.fail(start, "the row repeats an earlier one; expected each stretch once");
        }
        StretchConditions row;
        row.recording = named_recording(csv, recording, recordings);
        row.place = fmt::format("{}:{}", csv.file_name(), csv.line_number());
        row.start_s = csv.required_number(start, -1e9, 1e9);
        row.end_s = csv.required_number(end, row.start_s, 1e9);
        row.tool_diameter_mm = csv.required_number(diameter, 0.01, 1000.0);
        const double teeth = csv.required_number(flutes, 1.0, 100.0);
        if (teeth != std::floor(teeth)) {
            csv.fail(flutes, fmt::format("{} is not whole; expected a number of flutes", teeth));
        }
        row.flutes = static_cast<int>(teeth);
        const auto or_air = [&](CsvColumn column, double most) {
            return std::isnan(csv.number(column)) ? 0.0 : csv.required_number(column, 0.0, most);
        };
        row.axial_depth_mm = or_air(depth, 1000.0);
        row.radial_width_mm = or_air(width, row.tool_diameter_mm);
        rows.push_back(row);
    }
    if (rows.empty()) {
        throw InputError(fmt::format("{}: no row; expected one for each cut and each stretch in air", csv.file_name()));
    }
    return rows;
}

std::vector<RecordedStretch> read_recorded_cuts(const std::vector<std::filesystem::path>& recordings,
                                                const std::filesystem::path& table) {
    const std::vector<StretchConditions> rows = read_cut_table(table, recordings);
    std::vector<StretchAverage> averages(rows.size());
    for (const auto& recording : recordings) {
        average_recording(recording, rows, averages);
    }
    std::vector<RecordedStretch> stretches;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        stretches.push_back(averages[k].stretch(rows[k]));
        const RecordedStretch& s = stretches.back();
        refuse_implausible_cut(
            rows[k].place, {rows[k].tool_diameter_mm, std::abs(s.feed_mm_s), s.feed_per_tooth_mm(), s.spindle_rad_s},
            fmt::format("{}_velocity_mm_s", axis_letters[s.axis]), "spindle_angle_rad");
    }
    return stretches;
}

}  // namespace millforce::host
