// SPDX-License-Identifier: Apache-2.0
#include "calibration/warm_up_calibration.hpp"

#include "calibration/calibration_report.hpp"
#include "calibration/drive_forces.hpp"
#include "calibration/plausible_drives.hpp"
#include "calibration/plausible_units.hpp"
#include "estimation/number/circle.hpp"
#include "estimation_calibration/warm_up_fit.hpp"
#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"
#include "parameters/parameter_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace millforce::host {

namespace {

const CalibrationKey torque_key = key_of("spindle", "warm_up_torque_Nm");
const CalibrationKey time_key = key_of("spindle", "warm_up_time_s");
const CalibrationKey torque_doubt_key = key_of("spindle", "warm_up_torque_sd_Nm");

/// About a second of the recording.
struct IdleSecond {
    double time_s = 0.0;
    double current_A = 0.0;
    double speed_rad_s = 0.0;
};

class IdleSeconds {
  public:
    void add(double time_s, double angle_rad, double current_A) {
        if (rows_ > 0) {
            const double step = angle_rad - last_angle_rad_;
            turned_rad_ += step < 0.0 ? step + estimation::turn_rad<double> : step;
        } else {
            start_s_ = time_s;
        }
        last_angle_rad_ = angle_rad;
        current_ += current_A;
        ++rows_;
        if (time_s - start_s_ >= 1.0) {
            const double length_s = time_s - start_s_;
            found_.push_back(
                {start_s_ + 0.5 * length_s, current_ / static_cast<double>(rows_), turned_rad_ / length_s});
            rows_ = 0;
            turned_rad_ = current_ = 0.0;
        }
    }
    [[nodiscard]] const std::vector<IdleSecond>& found() const { return found_; }

  private:
    std::vector<IdleSecond> found_;
    long rows_ = 0;
    double start_s_ = 0.0;
    double last_angle_rad_ = 0.0;
    double turned_rad_ = 0.0;
    double current_ = 0.0;
};

std::vector<IdleSecond> read_idle_seconds(const std::filesystem::path& path) {
    CsvReader csv(path);
    const CsvColumn time = csv.require("time_s");
    const CsvColumn angle = csv.require("spindle_angle_rad", "the spindle's speed comes from it");
    const CsvColumn current = csv.require("spindle_current_A");
    IdleSeconds seconds;
    AngleUnit angle_unit;
    Progress progress("reading " + csv.file_name());
    double last_s = -std::numeric_limits<double>::infinity();
    while (csv.next_row()) {
        progress.update(csv.fraction_read());
        const double time_s = csv.required_number(time, -1e9, 1e9);
        if (!(time_s > last_s)) {
            csv.fail(time, fmt::format("{} s after {} s; expected time to grow", time_s, last_s));
        }
        last_s = time_s;
        angle_unit.look_at(csv, angle, csv.number(angle));
        if (std::isfinite(csv.number(angle)) && std::isfinite(csv.number(current))) {
            seconds.add(time_s, csv.number(angle), csv.number(current));
        }
    }
    angle_unit.look_at_end(csv);
    return seconds.found();
}

/// The part of the record at the spindle's most frequent speed. Several speeds are refused: each has its own idle
/// torque.
std::vector<IdleSecond> at_one_speed(const std::filesystem::path& path, std::vector<IdleSecond> seconds) {
    if (seconds.empty()) {
        throw InputError(fmt::format(
            "{}: less than a second; expected ten minutes or more of idling from cold; is time_s in min or h?",
            path.string()));
    }
    std::vector<double> speeds;
    speeds.reserve(seconds.size());
    for (const IdleSecond& second : seconds) {
        speeds.push_back(second.speed_rad_s);
    }
    const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
    std::nth_element(speeds.begin(), middle, speeds.end());
    const double speed = *middle;
    if (speed > 0.0) {
        refuse_implausible_spindle_speed(path.string(), speed, SpeedSource::angle);
    }
    const std::size_t all = seconds.size();
    std::erase_if(seconds, [speed](const IdleSecond& s) { return std::abs(s.speed_rad_s - speed) > 0.02 * speed; });
    if (!(speed > 1.0) || seconds.size() < all - all / 10) {
        throw InputError(fmt::format("{}: the spindle holds {:.4g} rad/s for {} of {} s; expected one speed throughout",
                                     path.string(), speed, seconds.size(), all));
    }
    return seconds;
}

estimation::WarmUpFit warm_up_or_refuse(const std::filesystem::path& path,
                                        const std::vector<estimation::IdleTorque>& torques,
                                        const UnitQuestions& questions) {
    const auto fit = estimation::fit_warm_up(torques);
    switch (fit.lack) {
        case estimation::WarmUpLack::samples:
            throw InputError(fmt::format(
                "{}: '{}' cannot be determined: {} s of idling; expected ten minutes or more{}", path.string(),
                time_key.name, torques.size(), questions.empty() ? "" : "; " + questions.front()));
        case estimation::WarmUpLack::excess:
            throw InputError(
                fmt::format("{}: '{}' cannot be determined: the idle torque does not fall beyond its noise; "
                            "expected a record from cold",
                            path.string(), torque_key.name));
        case estimation::WarmUpLack::duration:
            throw InputError(fmt::format(
                "{}: '{}' cannot be determined: {:.0f} s show too little of the curve; expected a record of {:.0f} s "
                "or more",
                path.string(), time_key.name, fit.duration_s,
                std::max(600.0, std::max(2.0 * fit.duration_s, std::min(3.0 * fit.time_constant_s, 7200.0)))));
        case estimation::WarmUpLack::nothing:
            break;
    }
    return fit;
}

void refuse_other_current(const std::filesystem::path& path, const MachineParameters& machine,
                          const std::vector<IdleSecond>& seconds) {
    const auto count = static_cast<double>(seconds.size());
    IdlingSpindle idling;
    for (const IdleSecond& s : seconds) {
        idling.current_A += s.current_A / count;
        idling.torque_Nm += spindle_gain_Nm_per_A(machine, s.speed_rad_s) * s.current_A / count;
    }
    idling.rated_current_A = static_cast<double>(machine.spindle_rated_current_A);
    idling.torque_of_file_Nm = static_cast<double>(machine.spindle.K_t2_Nm);
    refuse_implausible_idling(path.string(), idling);
}

}  // namespace

