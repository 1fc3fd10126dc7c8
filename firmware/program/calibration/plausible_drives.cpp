// SPDX-License-Identifier: Apache-2.0
#include "calibration/plausible_drives.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace millforce::host {

namespace {

constexpr double rpm = 30.0 / std::numbers::pi;  // in 1 rad/s
constexpr double largest_spindle_current_A = 1000.0;

std::string_view units_of_a_high_speed(SpeedSource source) {
    return source == SpeedSource::angle ? "is spindle_angle_rad in degrees, or time_s in min"
                                        : "is spindle_speed_rad_s in 1/min";
}

std::string_view units_of_a_low_speed(SpeedSource source) {
    return source == SpeedSource::angle ? "is spindle_angle_rad in revolutions, or time_s in ms"
                                        : "is spindle_speed_rad_s in 1/s";
}

/// Nobody chooses speeds like these in rad/s.
bool are_whole_fifties(const std::vector<double>& speeds) {
    constexpr double step = 50.0;
    return std::all_of(speeds.begin(), speeds.end(), [](double speed) { return std::fmod(speed, step) == 0.0; });
}

}  // namespace

double SpindleLoad::power_W() const {
    return std::abs(torque_Nm) * speed_rad_s;
}

double SpindleLoad::W_per_A() const {
    return power_W() / std::abs(current_A);
}

void refuse_implausible_power(const std::string& file, const SpindleLoad& load, SpeedSource source) {
    constexpr double most_W_per_A = 2400.0;
    constexpr double least_W_per_A = 1.0;
    const auto refuse = [&](std::string_view expected, std::string_view likely) {
        throw InputError(fmt::format(
            "{}: column 'spindle_torque_Nm': {:.5g} N·m at {:.5g} rad/s and {:.4g} A are {:.4g} W for each ampere; "
            "expected {}; {}?",
            file, load.torque_Nm, load.speed_rad_s, load.current_A, load.W_per_A(), expected, likely));
    };
    if (load.W_per_A() > most_W_per_A) {
        refuse(fmt::format("at most {:g} W, as from 690 V", most_W_per_A),
               fmt::format("is it in N·cm or N·mm, or {}", units_of_a_high_speed(source)));
    }
    if (load.W_per_A() < least_W_per_A) {
        refuse(fmt::format("at least {:g} W, or the motor takes less than a volt", least_W_per_A),
               fmt::format("is it in kN·m, spindle_current_A in mA, or {}", units_of_a_low_speed(source)));
    }
}

void refuse_implausible_spindle_speed(const std::string& file, double fastest_rad_s, SpeedSource source) {
    constexpr double slowest = 5.0;
    constexpr double fastest = 20e3;
    if (fastest_rad_s < slowest || fastest_rad_s > fastest) {
        throw InputError(
            fmt::format("{}: the spindle turns at {:.4g} rad/s, {:.4g} 1/min; expected {:g} to {:g} rad/s; "
                        "{}?",
                        file, fastest_rad_s, fastest_rad_s * rpm, slowest, fastest,
                        fastest_rad_s < slowest ? units_of_a_low_speed(source) : units_of_a_high_speed(source)));
    }
}

