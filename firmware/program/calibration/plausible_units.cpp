// SPDX-License-Identifier: Apache-2.0
#include "calibration/plausible_units.hpp"

#include "calibration/calibration_report.hpp"
#include "estimation/number/circle.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace millforce::host {

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double largest_feed_per_tooth_mm(double tool_diameter_mm) {
    constexpr double largest_mm = 1.5;
    constexpr double largest_per_diameter = 0.06;
    return std::min(largest_mm, largest_per_diameter * tool_diameter_mm);
}

double smallest_feed_per_tooth_mm(double tool_diameter_mm) {
    return 1e-4 * tool_diameter_mm;
}

void refuse_implausible_cut(const std::string& place, const CutKinematics& cut, std::string_view feed_column,
                            std::string_view speed_column) {
    constexpr double largest_cutting_speed_m_s = 120.0;
    constexpr double smallest_cutting_speed_m_s = 0.01;  // 0.6 m/min: a fifth of what the hardest alloys are cut at
    constexpr double rpm = 30.0 / std::numbers::pi;      // in 1 rad/s
    const bool by_angle = speed_column == "spindle_angle_rad";
    const double cutting_speed_m_s = 0.5e-3 * cut.tool_diameter_mm * cut.spindle_rad_s;
    const auto refuse_speed = [&](std::string_view expected, std::string_view likely) {
        throw InputError(
            fmt::format("{}: column '{}': {:.5g} rad/s is {:.6g} 1/min, {:.3g} m/s on a tool of Ø{:g} mm; expected {}; "
                        "is it in {}?",
                        place, speed_column, cut.spindle_rad_s, cut.spindle_rad_s * rpm, cutting_speed_m_s,
                        cut.tool_diameter_mm, expected, likely));
    };
    if (cutting_speed_m_s > largest_cutting_speed_m_s) {
        refuse_speed(fmt::format("at most {:g} m/s", largest_cutting_speed_m_s),
                     by_angle ? "degrees, or time_s in min" : "1/min or in degrees");
    }
    if (cutting_speed_m_s < smallest_cutting_speed_m_s) {
        refuse_speed(fmt::format("at least {:g} m/s", smallest_cutting_speed_m_s),
                     by_angle ? "revolutions, or time_s in ms" : "1/s");
    }
    const double largest_mm = largest_feed_per_tooth_mm(cut.tool_diameter_mm);
    const double smallest_mm = smallest_feed_per_tooth_mm(cut.tool_diameter_mm);
    if (cut.feed_per_tooth_mm > largest_mm) {
        // Revolutions for radians alone make a chip 2π times as thick.
        const bool may_be_speed = cut.feed_per_tooth_mm < 2.0 * std::numbers::pi * largest_mm;
        throw InputError(fmt::format(
            "{}: column '{}': {:.4g} mm/s is a chip of {:.3g} mm on a tool of Ø{:g} mm; expected at most {:.3g} mm; {}",
            place, feed_column, cut.feed_mm_s, cut.feed_per_tooth_mm, cut.tool_diameter_mm, largest_mm,
            may_be_speed ? fmt::format("is {} in {}, or {} in mm/min?", speed_column, by_angle ? "revolutions" : "1/s",
                                       feed_column)
                         : "is it in mm/min?"));
    }
    if (cut.feed_per_tooth_mm < smallest_mm) {
        throw InputError(fmt::format(
            "{}: column '{}': {:.4g} mm/s is a chip of {:.3g} µm on a tool of Ø{:g} mm; expected at least {:.3g} µm; "
            "is "
            "{} in {}, or {} in m/min or m/s?",
            place, feed_column, cut.feed_mm_s, 1000.0 * cut.feed_per_tooth_mm, cut.tool_diameter_mm,
            1000.0 * smallest_mm, speed_column, by_angle ? "degrees or time_s in min" : "1/min", feed_column));
    }
}

