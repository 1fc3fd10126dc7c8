// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "commands/can_interface.hpp"
#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "daemon/service.hpp"
#include "files/atomic_file.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "files/overwriting.hpp"
#include "map_page/map_page.hpp"
#include "parameters/parameter_files.hpp"
#include "part_map/map_join.hpp"
#include "part_map/part_map_file.hpp"
#include "part_map/way_sender.hpp"
#include "socketcan/can_socket.hpp"

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

struct SendOptions {
    std::string interface;
    std::string map;
    std::string tool;
    std::string machine;
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

socketcan::CanSocketSettings socket_of(const SendOptions& options, const WaySenderSettings& sender) {
    socketcan::CanSocketSettings settings = socket_on(options.interface);
    settings.filters[0].id = sender.position_id;
    settings.filters[1].id = way_window::way_answer_id(sender.node_id);
    settings.filter_count = 2;
    return settings;
}

WaySenderSettings sender_settings(const SendOptions& options, const firmware::BusParameters<float>& bus) {
    const std::uint32_t position_id = program_status::position_frame_id(bus.program_status_id);
    if (position_id == 0) {
        throw InputError(
            fmt::format("{}: bus.program_status_id = {}, expected 1 to {}: the frame of the position in the program is "
                        "that id + 0x200",
                        options.machine, bus.program_status_id, hal::largest_standard_can_id - 0x200));
    }
    return {.node_id = bus.override_node_id, .position_id = position_id};
}

std::string text_of(std::optional<way_window::WayState> state) {
    if (!state) {
        return "the controller is silent";
    }
    switch (*state) {
        case way_window::WayState::waits:
            return "the controller has no map yet";
        case way_window::WayState::takes:
            return "the controller takes the map";
        case way_window::WayState::other_tool:
            return "refused: the controller's tool has other parameters than the tool file";
        case way_window::WayState::other_layout:
            return "refused: the controller knows another version of the frames";
        case way_window::WayState::unsound_record:
            return "refused: the controller took a record for wrong";
        case way_window::WayState::refuted:
            return "the map does not fit the cut: the controller goes on without it";
    }
    return "";
}

/// A controller that has lost a session has another a moment later: that is no news.
bool is_news(std::optional<way_window::WayState> last, std::optional<way_window::WayState> now) {
    return now != last && now != way_window::WayState::waits;
}

int send(const SendOptions& options) {
    const PartMapFile file = read_part_map(options.map);
    const auto tool = tool_of(options.tool, options.map, file.origin);
    const firmware::Parameters<float> parameters{read_machine_parameters(options.machine), tool};
    const WaySenderSettings settings = sender_settings(options, parameters.machine.bus);
    socketcan::CanSocket socket(socket_of(options, settings));
    WaySender sender(settings, file.map, parameters);
    const std::atomic<bool>& stop = stop_on_signal();
    fmt::print("{}: {} records, {:.1f} mm, to node {}\n", options.map, sender.record_count(), file.map.back().path_mm,
               settings.node_id);
    std::fflush(stdout);
    std::optional<way_window::WayState> last;
    while (!stop.load(std::memory_order_relaxed)) {
        socket.wait(settings.frame_period_us);
        const std::uint64_t now_us = socketcan::monotonic_us();
        socket.poll(now_us);
        socketcan::ReceivedFrame received;
        while (socket.receive(received)) {
            sender.on_frame(received.frame, received.time_us);
        }
        sender.poll(now_us);
        hal::CanFrame frame;
        while (sender.take_frame(frame)) {
            socket.send(frame);
        }
        const auto state = sender.controller_state(now_us);
        if (is_news(last, state)) {
            fmt::print("{}: {}\n", options.interface, text_of(state));
            std::fflush(stdout);
            last = state;
        }
    }
    fmt::print("{}: {} frames sent, {} not sent; the map was begun {} times\n", options.interface, socket.health().sent,
               socket.health().send_failures, sender.sessions());
    return last && *last == way_window::WayState::takes ? 0 : 1;
}

void add_send(Command& map) {
    auto options = std::make_shared<SendOptions>();
    Command command = map.subcommand("send", "Hand a part map to a controller without files, over CAN");
    command.footer(
        "For a controller on a chip ('millforce run' takes --map). Runs beside it until SIGINT, SIGTERM or SIGHUP. It\n"
        "hands over 64 stretches and 64 blocks ahead of the tool, and begins where the tool is. The CNC must send its\n"
        "position frame. What the controller says of the map is printed when it changes.\n"
        "Exit code 1: at the end the controller was silent, or did not use the map.");
    command.option("interface", options->interface, "CAN interface, e.g. can0").required().value_name("IFACE");
    command.option("map", options->map, "Part map").required().value_name("PART.map");
    command.option("--tool", options->tool, "Tool file of the map, as the controller has it")
        .required()
        .value_name("TOOL.toml");
    command.option("--machine", options->machine, "Machine parameters, as the controller has them")
        .required()
        .value_name("M.toml");
    command.on_run([options] { return send(*options); });
}

}  // namespace

void add_map_commands(Command& program) {
    Command map = program.subcommand("map", "Join the part maps of geometry and of a run, show one, or send it");
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

    add_send(map);
}

}  // namespace millforce::host
