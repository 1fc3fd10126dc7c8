// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <memory>
#include <string>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "control/cut_state.hpp"
#include "daemon/service.hpp"
#include "daemon/unix_socket.hpp"
#include "files/console.hpp"
#include "files/parameter_files.hpp"
#include "files/parameter_notes.hpp"
#include "firmware_link/link_controller.hpp"

namespace millforce::host {

namespace {

struct ServeOptions {
    std::string socket;
    std::string machine;
    std::string tool;
    double override_max = 1.0;
};

/// Tells of a fault as it comes and goes.
class FaultTeller {
  public:
    void follow(const hal::FeedOverride& output) {
        if (output.fault != fault_) {
            fault_ = output.fault;
            print_line(stderr, fmt::format("millforce: fault: {}", control::name(static_cast<control::Fault>(fault_))));
        }
    }

  private:
    std::uint8_t fault_ = 0;
};

void serve_peer(UnixServer& server, firmware::LinkController& controller) {
    FaultTeller faults;
    while (server.has_peer()) {
        const auto bytes = server.receive();
        if (bytes.empty()) {
            return;
        }
        local_link::OverrideBytes answer{};
        const local_link::MessageError error = controller.on_message(bytes, answer);
        if (error != local_link::MessageError::none) {
            print_line(stderr, fmt::format("millforce: invalid message of {} bytes ({}): connection closed",
                                           bytes.size(), name(error)));
            server.drop_peer();
            return;
        }
        server.send(answer);
        firmware::finish_work(controller);
        faults.follow(controller.output());
    }
}

int serve(const ServeOptions& options) {
    const auto parameters = read_parameters(options.machine, options.tool);
    tell_parameter_notes(parameters);
    ignore_closed_pipes();
    UnixServer server(options.socket);
    for (const std::string& note : become_real_time()) {
        print_line(stderr, fmt::format("millforce: note: {}", note));
    }
    notify_service_manager("READY=1");
    print_line(stderr, fmt::format("millforce: {}: waiting", options.socket));
    while (server.wait_for_peer()) {
        print_line(stderr, "millforce: connected");
        auto controller =
            std::make_unique<firmware::LinkController>(parameters, static_cast<float>(options.override_max));
        serve_peer(server, *controller);
        server.drop_peer();
        print_line(stderr, fmt::format("millforce: disconnected after {} samples", controller->output().heartbeat));
    }
    return 0;
}

}  // namespace

void add_serve(Command& program) {
    auto options = std::make_shared<ServeOptions>();
    Command command =
        program.subcommand("serve", "Run the live controller behind a Unix socket, for a CNC on the same computer");
    command.footer(
        "Layout of the messages: drivers/local_link. LinuxCNC connects by millforce-hal (drivers/linuxcnc).\n"
        "One connection at a time; each is a new run. Runs until SIGINT or SIGTERM.");
    command.option("socket", options->socket, "Path of the socket to create").required().value_name("SOCKET");
    command.option("--machine", options->machine, "Machine parameters").required().value_name("M.toml");
    command.option("--tool", options->tool, "Tool parameters").required().value_name("T.toml");
    command
        .option("--override-max", options->override_max,
                "Largest override that the CNC accepts; 1: LinuxCNC's adaptive feed")
        .within(0.0, 10.0)
        .shows_default();
    command.on_run([options] { return serve(*options); });
}

}  // namespace millforce::host