namespace {

/// K_s of each cut, by its torque alone.
std::vector<double> pressures_of(const std::vector<CutRow>& cuts, estimation::CutSide side) {
    std::vector<double> pressures;
    for (const CutRow& row : cuts) {
        const auto measured = row.measurement(side);
        const double area_mm2 = measured.cut.feed_per_tooth_mm * measured.cut.axial_depth_mm * measured.cut.teeth *
                                estimation::engagement_integrals(measured.cut.engagement).c /
                                estimation::turn_rad<double>;
        if (std::isfinite(measured.tangential_N) && area_mm2 > 0.0) {
            pressures.push_back(measured.tangential_N / area_mm2);
        }
    }
    return pressures;
}

std::string_view units_of_a_high_pressure(CutSource source) {
    return source == CutSource::table
               ? "is spindle_rad_s in 1/min, spindle_torque_Nm in another unit (N·cm, N·mm), feed_mm_s in m/min, "
                 "or a depth or width in cm?"
               : "are the currents in mA, is spindle_angle_rad in degrees, or a depth or width in cm?";
}

std::string_view units_of_a_low_pressure(CutSource source) {
    return source == CutSource::table
               ? "is spindle_torque_Nm in another unit (kN·m), spindle_rad_s in 1/s, or axial_depth_mm in µm?"
               : "is spindle_angle_rad in revolutions, or axial_depth_mm in µm?";
}

/// A force beside F_at = T/R, in all cuts that have both.
struct ForceBesideTorque {
    std::vector<double> forces_N;
    std::vector<double> tangential_N;

    ForceBesideTorque(const std::vector<CutRow>& cuts, double CutRow::*force) {
        for (const CutRow& row : cuts) {
            const double along_edge_N = row.spindle_torque_Nm * 1000.0 / row.radius_mm();
            if (std::isfinite(row.*force) && along_edge_N > 0.0) {
                forces_N.push_back(std::abs(row.*force));
                tangential_N.push_back(along_edge_N);
            }
        }
    }
};

}  // namespace

void append(UnitQuestions& questions, const UnitQuestions& more) {
    questions.insert(questions.end(), more.begin(), more.end());
}

int ask(std::ostream& out, const UnitQuestions& questions, int exit_code) {
    for (const std::string& question : questions) {
        out << "warning: " << question << '\n';
    }
    return questions.empty() ? exit_code : exit_bound_broken;
}

void refuse_implausible_pressure(const std::string& file, const std::vector<CutRow>& cuts, estimation::CutSide side,
                                 CutSource source) {
    const std::vector<double> pressures = pressures_of(cuts, side);
    if (pressures.empty()) {
        return;
    }
    const double middle = median_of(pressures);
    if (middle < 0.0) {
        throw InputError(fmt::format(
            "{}: the torque of the cuts is negative (median K_s {:.4g} N/mm²); expected a positive torque, against the "
            "rotation",
            file, middle));
    }
    if (middle < softest_N_per_mm2 || middle > hardest_N_per_mm2) {
        throw InputError(fmt::format(
            "{}: the torques mean a cutting pressure of {:.4g} N/mm² (median of {} cuts); expected {:g} to {:g}; {}",
            file, middle, pressures.size(), softest_N_per_mm2, hardest_N_per_mm2,
            middle < softest_N_per_mm2 ? units_of_a_low_pressure(source) : units_of_a_high_pressure(source)));
    }
}

UnitQuestions ask_about_speed_of(const std::vector<CutRow>& cuts, estimation::CutSide side, CutSource source) {
    constexpr double least_W_per_mm2 = 200.0;
    constexpr double most_W_per_mm2 = 100e3;
    const std::vector<double> pressures = pressures_of(cuts, side);
    if (pressures.empty()) {
        return {};
    }
    std::vector<double> speeds_m_s;
    speeds_m_s.reserve(cuts.size());
    for (const CutRow& row : cuts) {
        speeds_m_s.push_back(1e-3 * row.radius_mm() * row.spindle_rad_s);
    }
    const double pressure = median_of(pressures);
    const double speed_m_s = median_of(speeds_m_s);
    const double W_per_mm2 = pressure * speed_m_s;
    if (W_per_mm2 >= least_W_per_mm2 && W_per_mm2 <= most_W_per_mm2) {
        return {};
    }
    return {
        fmt::format("a cutting pressure of {:.4g} N/mm² at {:.3g} m/s (medians) takes {:.3g} W for each mm² of chip; "
                    "usual are {:g} to {:g}: soft material is cut fast, and hard one slowly; {}",
                    pressure, speed_m_s, W_per_mm2, least_W_per_mm2, most_W_per_mm2,
                    W_per_mm2 < least_W_per_mm2 ? units_of_a_low_pressure(source) : units_of_a_high_pressure(source))};
}

