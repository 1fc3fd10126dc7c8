// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "files/progress.hpp"
#include "loop/bounds.hpp"
#include "loop/ensemble.hpp"

namespace millforce::sim {

namespace {

struct EnsembleOptions {
    std::string scenario;
    int runs = 40;
};

void print_row(const char* label, const std::string& value) {
    fmt::print("{:<34}{:>14}\n", label, value);
}

void print_table(const Scenario& scenario, const EnsembleFigures& figures) {
    const auto percent = [](double share) { return fmt::format("{:.1f} %", 100.0 * share); };
    fmt::print("{}: {} plants drawn from the stated deviations\n\n", scenario.title, figures.runs);
    print_row("time, mean", fmt::format("{:.1f} s", figures.time_s_mean));
    print_row("peak / limit, median", percent(figures.peak_over_limit_median));
    print_row("peak / limit, worst", percent(figures.peak_over_limit_worst));
    print_row("over limit, late, worst", fmt::format("{:.3f} s", figures.late_over_limit_s_worst));
    print_row("teeth broken", fmt::to_string(figures.teeth_broken));
    print_row("runs not finished", fmt::to_string(figures.unfinished));
    print_row("cut with an estimate", percent(figures.estimate_share));
    print_row("immersion rms error", fmt::format("{:.3f}", figures.immersion_rms));
    print_row("  within its 95 % band", percent(figures.immersion_coverage));
    print_row("depth rms error", fmt::format("{:.3f} mm", figures.depth_rms_mm));
    print_row("  within its 95 % band", percent(figures.depth_coverage));
}

int ensemble(const EnsembleOptions& options) {
    const Scenario scenario = read_scenario(options.scenario);
    std::vector<RunFigures> runs;
    {
        host::Progress progress(fmt::format("milling {} plants", options.runs), 1);
        runs = run_ensemble(scenario, options.runs, [&](double share) {
            progress.update(share);
            return true;
        });
    }
    const EnsembleFigures figures = summarise_ensemble(runs);
    print_table(scenario, figures);
    const bool held = std::all_of(runs.begin(), runs.end(), bounds_hold);
    return held ? 0 : 1;
}

}  // namespace

void add_ensemble(host::Command& program) {
    auto options = std::make_shared<EnsembleOptions>();
    host::Command command =
        program.subcommand("ensemble", "Mill the same scenario with many plants, to show how far the figures vary");
    command.footer(
        "K_s, friction, torque and force constants of each plant are drawn from the deviations that the machine and\n"
        "tool files state. Exit code 1: a tooth broke, a peak went beyond 110 % of the tooth's limit or above the "
        "limit\n"
        "later than the reaction time after the engagement grew, or a program did not finish.");
    command.option("scenario", options->scenario, "Scenario to mill").required().value_name("SCENARIO.toml");
    command.option("--runs", options->runs, "Number of plants").within(1, 10000).shows_default();
    command.on_run([options] { return ensemble(*options); });
}

}  // namespace millforce::sim
