// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/start_check.hpp"
#include "check/unseen_faults.hpp"
#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "commands/map_options.hpp"
#include "commands/watch_options.hpp"
#include "control/cut_state.hpp"
#include "daemon/line_printer.hpp"
#include "daemon/pause_watch.hpp"
#include "daemon/service.hpp"
#include "daemon/unix_socket.hpp"
#include "files/console.hpp"
#include "files/input_error.hpp"
#include "firmware_link/link_controller.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/tool_set.hpp"
#include "run_report/run_report.hpp"
#include "socketcan/can_socket.hpp"

namespace millforce::host {

namespace {

struct ServeOptions {
    std::string socket;
    std::string machine;
    ToolChoice tools;
    double override_max = 1.0;
    MapOptions maps{};
    std::string report;
    WatchOptions watch{};
};

/// What the page of the run says besides its ticks.
class Notes {
  public:
    void add(std::string_view text) { of_page_.add(socketcan::monotonic_us(), text); }
    [[nodiscard]] RunNotes& of_page() { return of_page_; }

  private:
    RunNotes of_page_{};
};

/// Reports a fault as it comes and goes.
class FaultReporter {
  public:
    void follow(const hal::FeedOverride& output, LinePrinter& printer) {
        if (output.fault != fault_) {
            fault_ = output.fault;
            printer.print("millforce: fault: {}", control::name(static_cast<control::Fault>(fault_)));
        }
    }

  private:
    std::uint8_t fault_ = 0;
};

/// Reports when a part map is dropped.
void report_map(LiveMaps& maps, LinePrinter& printer, Notes& notes) {
    for (const std::string& map : maps.dropped()) {
        notes.add(fmt::format("The {} does not fit this cut: the run went on without it.", map));
        printer.print("millforce: the {} does not fit this cut: continuing without it", map);
    }
}

/// Reports which tool the override is for.
class ToolReporter {
  public:
    void follow(const firmware::LinkController& controller, LinePrinter& printer) {
        if (controller.is_tool_known() != is_known_ || controller.tool() != tool_) {
            is_known_ = controller.is_tool_known();
            tool_ = controller.tool();
            if (is_known_) {
                printer.print("millforce: tool {}", tool_);
            } else {
                printer.print("millforce: tool not known: the override is the operator's");
            }
        }
        if (controller.is_tool_change_due() && !was_change_due_) {
            printer.print("millforce: another tool number: the limits of tool {} hold until the axes rest", tool_);
        }
        was_change_due_ = controller.is_tool_change_due();
    }

  private:
    bool is_known_ = true;
    std::uint32_t tool_ = 0;
    bool was_change_due_ = false;
};

/// What the loop does at each turn beside the messages: it tells a service manager that it lives, and finds out that it
/// did not.
class Turns final : public TurnListener {
  public:
    Turns(LinePrinter& printer, Notes& notes) : printer_(printer), notes_(notes) {}

    void on_turn() override {
        const std::uint64_t now_us = socketcan::monotonic_us();
        watchdog_.poll(now_us);
        if (pause_watch_.look(now_us)) {
            hold_until_us_ = now_us + drain_us;
            notes_.add("This program was stopped for a while: the feed was held until newer samples came.");
            printer_.print("millforce: was stopped for {:.1f} s: hold, until newer samples come",
                           1e-6 * static_cast<double>(pause_watch_.pause_us()));
        }
        is_held_ = now_us < hold_until_us_;
    }
    /// What comes now may have waited while this process was stopped.
    [[nodiscard]] bool is_held() const { return is_held_; }

  private:
    /// Five waits. The CNC's side stops the feed long before.
    static constexpr std::uint64_t longest_turn_us = 500'000;
    /// The bridge hands over in this time what it kept: some hundred samples of 20 µs each.
    static constexpr std::uint64_t drain_us = 100'000;

    ServiceWatchdog watchdog_{};
    PauseWatch pause_watch_{longest_turn_us};
    LinePrinter& printer_;
    Notes& notes_;
    std::uint64_t hold_until_us_ = 0;
    bool is_held_ = false;
};

/// Hands each tick to whoever watches.
class TickWatcher {
  public:
    explicit TickWatcher(TelemetryFeed* feed) : feed_(feed) {}

    void follow(const firmware::LinkController& controller, bool was_stopped, bool is_map_refuted) {
        if (feed_ == nullptr) {
            return;
        }
        const std::uint32_t sample_us = controller.sample().time_us;
        time_us_ += has_time_ ? sample_us - last_us_ : 0;  // the sample's clock wraps
        last_us_ = sample_us;
        has_time_ = true;
        TelemetrySample sample{.monotonic_us = socketcan::monotonic_us(),
                               .tick = firmware::tick_record(controller.tick(), controller.output(), time_us_),
                               .tool = controller.tool(),
                               .is_held = controller.is_held(),
                               .drives = controller.sample(),
                               .program = controller.program()};
        sample.conditions.set(firmware::Condition::tool_unknown, !controller.is_tool_known());
        sample.conditions.set(firmware::Condition::tool_change_due, controller.is_tool_change_due());
        sample.conditions.set(firmware::Condition::process_paused, was_stopped);
        sample.conditions.set(firmware::Condition::map_refuted, is_map_refuted);
        feed_->put(sample);
    }