void refuse_implausible_forces(const std::string& file, const std::vector<CutRow>& cuts, CutSource source) {
    constexpr double least = 0.02;
    constexpr double most = 20.0;
    const auto look_at = [&](std::string_view column, double CutRow::*force) {
        const ForceBesideTorque found(cuts, force);
        if (found.forces_N.empty()) {
            return;
        }
        const double force_N = median_of(found.forces_N);
        const double tangential_N = median_of(found.tangential_N);
        if (force_N >= least * tangential_N && force_N <= most * tangential_N) {
            return;
        }
        const bool is_small = force_N < least * tangential_N;
        const std::string likely = source == CutSource::recording ? "is an axis' current in mA?"
                                   : is_small                     ? "is it in kN?"
                                                                  : "is it in mN, or spindle_torque_Nm in kN·m?";
        throw InputError(fmt::format(
            "{}: {}: {:.4g} N beside {:.4g} N along the edge by the torque (medians of {} cuts); expected {:g} to {:g} "
            "times as much; {}",
            file, column, force_N, tangential_N, found.forces_N.size(), least, most, likely));
    };
    const bool is_table = source == CutSource::table;
    look_at(is_table ? "column 'normal_force_N'" : "the normal force", &CutRow::normal_force_N);
    look_at(is_table ? "column 'feed_force_N'" : "the feed force by the axis' current", &CutRow::feed_force_N);
}

UnitQuestions force_against_law(const std::string& table, double measured_over_law, double law_N_per_mm2) {
    constexpr double usual_factor = 4.0;
    constexpr std::string_view likely =
        "are the forces in kN, daN or mN, or axial_depth_mm or radial_width_mm in another unit?";
    const double pressure = measured_over_law * law_N_per_mm2;
    if (pressure < softest_N_per_mm2 || pressure > hardest_N_per_mm2) {
        throw InputError(fmt::format(
            "{}: the forces of the cuts are {:.3g} times those of the tool's law, a cutting pressure of {:.4g} N/mm²; "
            "expected {:g} to {:g}; {}",
            table, measured_over_law, pressure, softest_N_per_mm2, hardest_N_per_mm2, likely));
    }
    if (measured_over_law < 1.0 / usual_factor || measured_over_law > usual_factor) {
        return {
            fmt::format("the forces of the cuts are {:.3g} times those of the tool's [cutting] law; usual is a "
                        "quarter to four times; {}",
                        measured_over_law, likely)};
    }
    return {};
}

UnitQuestions ask_about_one_force(double along_over_law, double across_over_law) {
    constexpr double usual_factor = 4.0;
    if (along_over_law < usual_factor * across_over_law && across_over_law < usual_factor * along_over_law) {
        return {};
    }
    return {
        fmt::format("along the feed the force is {:.3g} times that of the tool's law, across it {:.3g} times; usual "
                    "is about the same; is fx_N or fy_N in kN, daN or mN?",
                    along_over_law, across_over_law)};
}

