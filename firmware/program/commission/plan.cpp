// SPDX-License-Identifier: Apache-2.0
#include "commission/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace millforce::host {

namespace {

/// `count` values from `low` to `high`, each larger than the one before by the same factor.
std::vector<double> geometric(double low, double high, std::int64_t count) {
    std::vector<double> values;
    for (std::int64_t k = 0; k < count; ++k) {
        const double exponent = static_cast<double>(k) / static_cast<double>(count - 1);
        values.push_back(std::round(low * std::pow(high / low, exponent)));
    }
    return values;
}

std::vector<CutPass> passes_of(double feed_mm_min, double depth_mm, double width_mm,
                               const std::vector<std::pair<double, double>>& shares) {
    std::vector<CutPass> passes;
    passes.reserve(shares.size());
    for (const auto& [feed_share, width_share] : shares) {
        passes.push_back({std::round(feed_share * feed_mm_min), depth_mm, width_share * width_mm});
    }
    return passes;
}

constexpr double clear_mm = 2.0;
constexpr double safe_height_mm = 5.0;
constexpr double entry_margin_mm = 6.0;  // two changes of the cut, each with 2 mm, and one more

// Each program waits two seconds after M3, for the spindle to reach its speed.
constexpr const char* program_head = "G21 G90 G17 G40 G49 G80 G94\n";

std::string upper(const std::string& axis) {
    return axis == "x" ? "X" : axis == "y" ? "Y" : "Z";
}

double width_of_largest(const CommissionPlan& plan) {
    double width_mm = 0.0;
    for (const CutPass& pass : plan.standard) {
        width_mm = std::max(width_mm, pass.radial_width_mm);
    }
    return width_mm;
}

/// Air, or cut, of one pass: a turn of the screw or more, and the margins of CutWatch.
double stretch_mm(const CommissionPlan& plan) {
    const double width_mm = width_of_largest(plan);
    const double entry_mm = std::sqrt(std::max(width_mm * (plan.tool_diameter_mm - width_mm), 0.0));
    return plan.travel_per_motor_turn_mm + entry_margin_mm + 2.0 * entry_mm;
}

}  // namespace

CommissionPlan plan_of(Answers& answers, const std::vector<std::string>& axes) {
    CommissionPlan plan;
    plan.axes = axes;
    const double fastest_rpm = answers.number({"idle.highest_rpm", "Highest speed of the spindle", "1/min", 10.0, 1e5});
    const double slowest_rpm = answers.number({"idle.lowest_rpm", "Lowest speed of the spindle that is used", "1/min",
                                               10.0, 1e5, std::round(0.2 * fastest_rpm)});
    plan.idle_rpm =
        geometric(slowest_rpm, fastest_rpm, answers.integer({"idle.speeds", "Number of speeds", "", 3.0, 20.0, 4.0}));
    plan.idle_dwell_s = answers.number({"idle.dwell_s", "Time at each speed", "s", 0.5, 600.0, 10.0});
    const double slowest =
        answers.number({"air.lowest_feed_mm_min", "Slowest feed of the air cuts", "mm/min", 1.0, 1e5, 150.0});
    const double fastest =
        answers.number({"air.highest_feed_mm_min", "Fastest feed of the air cuts", "mm/min", 1.0, 1e5, 3000.0});
    plan.air_feeds_mm_min =
        geometric(slowest, fastest, answers.integer({"air.feeds", "Number of feeds", "", 4.0, 20.0, 7.0}));
    plan.air_travel_mm =
        answers.number({"air.travel_mm", "Travel of each air cut, several turns of the screw", "mm", 1.0, 1e4, 40.0});
    plan.air_rpm = answers.number(
        {"air.spindle_rpm", "Speed of the spindle in the air cuts", "1/min", 10.0, 1e5, std::round(0.5 * fastest_rpm)});
    plan.database =
        answers.word({"standard_cut.database", "File with the coefficients of the standard tool and steel", {}, {}});
    plan.entry = answers.word({"standard_cut.entry", "Its entry", {}, {}});
    plan.tool_diameter_mm = answers.number({"tool.diameter_mm", "Standard tool: cutting diameter", "mm", 0.1, 1000.0});
    plan.flutes = static_cast<int>(answers.integer({"tool.teeth", "Standard tool: number of teeth", "", 1.0, 12.0}));
    plan.cut_rpm =
        answers.number({"standard_cut.spindle_rpm", "Standard cut: speed of the spindle", "1/min", 10.0, 1e5});
    const double feed = answers.number({"standard_cut.feed_mm_min", "Standard cut: middle feed", "mm/min", 1.0, 1e5});
    const double depth =
        answers.number({"standard_cut.axial_depth_mm", "Standard cut: axial depth", "mm", 0.01, 300.0});
    const double width =
        answers.number({"standard_cut.radial_width_mm", "Standard cut: middle radial width", "mm", 0.01, 500.0});
    const std::string side = answers.word(
        {"standard_cut.side", "Standard cut: down (climb) or up (conventional) milling", {"down", "up"}, "down"});
    plan.side = side == "up" ? estimation::CutSide::up : estimation::CutSide::down;
    for (const std::string& axis : axes) {
        plan.travel_per_motor_turn_mm =
            std::max(plan.travel_per_motor_turn_mm,
                     answers.number({axis + ".travel_per_motor_turn_mm",
                                     axis + ": travel per turn of the motor (screw lead)", "mm", 0.01, 1e3}));
    }
    plan.standard = passes_of(feed, depth, width,
                              {{0.4, 1.0}, {0.7, 1.0}, {1.0, 1.0}, {1.3, 1.0}, {1.6, 1.0}, {1.0, 0.5}, {1.0, 2.0}});
    plan.validation = passes_of(feed, depth, width, {{0.55, 1.4}, {1.15, 1.2}, {1.45, 0.8}});
    return plan;
}

