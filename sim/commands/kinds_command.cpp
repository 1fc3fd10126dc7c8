// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "files/progress.hpp"
#include "loop/ensemble.hpp"
#include "loop/machine_kind.hpp"
#include "preview/preview.hpp"

namespace millforce::sim {

namespace {

struct KindsOptions {
    std::vector<std::string> scenarios;
    std::vector<std::string> kinds;
    int runs = 20;
};

/// A run that takes so many times as long as the safe constant feed is given up.
constexpr double longest_share = 3.0;

struct Part {
    Scenario scenario;
    host::PartMap map;
    double constant_s = 0.0;  ///< with the constant feed that is safe for a steel up to 30 % harder
};

/// A kind of machine, and its runs on each of the parts.
struct KindOnParts {
    MachineKind kind;
    std::vector<std::vector<RunFigures>> runs;
};

Part read_part_of_table(const std::string& path) {
    Part part{read_scenario(path), {}, 0.0};
    part.map = preview(part.scenario);
    ConstantFeed constant(part.scenario.parameters, safe_constant_override(part.scenario));
    part.constant_s = simulate(part.scenario, constant, "constant").result.figures.time_s;
    return part;
}

std::vector<RunFigures> mill(const Part& part, const MachineKind& kind, int runs) {
    EnsembleSettings settings;
    settings.longest_run_s = longest_share * part.constant_s;
    if (kind.has_part_map) {
        settings.map = part.map;
    }
    return run_ensemble(on_machine(part.scenario, kind), runs, {}, settings);
}

std::string number(double value, int places) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, places) : "–";
}

std::string percent(double share) {
    return std::isfinite(share) ? fmt::format("{:.0f} %", 100.0 * share) : "–";
}

EnsembleFigures over_all_parts(const KindOnParts& milled) {
    std::vector<RunFigures> all;
    for (const std::vector<RunFigures>& runs : milled.runs) {
        all.insert(all.end(), runs.begin(), runs.end());
    }
    return summarise_ensemble(all);
}

void print_estimates(const std::vector<KindOnParts>& machines) {
    fmt::print("| machine | F_at error | F_ax error | immersion known | error, R | in its 95 % band ");
    fmt::print("| depth known | error, mm | in its 95 % band |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const KindOnParts& milled : machines) {
        const EnsembleFigures all = over_all_parts(milled);
        fmt::print("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", milled.kind.title, percent(all.tangential_error),
                   percent(all.feed_force_error), percent(all.estimate_share), number(all.immersion_rms, 2),
                   percent(all.immersion_coverage), percent(all.depth_share), number(all.depth_rms_mm, 1),
                   percent(all.depth_coverage));
    }
}

/// The mean time of the runs that came to the end, over the constant feed's, and how many did not.
std::string time_cell(const std::vector<RunFigures>& runs, double constant_s) {
    double time_s = 0.0;
    std::size_t finished = 0;
    for (const RunFigures& run : runs) {
        time_s += run.finished ? run.time_s : 0.0;
        finished += run.finished ? 1U : 0U;
    }
    if (finished == runs.size()) {
        return percent(time_s / (static_cast<double>(finished) * constant_s));
    }
    return fmt::format("{} of {} not finished", runs.size() - finished, runs.size());
}

void print_control(const std::vector<Part>& parts, const std::vector<KindOnParts>& machines) {
    std::string head = "| machine | peak, median | peak, 95 % | teeth broken |";
    std::string line = "|---|---|---|---|";
    for (const Part& part : parts) {
        head += fmt::format(" time: {} |", part.scenario.title);
        line += "---|";
    }
    fmt::print("{}\n{}\n", head, line);
    for (const KindOnParts& milled : machines) {
        const EnsembleFigures all = over_all_parts(milled);
        std::string row = fmt::format("| {} | {} | {} | {} |", milled.kind.title, percent(all.peak_over_limit_median),
                                      percent(all.peak_over_limit_95), all.teeth_broken);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            row += fmt::format(" {} |", time_cell(milled.runs[k], parts[k].constant_s));
        }
        fmt::print("{}\n", row);
    }
}

int kinds(const KindsOptions& options) {
    std::vector<KindOnParts> machines;
    for (const std::string& path : options.kinds) {
        machines.push_back({read_machine_kind(path), {}});
    }
    std::vector<Part> parts;
    {
        host::Progress progress("milling", 1);
        for (const std::string& path : options.scenarios) {
            progress.show(path);
            parts.push_back(read_part_of_table(path));
            for (KindOnParts& machine : machines) {
                progress.show(parts.back().scenario.title + ": " + machine.kind.title);
                machine.runs.push_back(mill(parts.back(), machine.kind, options.runs));
            }
        }
    }
    print_estimates(machines);
    fmt::print("\n");
    print_control(parts, machines);
    return 0;
}

}  // namespace

void add_kinds(host::Command& program) {
    auto options = std::make_shared<KindsOptions>();
    host::Command command =
        program.subcommand("kinds", "Mill the same parts on several kinds of machines: what each kind gets");
    command.footer(
        "Prints two Markdown tables: what is known of the forces and of the cut, over all parts, and what the\n"
        "feed control makes of it. The plants are drawn as 'ensemble' draws them. Errors are root mean squares;\n"
        "those of forces are relative to the true ones in cut. Peak: of the tooth's force over its limit. Time:\n"
        "over that of the largest constant feed that is safe for a steel up to 30 % harder. A run that takes\n"
        "three times as long as that is given up.");
    command.option("scenarios", options->scenarios, "Parts to mill").required().value_name("SCENARIO.toml");
    command.option("--kind", options->kinds, "Kinds of machines").required().value_name("KIND.toml");
    command.option("--runs", options->runs, "Number of plants").within(1, 10000).shows_default();
    command.on_run([options] { return kinds(*options); });
}

}  // namespace millforce::sim