namespace {

void refuse_implausible_test(const RoughnessUnits& test) {
    constexpr double fastest_m_s = 120.0;
    constexpr double slowest_m_s = 0.01;
    constexpr double largest_feed = 1.0;  // per revolution, of the diameter: 16 teeth of 6 %
    constexpr double deepest = 10.0;      // flutes are no longer
    constexpr double smallest = 1e-4;
    constexpr double largest_ratio = 100.0;
    const auto refuse = [&](std::string_view column, double value, std::string_view expected, std::string_view likely) {
        throw InputError(fmt::format("{}: column '{}': {:.4g} on a tool of Ø{:g} mm; expected {}; {}", test.place,
                                     column, value, test.tool_diameter_mm, expected, likely));
    };
    const double cutting_speed_m_s = 1e-3 * std::numbers::pi * test.tool_diameter_mm * test.spindle_rpm / 60.0;
    if (cutting_speed_m_s > fastest_m_s || cutting_speed_m_s < slowest_m_s) {
        refuse("spindle_speed_rpm", test.spindle_rpm, fmt::format("{:g} to {:g} m/s", slowest_m_s, fastest_m_s),
               cutting_speed_m_s > fastest_m_s ? "is it in another unit?" : "is it in 1000 1/min, or in 1/s?");
    }
    const double feed = test.feed_mm_rev / test.tool_diameter_mm;
    if (feed > largest_feed || feed < smallest) {
        refuse("feed_mm_rev", test.feed_mm_rev, "a ten-thousandth of the diameter to the diameter",
               feed > largest_feed ? "is it in mm/min, mm/s or µm?" : "is it in m or inch?");
    }
    const double depth = test.axial_depth_mm / test.tool_diameter_mm;
    if (depth > deepest || depth < smallest) {
        refuse("axial_depth_mm", test.axial_depth_mm, "a ten-thousandth of the diameter to ten diameters",
               depth > deepest ? "is it in µm?" : "is it in m?");
    }
    if (test.force_ratio > largest_ratio || test.force_ratio < 1.0 / largest_ratio) {
        throw InputError(
            fmt::format("{}: the feed force is {:.4g} times the axial one; expected {:g} to {:g}; is one of "
                        "them in kN?",
                        test.place, test.force_ratio, 1.0 / largest_ratio, largest_ratio));
    }
}

/// Grades N1 to N12 of ISO 1302; a surface's R_z is about four times its R_a.
UnitQuestions look_at_roughness(const std::string& place, double median_um, const std::string& measure) {
    constexpr double finest_Ra_um = 0.025;
    constexpr double coarsest_Ra_um = 50.0;
    constexpr double beyond = 10.0;
    const double scale = measure == "Rz" ? 4.0 : 1.0;
    const double finest_um = scale * finest_Ra_um;
    const double coarsest_um = scale * coarsest_Ra_um;
    if (median_um >= finest_um && median_um <= coarsest_um) {
        return {};
    }
    const std::string text =
        fmt::format("column '{}_um': {:.4g} µm (median); grades of roughness go from {:g} to {:g} µm; is it in {}?",
                    measure, median_um, finest_um, coarsest_um, median_um < finest_um ? "mm" : "nm or µinch");
    if (median_um < finest_um / beyond || median_um > beyond * coarsest_um) {
        throw InputError(fmt::format("{}: {}", place, text));
    }
    return {text};
}

UnitQuestions ask_about_milled_feed(double median_feed_mm_rev, double median_diameter_mm) {
    constexpr double usual = 0.3;  // five teeth of 6 % of the diameter
    if (median_feed_mm_rev <= usual * median_diameter_mm) {
        return {};
    }
    return {
        fmt::format("column 'feed_mm_rev': {:.4g} on tools of Ø{:g} mm (medians); usual is less than {:.3g}; is it in "
                    "mm/s?",
                    median_feed_mm_rev, median_diameter_mm, usual * median_diameter_mm)};
}

/// So small a tool turns fast: at the speed of a large one it would hardly cut.
UnitQuestions ask_about_milled_diameter(double median_diameter_mm, double median_rpm) {
    constexpr double small_mm = 2.0;
    constexpr double usual_m_per_min = 40.0;
    const double cutting_m_per_min = 1e-3 * std::numbers::pi * median_diameter_mm * median_rpm;
    if (median_diameter_mm > small_mm || cutting_m_per_min > usual_m_per_min) {
        return {};
    }
    return {
        fmt::format("column 'tool_diameter_mm': Ø{:g} at {:g} 1/min (medians) cuts at {:.3g} m/min; so small a tool "
                    "usually at more than {:g}; is it in cm?",
                    median_diameter_mm, median_rpm, cutting_m_per_min, usual_m_per_min)};
}

UnitQuestions ask_about_milled_speeds(const std::vector<double>& speeds) {
    constexpr double rpm = 30.0 / std::numbers::pi;  // in 1 rad/s
    constexpr double s_per_min = 60.0;
    for (const auto& [unit, per_minute] : {std::pair("rad/s", rpm), std::pair("1/s", s_per_min)}) {
        if (is_round_only_by(speeds, per_minute)) {
            const double fastest = *std::max_element(speeds.begin(), speeds.end());
            return {
                fmt::format("column 'spindle_speed_rpm': only in {} is each speed a multiple of 50 1/min, {:.5g} {} "
                            "being {:.6g} 1/min; is it in {}?",
                            unit, fastest, unit, fastest * per_minute, unit)};
        }
    }
    return {};
}

}  // namespace