UnitQuestions ask_about_spindle_speeds(const SpindleSpeeds& spindle) {
    constexpr double fast_rad_s = 3000.0;
    constexpr double least_round_rad_s = 500.0;
    constexpr double slow_rad_s = 100.0;
    constexpr double usual_W_per_A = 100.0;
    constexpr double largest_W_per_A = 1200.0;
    constexpr double s_per_min = 60.0;
    const auto& speeds = spindle.speeds_rad_s;
    const double fastest = *std::max_element(speeds.begin(), speeds.end());
    if (fastest > fast_rad_s) {
        return {fmt::format(
            "the spindle turns at up to {:.5g} rad/s, {:.6g} 1/min; is its speed in 1/min, or its angle in degrees?",
            fastest, fastest * rpm)};
    }
    if (!spindle.of_one_angle && fastest >= least_round_rad_s && are_whole_fifties(speeds)) {
        return {
            fmt::format("each speed is a multiple of 50, up to {:.5g} rad/s, which is {:.6g} 1/min; is "
                        "spindle_speed_rad_s in 1/min?",
                        fastest, fastest * rpm)};
    }
    if (spindle.W_per_A > largest_W_per_A) {
        return {
            fmt::format("the drive gives {:.4g} W for each ampere, as from more than 690 V; usual is less than {:g} W; "
                        "is spindle_torque_Nm in N·cm, or the speed in 1/min?",
                        spindle.W_per_A, largest_W_per_A)};
    }
    if (spindle.base_speed_rad_s > 0.0 && spindle.base_speed_W_per_A < usual_W_per_A) {
        return {fmt::format(
            "the field is weakened above {:.4g} rad/s, {:.5g} 1/min, where the drive gives {:.3g} W for each ampere; "
            "usual there are {:g} W or more; is the speed in 1/s, or the angle in revolutions?",
            spindle.base_speed_rad_s, spindle.base_speed_rad_s * rpm, spindle.base_speed_W_per_A, usual_W_per_A)};
    }
    if (fastest < slow_rad_s && spindle.W_per_A < usual_W_per_A) {
        return {fmt::format(
            "the spindle turns at up to {:.4g} rad/s, {:.5g} 1/min, and gives at most {:.3g} W for each ampere; usual "
            "are {:g} W or more; is the speed in 1/s, or the angle in revolutions?",
            fastest, fastest * rpm, spindle.W_per_A, usual_W_per_A)};
    }
    if (is_round_only_by(speeds, s_per_min) && !is_round_only_by(speeds, rpm)) {
        return {fmt::format("only in 1/s is each speed a multiple of 50 1/min, {:.5g} 1/s being {:.6g} 1/min; is {}?",
                            fastest, fastest * s_per_min,
                            spindle.of_one_angle ? "spindle_angle_rad in revolutions" : "spindle_speed_rad_s in 1/s")};
    }
    return {};
}

void refuse_implausible_idling(const std::string& file, const IdlingSpindle& idling) {
    constexpr double largest_ratio = 20.0;
    const auto refuse = [&](std::string_view expected) {
        throw InputError(
            fmt::format("{}: column 'spindle_current_A': idling takes {:.4g} A, {:.4g} N·m; expected {}; is it in mA?",
                        file, idling.current_A, idling.torque_Nm, expected));
    };
    const double current_A = std::abs(idling.current_A);
    if (current_A > largest_spindle_current_A) {
        refuse(fmt::format("at most {:g} A", largest_spindle_current_A));
    }
    if (idling.rated_current_A > 0.0 && current_A > idling.rated_current_A) {
        refuse(fmt::format("less than the rated {:g} A of the machine's file", idling.rated_current_A));
    }
    const double of_file_Nm = std::abs(idling.torque_of_file_Nm);
    if (of_file_Nm > 0.0 && std::abs(idling.torque_Nm) > largest_ratio * of_file_Nm) {
        refuse(fmt::format("about the {:.4g} N·m of the machine's file", of_file_Nm));
    }
}

UnitQuestions ask_about_gain(std::string_view key, double fitted, double of_file) {
    constexpr double usual_factor = 3.0;
    if (!(of_file > 0.0) || (fitted > of_file / usual_factor && fitted < of_file * usual_factor)) {
        return {};
    }
    return {
        fmt::format("'{}' = {:.4g}, and the machine's file has {:.4g}; usual is a third to three times that; are "
                    "axial_depth_mm or radial_width_mm in cm, or a current in another unit?",
                    key, fitted, of_file)};
}

void AxisMotionUnits::look_at(double time_s, double velocity_mm_s) {
    constexpr double block_s = 0.01;
    first_s_ = std::isnan(first_s_) ? time_s : first_s_;
    last_s_ = time_s;
    ++samples_;
    if (block_.samples > 0 && time_s - block_.start_s >= block_s) {
        end_block(time_s);
    }
    block_.start_s = block_.samples == 0 ? time_s : block_.start_s;
    block_.sum_mm_s += velocity_mm_s;
    fastest_mm_s_ = std::max(fastest_mm_s_, std::abs(velocity_mm_s));
    ++block_.samples;
}

void AxisMotionUnits::interrupt() {
    block_ = {};
    has_average_ = false;
}

void AxisMotionUnits::end_block(double time_s) {
    const Average next{0.5 * (block_.start_s + time_s), block_.sum_mm_s / static_cast<double>(block_.samples)};
    if (has_average_) {
        add_acceleration(1e-3 * std::abs(next.velocity_mm_s - average_.velocity_mm_s) /
                         (next.middle_s - average_.middle_s));
    }
    average_ = next;
    has_average_ = true;
    block_ = {};
}

