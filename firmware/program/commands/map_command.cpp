// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "files/atomic_file.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/overwriting.hpp"
#include "map_page/map_page.hpp"
#include "parameters/parameter_files.hpp"
#include "part_map/map_join.hpp"
#include "part_map/part_map_file.hpp"

namespace millforce::host {

namespace {

struct JoinOptions {
    std::string geometry;
    std::string run;
    std::string tool;
    std::string output;
};

struct ShowOptions {
    std::string map;
    std::string tool;
    std::string output;
};

/// The tool's file, which must be the one that the map was made for.
firmware::ToolParameters<float> tool_of(const std::string& tool_file, const std::string& map_file,
                                        const MapOrigin& origin) {
    firmware::ToolParameters<float> tool = read_tool_parameters(tool_file);
    const std::string name = std::filesystem::path(tool_file).stem().string();
    MapOrigin of_tool = origin_of({}, name, tool);
    of_tool.program = origin.program;
    of_tool.program_crc32 = origin.program_crc32;
    require_same_origin(map_file, origin, of_tool);
    return tool;
}

void print_joined(const JoinOptions& options, const JoinedMap& joined) {
    fmt::print("{}: {:.0f} mm of cut compared", options.output, joined.compared_mm);
    if (joined.compared_mm > 0.0) {
        fmt::print("; hardness {:.2f} ± {:.2f} of the tool's file", joined.hardness, joined.hardness_sd);
    }
    if (joined.contacts > 0) {
        fmt::print("; {} first contacts {:+.1f} ± {:.1f} mm from geometry's", joined.contacts, joined.offset_mm,
                   joined.offset_sd_mm);
    }
    fmt::print("\n");
    for (const Contradiction& place : joined.contradictions) {
        fmt::print("line {}, path {:.1f} to {:.1f} mm: {}; taken as not known\n", place.line, place.begin_mm,
                   place.end_mm, place.what);
    }
}

int join(const JoinOptions& options) {
    const PartMapFile geometry = read_part_map(options.geometry);
    const PartMapFile run = read_part_map(options.run);
    require_same_origin(options.run, run.origin, geometry.origin);
    refuse_overwriting(options.output, {options.geometry, options.run, options.tool});
    const auto tool = tool_of(options.tool, options.geometry, geometry.origin);
    const JoinedMap result = joined(geometry.map, run.map, tool);
    write_part_map(options.output, {geometry.origin, result.map});
    print_joined(options, result);
    return 0;
}

int show(const ShowOptions& options) {
    const PartMapFile map = read_part_map(options.map);
    const auto tool = tool_of(options.tool, options.map, map.origin);
    refuse_overwriting(options.output, {options.map, options.tool});
    AtomicFile page(options.output);
    page.stream() << map_page_html(map, std::filesystem::path(options.map).filename().string(), tool);
    page.commit();
    fmt::print("page: {}\n", options.output);
    return 0;
}

}  // namespace

void add_map_commands(Command& program) {
    Command map = program.subcommand("map", "Join the part maps of geometry and of a run, or show one");
    map.requires_subcommand();

    auto join_options = std::make_shared<JoinOptions>();
    Command join_command =
        map.subcommand("join", "Correct the map of 'millforce preview' by the one that a run has left behind");
    join_command.footer(
        "Arcs come from geometry. Hardness, depth and the places of first contact are corrected by the run. Places "
        "where\n"
        "the two contradict each other beyond their doubt are named; the controller takes nothing from them.");
    join_command.option("geometry", join_options->geometry, "Part map of 'millforce preview'")
        .required()
        .value_name("GEOMETRY.map");
    join_command.option("run", join_options->run, "Part map of --learn").required().value_name("RUN.map");
    join_command.option("--tool", join_options->tool, "Tool file of both").required().value_name("TOOL.toml");
    join_command.option("-o,--output", join_options->output, "Part map to write").required().value_name("PART.map");
    join_command.on_run([join_options] { return join(*join_options); });

    auto show_options = std::make_shared<ShowOptions>();
    Command show_command = map.subcommand("show", "Write a page that shows a part map along its path");
    show_command.option("map", show_options->map, "Part map").required().value_name("PART.map");
    show_command.option("--tool", show_options->tool, "Tool file of the map: its law predicts the force")
        .required()
        .value_name("TOOL.toml");
    show_command.option("-o,--output", show_options->output, "Page to write").required().value_name("PAGE.html");
    show_command.on_run([show_options] { return show(*show_options); });
}

}  // namespace millforce::host
