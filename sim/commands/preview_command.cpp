// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/results_folder.hpp"
#include "loop/simulation.hpp"
#include "parameters/tool_set.hpp"
#include "part_map/part_map_file.hpp"
#include "preview/preview.hpp"

namespace millforce::sim {

namespace {

struct PreviewOptions {
    std::string part;
    std::string stock;
    host::ToolChoice tools{};
    std::vector<std::uint32_t> without_tools{};
    std::string output;
    double stock_tolerance_mm = 0.5;
    Interpreter interpreter = Interpreter::automatic;
};

Scenario part_of(const PreviewOptions& options) {
    const bool is_scenario = std::filesystem::path(options.part).extension() == ".toml";
    const host::ToolChoice& tools = options.tools;
    const bool has_tools = !tools.file.empty() || tools.is_folder();
    if (is_scenario && (!options.stock.empty() || has_tools)) {
        throw host::InputError(
            "--stock, --tool, --tools: a scenario names its own; leave them out, or give a part program");
    }
    if (!is_scenario && (options.stock.empty() || !has_tools)) {
        throw host::InputError(options.part + ": a part program needs --stock and --tool, or --tools");
    }
    if (!is_scenario) {
        tools.require_one();
    }
    if (!options.without_tools.empty() && !tools.is_folder()) {
        throw host::InputError("--without-tool: expected --tools with it");
    }
    Scenario scenario = is_scenario ? read_scenario(options.part)
                        : tools.is_folder()
                            ? read_part_of_tools(options.part, options.stock, host::read_tool_folder(tools.folder))
                            : read_part(options.part, options.stock, tools.file);
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

/// Returns the length of its cut.
double write_map(const std::string& output, const host::MapOrigin& origin, const host::PartMap& map) {
    host::write_part_map(output, {origin, map});
    const Summary summary = summary_of(map);
    fmt::print("{}: {:.0f} mm of path, {:.0f} mm of it in the cut, at most {:.2f} R wide and {:.2f} mm deep\n", output,
               summary.length_mm, summary.in_cut_mm, summary.widest_immersion, summary.deepest_mm);
    return summary.in_cut_mm;
}

double write_map_of_tool(const PreviewOptions& options, const Scenario& scenario) {
    const std::string name = std::filesystem::path(scenario.tool_file).stem().string();
    return write_map(options.output, host::origin_of(scenario.program_file, name, scenario.parameters.tool),
                     preview_within(scenario, options.stock_tolerance_mm));
}

/// T7.map, T12.map, … in the folder.
double write_maps_of_tools(const PreviewOptions& options, const Scenario& scenario) {
    const std::vector<host::NumberedTool> tools = host::read_tool_folder(options.tools.folder);
    for (const std::uint32_t number : options.without_tools) {
        if (std::ranges::find(tools, number, &host::NumberedTool::number) != tools.end()) {
            throw host::InputError(
                fmt::format("--without-tool {}: {} has its file, expected the number of another tool", number,
                            options.tools.folder));
        }
    }
    require_tools_of(scenario, options.without_tools);
    const std::filesystem::path folder = host::results_folder(options.output, "T1.map");
    const std::vector<MapOfTool> maps = preview_of_tools(scenario, options.stock_tolerance_mm);
    if (maps.empty()) {
        throw host::InputError(
            fmt::format("{}: it uses no tool of {}, expected an M6 with one", options.part, options.tools.folder));
    }
    double in_cut_mm = 0.0;
    for (const MapOfTool& of_tool : maps) {
        const auto tool = std::ranges::find(tools, of_tool.number, &host::NumberedTool::number);
        const std::string name = fmt::format("T{}", of_tool.number);
        in_cut_mm += write_map((folder / (name + ".map")).string(),
                               host::origin_of(scenario.program_file, name, tool->parameters), of_tool.map);
    }
    return in_cut_mm;
}

int write_preview(const PreviewOptions& options) {
    const Scenario scenario = part_of(options);
    for (const std::string& note : program_of(scenario).notes) {
        host::print_line(stderr, "millforce: note: " + note);
    }
    const double in_cut_mm = (options.tools.is_folder() ? write_maps_of_tools : write_map_of_tool)(options, scenario);
    if (!(in_cut_mm > 0.0)) {
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
        "PART is a part program with --stock and --tool, or a scenario (.toml), which names both. With --tools the\n"
        "program may change its tool by M6, and there is a map for each that it uses: T7.map, T12.map, … in a folder.\n"
        "The stock is the [stock] table of a TOML file: min_x_mm, min_y_mm, max_x_mm, max_y_mm, top_mm, cell_mm, the\n"
        "tool's start_x_mm, start_y_mm, start_z_mm, and [[stock.box]] and [[stock.drilled]], as in a scenario.");
    command.option("part", options->part, "Part program or scenario").required().value_name("PART");
    command.option("--stock", options->stock, "TOML file with a table [stock]").value_name("STOCK.toml");
    command.option("--tool", options->tools.file, "Tool file").value_name("TOOL.toml");
    command
        .option("--tools", options->tools.folder,
                "Folder of tool files T<number>.toml, in place of --tool: the program chooses by M6")
        .value_name("FOLDER");
    command
        .option(
            "--without-tool", options->without_tools,
            "Tool of the program that has no file, such as a drill: in the maps of the others its cut is left standing")
        .one_each_time()
        .value_name("NUMBER")
        .within(1.0, largest_tool);
    command.output_file("-o,--output", options->output, "Part map to write; with --tools the folder of the maps")
        .required()
        .value_name("PART.map");
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
