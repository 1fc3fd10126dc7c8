// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "calibration/standard_cut_calibration.hpp"
#include "check/check_parameters.hpp"
#include "check/check_recording.hpp"
#include "commission/commission_page.hpp"
#include "commission/commissioning.hpp"
#include "commission/fitted_values.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {

constexpr double largest_gain_relative_se = 0.05;

/// Relative standard error of the gain that is known least.
double largest_gain_error(const std::filesystem::path& gains) {
    double largest = 0.0;
    for (const FittedKey& key : fitted_keys(gains)) {
        const bool is_gain = key.key == "K_t1_Nm_per_A" || key.key == "K_x4_N_per_A";
        largest = is_gain ? std::max(largest, key.standard_error.value_or(0.0) / key.value) : largest;
    }
    return largest;
}

/// The published law has forces in the plane alone.
std::string words_about_z(const std::vector<std::string>& axes) {
    return std::find(axes.begin(), axes.end(), "z") == axes.end()
               ? ""
               : "; z is not fitted: the law of the standard cut has no force along the tool, so z.K_x4_N_per_A stays "
                 "as by the data sheet (of the estimates only a roughness takes that force)";
}

}  // namespace

std::vector<std::filesystem::path> Commissioning::recordings_of(const std::string& kind) const {
    std::vector<std::filesystem::path> files;
    for (const std::string& step : steps_of(kind)) {
        const auto found = session_.recordings(step);
        files.insert(files.end(), found.begin(), found.end());
    }
    return files;
}

std::vector<std::string> Commissioning::steps_of(const std::string& kind) const {
    std::vector<std::string> steps = cutting_axes(axes_);
    for (std::string& step : steps) {
        step = fmt::format("{}_{}", kind, step);
    }
    return steps;
}

bool Commissioning::fit() {
    add_idle(machine_, static_cast<double>(first_.machine.spindle.K_t1_Nm_per_A));
    machine_.save(session_.file("before_cuts.toml"));
    std::ostringstream report;
    bool is_near_the_plate = true;
    try {
        StandardCutOptions standard;
        standard.data = recordings_of("standard");
        standard.cuts = joined_table("standard");
        standard.machine = session_.file("before_cuts.toml");
        standard.database = plan_.database;
        standard.entry = plan_.entry;
        standard.side = plan_.side;
        standard.output = session_.file("gains.toml");
        is_near_the_plate = calibrate_standard_cut(standard, report) == exit_done;
    } catch (const InputError& error) {
        refuse(steps_of("standard"), error);
        return false;
    }
    machine_.merge(session_.file("gains.toml"), "standard cut");
    machine_.save(session_.file("fitted.toml"));
    fitted_ = read_machine_parameters(session_.file("fitted.toml").string());
    // The slope is a torque: with the measured gain.
    const auto K_t1 = static_cast<double>(fitted_.spindle.K_t1_Nm_per_A);
    add_idle_slope(machine_, K_t1);
    const double moved_Nm = std::abs(static_cast<double>(fitted_.spindle.K_t2_Nm) + K_t1 * idle_.offset_A);
    machine_.set("spindle", "idle_torque_sd_Nm",
                 std::max(moved_Nm, static_cast<double>(MachineParameters{}.spindle.idle_torque_sd_Nm)),
                 "how far it moved from the idling to the cuts, or the usual value");
    const double largest_error = largest_gain_error(session_.file("gains.toml"));
    const bool is_known = largest_error <= largest_gain_relative_se;
    // The cuts are of our own plan: a gain far from the plate is rather a wrong plate than a wrong cut.
    judge("fit", is_known,
          fmt::format("the gains follow from the standard cuts to {:.1f} % (standard error, bound {:.0f} %){}{}{}",
                      100.0 * largest_error, 100.0 * largest_gain_relative_se, words_about_z(axes_),
                      is_known ? "" : "; wider or longer cuts are needed: another session with other answers",
                      is_near_the_plate ? "" : "; a gain is far from that of the data sheet, which the warning names"),
          report.str());
    return true;
}

void Commissioning::add_idle_slope(FileDraft& draft, double K_t1) const {
    draft.set("spindle", "idle_torque_slope_Nm_s", K_t1 * idle_.slope_A_s, "idling at several speeds");
    draft.set("spindle", "idle_torque_slope_Nm_s_se", K_t1 * idle_.slope_se);
}

