// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "daemon/service.hpp"
#include "gateway/gateway.hpp"

namespace millforce::host {

void add_gateway(Command& program) {
    auto file = std::make_shared<std::string>();
    Command command = program.subcommand("gateway", "Connect a controller to an MQTT broker, for many machines");
    command.footer(
        "Beside 'millforce run' or 'serve' with --gateway and --jobs. State and events go out; a job's report stays "
        "on\n"
        "the disk until the broker has it; tool files and part maps come in, and are kept where they are sound.\n"
        "Runs until SIGINT, SIGTERM or SIGHUP, with or without a broker.\n"
        "GATEWAY.toml, where `run` has --gateway GATEWAY.sock and --jobs JOBS:\n"
        "    machine = \"vmc1\"                # in the topics\n"
        "    telemetry_socket = \"GATEWAY.sock\"\n"
        "    jobs = \"JOBS\"\n"
        "    tools = \"TOOLS\"                 # may be left out, and so may maps\n"
        "    [broker]\n"
        "    host = \"broker.example\"\n"
        "    ca_file = \"/etc/ssl/certs/ca-certificates.crt\"\n"
        "    username = \"vmc1\"\n"
        "    password_file = \"/etc/millforce/mqtt_password\"");
    command.option("file", *file, "Broker, folders and the machine's name").required().value_name("GATEWAY.toml");
    command.on_run([file] {
        const std::atomic<bool>& stop = stop_on_signal();
        Gateway gateway(read_gateway_settings(*file));
        notify_service_manager("READY=1");
        gateway.run(stop);
        notify_service_manager("STOPPING=1");
        return 0;
    });
}

}  // namespace millforce::host