void AxisMotionUnits::add_acceleration(double acceleration_m_s2) {
    if (acceleration_m_s2 > largest_m_s2_.back()) {
        largest_m_s2_.back() = acceleration_m_s2;
        std::sort(largest_m_s2_.begin(), largest_m_s2_.end(), std::greater<>());
    }
}

double AxisMotionUnits::interval_s() const {
    return samples_ > 1 ? (last_s_ - first_s_) / static_cast<double>(samples_ - 1) : 0.0;
}

void AxisMotionUnits::refuse_implausible(const std::string& file, char axis, double longest_travel_m) const {
    constexpr double largest_m_s2 = 50.0;
    constexpr double longest_interval_s = 0.2;
    constexpr double longest_axis_m = 10.0;
    if (interval_s() > longest_interval_s && longest_travel_m > longest_axis_m) {
        throw InputError(
            fmt::format("{}: column 'time_s': {:.4g} s from sample to sample, in which {} travels {:.4g} m at "
                        "one feed; expected at most {:g} m of an axis; is it in ms?",
                        file, interval_s(), axis, longest_travel_m, longest_axis_m));
    }
    if (largest_m_s2_.back() > largest_m_s2) {
        throw InputError(
            fmt::format("{}: column '{}_velocity_mm_s': {} accelerates by {:.4g} m/s²; expected at most {:g} "
                        "m/s²; is it in mm/min, or time_s in min?",
                        file, axis, axis, largest_m_s2_.back(), largest_m_s2));
    }
}

UnitQuestions AxisMotionUnits::questions(char axis) const {
    constexpr double fast_m_s2 = 15.0;
    constexpr double slow_m_s2 = 0.05;
    constexpr double fast_mm_s = 1000.0;
    if (fastest_mm_s_ > fast_mm_s) {
        return {
            fmt::format("{} moves at up to {:.4g} mm/s; usual are {:g} mm/s (60 m/min) or less; is {}_velocity_mm_s in "
                        "mm/min?",
                        axis, fastest_mm_s_, fast_mm_s, axis)};
    }
    if (largest_m_s2_.back() > fast_m_s2) {
        return {
            fmt::format("{} accelerates by {:.3g} m/s², which ball screws do not reach: usual is less than {:g} m/s²; "
                        "is {}_velocity_mm_s in mm/min?",
                        axis, largest_m_s2_.back(), fast_m_s2, axis)};
    }
    if (largest_m_s2_.front() < slow_m_s2) {
        return {
            fmt::format("{} never accelerates by more than {:.2g} m/s²: usual is more than {:g} m/s²; is "
                        "{}_velocity_mm_s in m/min or m/s, or time_s in ms?",
                        axis, largest_m_s2_.front(), slow_m_s2, axis)};
    }
    return {};
}

UnitQuestions ask_about_axis_friction(char axis, double friction_A) {
    constexpr double usual_A = 20.0;
    if (friction_A <= usual_A) {
        return {};
    }
    return {fmt::format("{}: {:.4g} A of friction on average; usual is less than {:g} A; is {}_current_A in mA?", axis,
                        friction_A, usual_A, axis)};
}

void refuse_implausible_interval(const std::string& file, double interval_s) {
    constexpr double longest_s = 0.2;
    if (interval_s > longest_s) {
        throw InputError(
            fmt::format("{}: column 'time_s': {:.4g} s from sample to sample; expected at most {:g} s; is it "
                        "in ms?",
                        file, interval_s, longest_s));
    }
}

UnitQuestions look_at_axis_mass(const std::string& file, double mass_kg) {
    constexpr double least_kg = 0.2;
    constexpr double light_kg = 5.0;
    constexpr double heavy_kg = 20e3;
    constexpr double most_kg = 200e3;
    const std::string_view likely = mass_kg < light_kg ? "is motor_force_N in kN, or position_m in mm?"
                                                       : "is motor_force_N in mN, or time_s in another unit?";
    if (mass_kg < least_kg || mass_kg > most_kg) {
        throw InputError(
            fmt::format("{}: 'mass_kg' = {:.4g}; expected {:g} to {:g}; {}", file, mass_kg, least_kg, most_kg, likely));
    }
    if (mass_kg < light_kg || mass_kg > heavy_kg) {
        return {fmt::format("'mass_kg' = {:.4g}; usual are {:g} to {:g} kg; {}", mass_kg, light_kg, heavy_kg, likely)};
    }
    return {};
}

}  // namespace millforce::host