int calibrate_warm_up(const WarmUpCalibrationOptions& options, std::ostream& out) {
    const MachineParameters machine = read_machine_parameters(options.machine.string());
    const auto seconds = at_one_speed(options.data, read_idle_seconds(options.data));
    std::vector<estimation::IdleTorque> torques;
    torques.reserve(seconds.size());
    for (const IdleSecond& s : seconds) {
        torques.push_back({s.time_s, spindle_gain_Nm_per_A(machine, s.speed_rad_s) * s.current_A});
    }
    refuse_other_current(options.data, machine, seconds);
    const UnitQuestions questions =
        ask_about_spindle_speeds({.speeds_rad_s = {seconds.back().speed_rad_s}, .of_one_angle = true});
    const auto fit = warm_up_or_refuse(options.data, torques, questions);

    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Warm-up of the idling spindle: T = T_warm + warm_up_torque exp(-t/warm_up_time).");
    toml.comment(fmt::format("Fitted from {}, {:.0f} s at {:.4g} rad/s", options.data.filename().string(),
                             fit.duration_s, seconds.back().speed_rad_s));
    toml.table("spindle");
    out << fmt::format("T_idle(t) = T_warm + T_cold e^(−t/τ), {:.0f} s at {:.4g} rad/s\n", fit.duration_s,
                       seconds.back().speed_rad_s);
    for (const FittedValue& fitted : {FittedValue{torque_key, fit.excess_Nm, fit.excess_se_Nm},
                                      FittedValue{time_key, fit.time_constant_s, fit.time_constant_se_s}}) {
        print_fitted(out, fitted);
        write_fitted(toml, fitted);
    }
    toml.key(torque_doubt_key.name, fit.excess_Nm / 3.0);
    file.commit();
    out << fmt::format("  warm idle torque {:.4g} ± {:.2g} N·m, residual {:.3g} N·m over a second\n", fit.warm_Nm,
                       fit.warm_se_Nm, fit.residual_Nm);
    return ask(out, questions, exit_done);
}

}  // namespace millforce::host