void Commissioning::add_idle(FileDraft& draft, double K_t1) const {
    draft.set("spindle", "K_t2_Nm", -K_t1 * idle_.offset_A, "idling at several speeds");
    draft.set("spindle", "current_sd_A", idle_.noise_A, "measured while idling");
    add_idle_slope(draft, K_t1);
    for (const std::string& axis : axes_) {
        if (const auto noise = air_watch_->current_noise_A(axis_number(axis))) {
            draft.set(axis, "current_sd_A", *noise, "measured in air");
        }
    }
}

bool Commissioning::validate() {
    try {
        validated_ =
            validate_cuts(recordings_of("validation"), joined_table("validation"), fitted_, entry_, plan_.side);
    } catch (const InputError& error) {
        refuse(steps_of("validation"), error);
        return false;
    }
    std::string table;
    double largest_torque = 0.0;
    double largest_force = 0.0;
    bool holds = true;
    for (const ValidatedCut& cut : validated_) {
        table += fmt::format(
            "{} {:.0f} mm/min, {:g} mm wide: torque {:.3f} N·m, by the law {:.3f} ({:+.1f} %, bound {:.0f} %); "
            "feed "
            "force {:.1f} N, by the law {:.1f} ({:+.1f} %, bound {:.0f} %)\n",
            cut.axis, cut.feed_mm_min, cut.radial_width_mm, cut.torque_Nm, cut.expected_torque_Nm,
            100.0 * cut.torque_error(), 100.0 * cut.torque_bound, cut.feed_force_N, cut.expected_feed_force_N,
            100.0 * cut.force_error(), 100.0 * cut.force_bound);
        largest_torque = std::max(largest_torque, std::abs(cut.torque_error()));
        largest_force = std::max(largest_force, std::abs(cut.force_error()));
        holds = holds && cut.holds();
    }
    out_ << table;
    judge(
        "validation", holds,
        fmt::format(
            "cuts that the fit has not seen: torque off by {:.1f} % at most, feed force by {:.1f} %{}",
            100.0 * largest_torque, 100.0 * largest_force,
            holds
                ? ""
                : "; check depth, width and steel, and repeat both cuts: --repeat standard_x --repeat validation_x …"),
        table);
    return true;
}

void Commissioning::write_files() {
    machine_.set_heading("description", "Measured by 'millforce commission'");
    machine_.save(session_.file("machine.toml"));
    tool_.save(session_.file("tool.toml"));
    const auto parameters =
        read_parameters(session_.file("machine.toml").string(), session_.file("tool.toml").string());
    Findings findings = check_parameters(parameters);
    append(findings, check_recording(recordings_of("validation").back(), parameters));
    std::string lines;
    for (const Finding& finding : findings) {
        lines += line_of(finding) + "\n";
    }
    out_ << lines;
    judge("check", !is_something_wrong(findings), count_of(findings), lines);
    out_ << session_.file("machine.toml").string() << ": written\n"
         << session_.file("tool.toml").string() << ": written\n";
}

void Commissioning::write_page() {
    CommissionPage page;
    page.facts = {
        {"Axes", fmt::format("{}", fmt::join(axes_, ", "))},
        {"Standard cut", fmt::format("{}, {} milling", plan_.entry, name(plan_.side))},
        {"Tool", fmt::format("{} teeth, Ø{:g} mm", plan_.flutes, plan_.tool_diameter_mm)},
    };
    const Facts process = facts_of_this_process();
    page.facts.insert(page.facts.end(), process.begin(), process.end());
    page.facts.emplace_back("Written", date_and_time());
    page.verdicts = verdicts_;
    if (idle_watch_) {
        page.idle = idle_watch_->plateaus();
        page.idle_fit = idle_watch_->fit();
    }
    for (const std::string& axis : axes_) {
        if (air_watch_) {
            page.air.emplace_back(axis, air_watch_->found(axis_number(axis)));
        }
    }
    if (session_.has("before_cuts.toml")) {
        page.machine = read_machine_parameters(session_.file("before_cuts.toml").string());
    }
    page.validated = validated_;
    page.files = {"friction.toml", "gains.toml"};
    session_.write("report.html", page_text(page, session_));
    out_ << "report: " << session_.file("report.html").string() << '\n';
}

/// The tables of all axes as one, for the calibrations.
std::filesystem::path Commissioning::joined_table(const std::string& kind) const {
    std::string text;
    for (const std::string& step : steps_of(kind)) {
        std::ifstream file(session_.file(step + "_cuts.csv"));
        std::string line;
        std::getline(file, line);
        if (text.empty()) {
            text.append(line).append("\n");
        }
        while (std::getline(file, line)) {
            text.append(line).append("\n");
        }
    }
    session_.write(kind + "_cuts.csv", text);
    return session_.file(kind + "_cuts.csv");
}

}  // namespace millforce::host
