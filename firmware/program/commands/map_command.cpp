// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands/can_interface.hpp"
#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "daemon/service.hpp"
#include "files/atomic_file.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "map_page/map_page.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/tool_set.hpp"
#include "part_map/map_join.hpp"
#include "part_map/map_sender.hpp"
#include "part_map/numbered_maps.hpp"
#include "part_map/part_map_file.hpp"
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
    std::vector<std::string> maps;
    ToolChoice tools;
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
    const auto tool = tool_of(options.tool, options.geometry, geometry.origin);
    const JoinedMap result = joined(geometry.map, run.map, tool);
    if (result.hardness < least_hardness || result.hardness > largest_hardness) {
        throw InputError(fmt::format(
            "{}: its forces are {:.3g} times those of {} by the law of {}; expected {} to {}. Is "
            "it of the same part and tool?",
            options.run, result.hardness, options.geometry, options.tool, least_hardness, largest_hardness));
    }
    write_part_map(options.output, {geometry.origin, result.map});
    print_joined(options, result);
    return 0;
}

int show(const ShowOptions& options) {
    const PartMapFile map = read_part_map(options.map);
    const auto tool = tool_of(options.tool, options.map, map.origin);
    AtomicFile page(options.output);
    page.stream() << map_page_html(map, std::filesystem::path(options.map).filename().string(), tool);
    page.commit();
    fmt::print("page: {}\n", options.output);
    return 0;
}

socketcan::CanSocketSettings socket_of(const SendOptions& options, const WaySenderSettings& sender,
                                       std::uint32_t program_status_id) {
    socketcan::CanSocketSettings settings = socket_on(options.interface);
    settings.filters[0].id = sender.position_id;
    settings.filters[1].id = way_window::way_answer_id(sender.node_id);
    settings.filters[2].id = program_status::tool_frame_id(program_status_id);
    settings.filter_count = 3;
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

/// How long the path of a map is, and of how many records it is made.
void print_map(const std::string& name, const PartMapFile& file, const firmware::Parameters<float>& parameters,
               std::uint32_t tool, std::uint8_t node_id) {
    fmt::print("{}: {} records, {:.1f} mm, to node {}{}\n", name, way_records(file.map, parameters).size(),
               file.map.back().path_mm, node_id, tool == 0 ? "" : fmt::format(", with T{}", tool));
}

void add_map_of_tool(MapSender& sender, const SendOptions& options, const firmware::MachineParameters<float>& machine,
                     std::uint8_t node_id) {
    if (options.maps.size() > 1) {
        throw InputError(fmt::format("--tool: {} maps, expected one, or --tools", options.maps.size()));
    }
    const std::string& name = options.maps.front();
    const PartMapFile file = read_part_map(name);
    const firmware::Parameters<float> parameters{machine, tool_of(options.tools.file, name, file.origin)};
    sender.add(file.map, parameters);
    print_map(name, file, parameters, 0, node_id);
}

void add_maps_by_number(MapSender& sender, const SendOptions& options,
                        const firmware::MachineParameters<float>& machine, std::uint8_t node_id) {
    const std::vector<NumberedTool> tools = read_tool_folder(options.tools.folder);
    for (const std::string& name : options.maps) {
        const PartMapFile file = read_part_map(name);
        const std::uint32_t number = number_of_map(name, file.origin, options.tools.folder, tools);
        const auto tool = std::find_if(tools.begin(), tools.end(),
                                       [number](const NumberedTool& other) { return other.number == number; });
        const firmware::Parameters<float> parameters{machine, tool->parameters};
        if (!sender.add(number, file.map, parameters)) {
            throw InputError(fmt::format("{}: a second map for T{}, expected one for each tool", name, number));
        }
        print_map(name, file, parameters, number, node_id);
    }
}

/// What the controller says of the map, and which tool has none, each where it changes.
class SendReporter {
  public:
    explicit SendReporter(std::string interface) : interface_(std::move(interface)) {}

    void follow(const MapSender& sender, std::uint64_t now_us) {
        const bool has_map = sender.sender() != nullptr;
        if (has_map != had_map_ || sender.tool() != tool_) {
            had_map_ = has_map;
            tool_ = sender.tool();
            last_.reset();
            print(tool_ == 0 ? std::string("the CNC tells no tool")
                             : fmt::format("T{}{}", tool_, has_map ? "" : ": there is no map for it"));
        }
        const auto state = has_map ? sender.sender()->controller_state(now_us) : std::nullopt;
        if (is_news(last_, state)) {
            print(text_of(state));
            last_ = state;
        }
    }
    [[nodiscard]] std::optional<way_window::WayState> last() const { return last_; }

  private:
    void print(const std::string& text) const {
        fmt::print("{}: {}\n", interface_, text);
        std::fflush(stdout);
    }

    std::string interface_;
    bool had_map_ = true;
    std::uint32_t tool_ = 0;
    std::optional<way_window::WayState> last_{};
};

int send(const SendOptions& options) {
    options.tools.require_one();
    const firmware::MachineParameters<float> machine = read_machine_parameters(options.machine);
    const WaySenderSettings settings = sender_settings(options, machine.bus);
    MapSender sender(settings, machine.bus.program_status_id);
    const std::atomic<bool>& stop = stop_on_signal();
    (options.tools.is_folder() ? add_maps_by_number : add_map_of_tool)(sender, options, machine, settings.node_id);
    std::fflush(stdout);
    socketcan::CanSocket socket(socket_of(options, settings, machine.bus.program_status_id));
    SendReporter reporter(options.interface);
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
        reporter.follow(sender, now_us);
    }
    fmt::print("{}: {} frames sent, {} not sent; the map was begun {} times\n", options.interface, socket.health().sent,
               socket.health().send_failures, sender.sessions());
    const auto last = reporter.last();
    return last && *last == way_window::WayState::takes ? 0 : 1;
}

void add_send(Command& map) {
    auto options = std::make_shared<SendOptions>();
    Command command = map.subcommand("send", "Hand a part map to a controller without files, over CAN");
    command.footer(
        "For a controller on a chip ('millforce run' takes --map). Runs beside it until SIGINT, SIGTERM or SIGHUP. It\n"
        "hands over 64 stretches and 64 blocks ahead of the tool, and begins where the tool is. The CNC must send its\n"
        "position frame. What the controller says of the map is printed when it changes.\n"
        "With --tools there is a map for each tool, and the CNC's tool frame says whose is handed over. A map belongs "
        "to\n"
        "the tool of its name (T7), else to the only one of the folder that has its geometry.\n"
        "Exit code 1: at the end the controller was silent, or did not use the map.");
    command.option("interface", options->interface, "CAN interface, e.g. can0").required().value_name("IFACE");
    command.option("maps", options->maps, "Part map; with --tools one for each tool").required().value_name("PART.map");
    add_tools(command, options->tools);
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
    join_command.output_file("-o,--output", join_options->output, "Part map to write")
        .required()
        .value_name("PART.map");
    join_command.on_run([join_options] { return join(*join_options); });

    auto show_options = std::make_shared<ShowOptions>();
    Command show_command = map.subcommand("show", "Write a page that shows a part map along its path");
    show_command.option("map", show_options->map, "Part map").required().value_name("PART.map");
    show_command.option("--tool", show_options->tool, "Tool file of the map: its law predicts the force")
        .required()
        .value_name("TOOL.toml");
    show_command.output_file("-o,--output", show_options->output, "Page to write").required().value_name("PAGE.html");
    show_command.on_run([show_options] { return show(*show_options); });

    add_send(map);
}

}  // namespace millforce::host