UnitQuestions look_at_roughness_tests(const std::vector<RoughnessUnits>& tests, const std::string& measure) {
    std::vector<double> speeds;
    std::vector<double> feeds;
    std::vector<double> diameters;
    std::vector<double> roughness;
    for (const RoughnessUnits& test : tests) {
        refuse_implausible_test(test);
        speeds.push_back(test.spindle_rpm);
        feeds.push_back(test.feed_mm_rev);
        diameters.push_back(test.tool_diameter_mm);
        roughness.push_back(test.roughness_um);
    }
    if (tests.empty()) {
        return {};
    }
    UnitQuestions questions = look_at_roughness(tests.front().place, median_of(roughness), measure);
    append(questions, ask_about_milled_feed(median_of(feeds), median_of(diameters)));
    append(questions, ask_about_milled_diameter(median_of(diameters), median_of(speeds)));
    append(questions, ask_about_milled_speeds(speeds));
    return questions;
}

bool is_round_only_by(const std::vector<double>& speeds, double per_minute) {
    constexpr double step = 50.0;
    constexpr double fourth_digit = 1e-4;
    constexpr double second_decimal = 0.005;
    const auto is_multiple = [](double value, double of, double tolerance) {
        return std::abs(std::remainder(value, of)) <= tolerance;
    };
    const auto is_round = [&](double speed) {
        return is_multiple(per_minute * speed, step, per_minute * std::max(fourth_digit * speed, second_decimal));
    };
    const auto is_whole = [&](double speed) { return is_multiple(speed, 1.0, 1e-6 * speed); };
    return std::all_of(speeds.begin(), speeds.end(), is_round) && !std::all_of(speeds.begin(), speeds.end(), is_whole);
}

void AngleUnit::look_at(const CsvReader& csv, CsvColumn column, double angle) {
    constexpr double end_of_turn_deg = 361.0;
    const bool begins_again =
        last_ > 0.75 * end_of_turn_deg && last_ < end_of_turn_deg && angle > -1.0 && angle < 0.5 * end_of_turn_deg;
    if (begins_again) {
        csv.fail(column, fmt::format("{:.6g} after {:.6g}; expected rad, which begin again at 6.283 or go on; is it in "
                                     "degrees?",
                                     angle, last_));
    }
    if (std::isfinite(angle)) {
        falls_ += angle < last_ - 0.5 ? 1 : 0;
        smallest_ = std::min(smallest_, angle);
        largest_ = std::max(largest_, angle);
        last_ = angle;
    }
}

void AngleUnit::look_at_end(const CsvReader& csv) const {
    constexpr double turn_rev = 1.0;
    constexpr int fewest_turns = 3;  // a single fall may be a spindle that is turned back
    if (falls_ >= fewest_turns && smallest_ >= 0.0 && largest_ <= turn_rev) {
        throw InputError(
            fmt::format("{}: column 'spindle_angle_rad': it begins again at {:.4g}; expected rad, which begin again at "
                        "6.283 or go on; is it in revolutions?",
                        csv.file_name(), largest_));
    }
}

std::optional<std::string> angle_in_another_unit(const std::filesystem::path& recording) {
    CsvReader csv(recording);
    const CsvColumn angle = csv.require("spindle_angle_rad");
    AngleUnit unit;
    const auto refusal_of = [](const auto& look) -> std::optional<std::string> {
        try {
            look();
        } catch (const InputError& refusal) {
            return refusal.what();
        }
        return std::nullopt;
    };
    while (csv.next_row()) {
        const double value = csv.number(angle);
        if (auto refusal = refusal_of([&] { unit.look_at(csv, angle, value); })) {
            return refusal;
        }
    }
    return refusal_of([&] { unit.look_at_end(csv); });
}

}  // namespace millforce::host