std::string idle_program(const CommissionPlan& plan) {
    std::string text = std::string("%\n(The spindle idles at each speed; the axes rest)\n") + program_head;
    for (const double rpm : plan.idle_rpm) {
        // The first second is that of the change of speed.
        text += fmt::format("S{:.0f} M3\nG4 P{:.1f}\n", rpm, plan.idle_dwell_s + 2.0);
    }
    return text + "M30\n%\n";
}

std::string air_program(const CommissionPlan& plan) {
    std::string text = fmt::format("%\n(Air cuts: {:g} mm to and fro from here, at {} feeds)\n{}S{:.0f} M3\nG4 P2\n",
                                   plan.air_travel_mm, plan.air_feeds_mm_min.size(), program_head, plan.air_rpm);
    for (const std::string& axis : plan.axes) {
        for (const double feed : plan.air_feeds_mm_min) {
            text += fmt::format("G1 {}{:.3f} F{:.0f}\nG4 P0.2\nG1 {}0 F{:.0f}\nG4 P0.2\n", upper(axis),
                                plan.air_travel_mm, feed, upper(axis), feed);
        }
    }
    return text + "M30\n%\n";
}

double block_length_mm(const CommissionPlan& plan) {
    return stretch_mm(plan);
}

std::string cut_program(const CommissionPlan& plan, const std::string& axis, const std::vector<CutPass>& passes) {
    const double radius_mm = 0.5 * plan.tool_diameter_mm;
    const double air_mm = stretch_mm(plan) + radius_mm + clear_mm;
    const double run_out_mm = radius_mm + clear_mm;
    const bool is_down = plan.side == estimation::CutSide::down;
    const double start_mm = is_down ? -air_mm : block_length_mm(plan) + air_mm;
    const double end_mm = is_down ? block_length_mm(plan) + run_out_mm : -run_out_mm;
    const bool along_x = axis == "x";
    const double away = along_x ? 1.0 : -1.0;  // from the block: +y, or −x
    const std::string along = along_x ? "X" : "Y";
    const std::string across = along_x ? "Y" : "X";
    std::string text =
        fmt::format("%\n({} milling along {}{}: {} passes on a block {:.1f} mm long)\n{}S{:.0f} M3\nG4 P2\nG0 Z{:g}\n",
                    is_down ? "Down" : "Up", is_down ? "+" : "-", axis, passes.size(), block_length_mm(plan),
                    program_head, plan.cut_rpm, safe_height_mm);
    double taken_mm = 0.0;
    for (const CutPass& pass : passes) {
        taken_mm += pass.radial_width_mm;
        text += fmt::format("G0 {}{:.3f} {}{:.3f}\nG0 Z{:.3f}\nG1 {}{:.3f} F{:.0f}\nG0 Z{:g}\n", along, start_mm,
                            across, away * (radius_mm - taken_mm), -pass.axial_depth_mm, along, end_mm,
                            pass.feed_mm_min, safe_height_mm);
    }
    return text + "M30\n%\n";
}

}  // namespace millforce::host
