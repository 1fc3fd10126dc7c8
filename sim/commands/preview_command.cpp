// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "loop/simulation.hpp"
#include "part_map/part_map_file.hpp"
#include "preview/preview.hpp"

namespace millforce::sim {

namespace {

struct PreviewOptions {
    std::string part;
    std::string stock;
    std::string tool;
    std::string output;
    double stock_tolerance_mm = 0.5;
    Interpreter interpreter = Interpreter::automatic;
};

Scenario part_of(const PreviewOptions& options) {
    const bool is_scenario = std::filesystem::path(options.part).extension() == ".toml";
    if (is_scenario && (!options.stock.empty() || !options.tool.empty())) {
        throw host::InputError("--stock, --tool: a scenario names its own; leave them out, or give a part program");
    }
    if (!is_scenario && (options.stock.empty() || options.tool.empty())) {
        throw host::InputError(options.part + ": a part program needs --stock and --tool");
    }
    Scenario scenario =
        is_scenario ? read_scenario(options.part) : read_part(options.part, options.stock, options.tool);
    scenario.interpreter = options.interpreter;
    return scenario;
}

struct Summary {
    double length_mm = 0.0;
    double in_cut_mm = 0.0;
    double deepest_mm = 0.0;
    double widest_immersion = 0.0;
};

Summary summary_of(const host::PartMap& map) {
    Summary summary;
    summary.length_mm = map.back().path_mm;
    for (std::size_t k = 0; k + 1 < map.size(); ++k) {
        double immersion = 0.0;
        for (const host::EngagedArc& arc : map[k].cut) {
            immersion += std::cos(arc.entry_rad) - std::cos(arc.exit_rad);
            summary.deepest_mm = std::max(summary.deepest_mm, arc.axial_depth_mm);
        }
        summary.widest_immersion = std::max(summary.widest_immersion, immersion);
        summary.in_cut_mm += map[k].cut.empty() ? 0.0 : map[k + 1].path_mm - map[k].path_mm;
    }
    return summary;
}

int write_preview(const PreviewOptions& options) {
    const Scenario scenario = part_of(options);
    for (const std::string& note : program_of(scenario).notes) {
        host::print_line(stderr, "millforce: note: " + note);
    }
    host::PartMapFile file;
    file.origin = host::origin_of(scenario.program_file, std::filesystem::path(scenario.tool_file).stem().string(),
                                  scenario.parameters.tool);
    file.map = preview_within(scenario, options.stock_tolerance_mm);
    host::write_part_map(options.output, file);
    const Summary summary = summary_of(file.map);
    fmt::print("{}: {:.0f} mm of path, {:.0f} mm of it in the cut, at most {:.2f} R wide and {:.2f} mm deep\n",
               options.output, summary.length_mm, summary.in_cut_mm, summary.widest_immersion, summary.deepest_mm);
    if (!(summary.in_cut_mm > 0.0)) {
        host::print_line(
            stderr, "millforce: note: the tool meets no stock on its way: do zero point and stock belong together?");
    }
    return 0;
}

}  // namespace

void add_preview(host::Command& program) {
    auto options = std::make_shared<PreviewOptions>();
    host::Command command = program.subcommand(
        "preview",
        "Work out what the tool will meet along a part program: the part map that the controller looks ahead with");
    command.footer(
        "PART is a part program with --stock and --tool, or a scenario (.toml), which names both.\n"
        "The stock is the [stock] table of a TOML file: min_x_mm, min_y_mm, max_x_mm, max_y_mm, top_mm, cell_mm, the\n"
        "tool's start_x_mm, start_y_mm, start_z_mm, and [[stock.box]] and [[stock.drilled]], as in a scenario.");
    command.option("part", options->part, "Part program or scenario").required().value_name("PART");
    command.option("--stock", options->stock, "TOML file with a table [stock]").value_name("STOCK.toml");
    command.option("--tool", options->tool, "Tool file").value_name("TOOL.toml");
    command.option("-o,--output", options->output, "Part map to write").required().value_name("PART.map");
    command
        .option("--stock-tolerance", options->stock_tolerance_mm,
                "By how much the blank may lie off in x and in y, in mm; the map is for all places within")
        .value_name("MM")
        .within(0.0, 10.0)
        .shows_default();
    command.choice<Interpreter>(
        "--interpreter", options->interpreter,
        "Reader of the part program: own, LinuxCNC's rs274, or auto (own, then rs274)",
        {{"auto", Interpreter::automatic}, {"own", Interpreter::own}, {"rs274", Interpreter::rs274}});
    command.on_run([options] { return write_preview(*options); });
}

}  // namespace millforce::sim