  private:
    TelemetryFeed* feed_;
    std::uint64_t time_us_ = 0;
    std::uint32_t last_us_ = 0;
    bool has_time_ = false;
};

void serve_peer(UnixServer& server, const Turns& turns, firmware::LinkController& controller, LiveMaps& maps,
                LinePrinter& printer, Notes& notes, TelemetryFeed* feed) {
    TickWatcher watcher(feed);
    FaultReporter faults;
    ToolReporter tools;
    while (server.has_peer()) {
        const auto bytes = server.receive();
        if (bytes.empty()) {
            return;
        }
        controller.hold_from_outside(turns.is_held());
        local_link::OverrideBytes answer{};
        const local_link::MessageError error = controller.on_message(bytes, answer);
        if (error != local_link::MessageError::none) {
            printer.print("millforce: invalid message of {} bytes ({}): connection closed", bytes.size(), name(error));
            notes.add("The CNC sent a message that is not valid: the connection was closed.");
            server.drop_peer();
            return;
        }
        server.send(answer);
        watcher.follow(controller, turns.is_held(), maps.is_refuted());
        firmware::finish_work(controller);
        faults.follow(controller.output(), printer);
        tools.follow(controller, printer);
        report_map(maps, printer, notes);
    }
}

int serve(const ServeOptions& options) {
    options.tools.require_one();
    const auto largest_override = static_cast<float>(options.override_max);
    const ToolSet tools(firmware::capped(read_machine_parameters(options.machine), largest_override), options.tools);
    const firmware::Parameters<float>& parameters = tools.parameters();
    show_start_check(tools);
    LiveMaps maps(options.maps, options.tools, tools);
    const auto report =
        started_report({RunKind::serve, options.socket, options.machine, options.tools, options.report}, tools);
    Notes notes;
    LinePrinter printer(stderr);
    Turns turns(printer, notes);
    UnixServer server(options.socket, &turns);
    const auto hub =
        watch(options.watch, tools, options.socket, recorder_of(report.get(), notes.of_page(), RunClock::monotonic));
    for (const std::string& note : become_real_time()) {
        printer.print("millforce: note: {}", note);
    }
    notify_service_manager("READY=1");
    printer.print("millforce: {}: waiting", options.socket);
    notify_service_manager("STATUS=waiting for a CNC");
    for (const std::string& fault : unseen_faults(parameters)) {
        printer.print("millforce: not seen here: {}", fault);
    }
    while (server.wait_for_peer()) {
        notify_service_manager("STATUS=connected");
        printer.print("millforce: connected");
        notes.add("The CNC connected.");
        auto controller =
            std::make_unique<firmware::LinkController>(parameters, largest_override, maps.begin(), tools.source());
        serve_peer(server, turns, *controller, maps, printer, notes, hub->feed());
        server.drop_peer();
        notes.add("The CNC disconnected.");
        notify_service_manager("STATUS=waiting for a CNC");
        printer.print("millforce: disconnected after {} samples", controller->output().heartbeat);
    }
    notify_service_manager("STOPPING=1");
    notify_service_manager(time_for_the_report);
    leave_real_time();
    hub->finish();
    const bool is_learnt = maps.finish();
    const bool is_reported = finish_report(report.get(), stderr);
    return is_reported && is_learnt && hub->failed_file().empty() ? 0 : 1;
}

}  // namespace

void add_serve(Command& program) {
    auto options = std::make_shared<ServeOptions>();
    Command command =
        program.subcommand("serve", "Run the live controller behind a Unix socket, for a CNC on the same computer");
    command.footer(
        "Layout of the messages: drivers/local_link. LinuxCNC connects by millforce-hal (drivers/linuxcnc).\n"
        "With --tools the samples hold the tool's number; without a known tool the override is the operator's.\n"
        "One connection at a time; each is a new run. Runs until SIGINT, SIGTERM or SIGHUP.");
    command.option("socket", options->socket, "Path of the socket to create").required().value_name("SOCKET");
    command.option("--machine", options->machine, "Machine parameters").required().value_name("M.toml");
    add_tools(command, options->tools);
    command
        .option("--override-max", options->override_max,
                "Largest override that the CNC accepts; 1: LinuxCNC's adaptive feed")
        .within(0.0, 10.0)
        .shows_default();
    add_map(command, options->maps);
    add_report(command, options->report);
    add_watch(command, options->watch);
    command.on_run([options] { return serve(*options); });
}

}  // namespace millforce::host
