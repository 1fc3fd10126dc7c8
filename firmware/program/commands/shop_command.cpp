// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>

#include "commands/command_line.hpp"
#include "commands/machine_commands.hpp"
#include "daemon/service.hpp"
#include "files/console.hpp"
#include "shop/shop.hpp"

namespace millforce::host {

namespace {

struct ShopOptions {
    std::string file;
    std::uint64_t port = 0;
};

}  // namespace

void add_shop(Command& program) {
    auto options = std::make_shared<ShopOptions>();
    Command command = program.subcommand("shop", "Show all machines of a shop on one page, from an MQTT broker");
    command.footer(
        "Shows what each machine's 'millforce gateway' reports: connection, state, load, engagement, events, jobs.\n"
        "The page is on this computer alone (127.0.0.1 and ::1). Runs until SIGINT, SIGTERM or SIGHUP, with or without "
        "a broker.\n"
        "SHOP.toml has the table [broker] alone:\n"
        "    [broker]\n"
        "    host = \"broker.example\"\n"
        "    ca_file = \"/etc/ssl/certs/ca-certificates.crt\"\n"
        "    username = \"shop\"\n"
        "    password_file = \"/etc/millforce/mqtt_password\"");
    command.option("file", options->file, "Address of the broker").required().value_name("SHOP.toml");
    command.option("--web", options->port, "Port of the page; 0: any free port")
        .value_name("PORT")
        .within(0, UINT16_MAX)
        .shows_default();
    command.on_run([options] {
        const std::atomic<bool>& stop = stop_on_signal();
        Shop shop(read_shop_settings(options->file), static_cast<std::uint16_t>(options->port));
        print_line(stderr, fmt::format("millforce: the page is at http://127.0.0.1:{}/", shop.port()));
        notify_service_manager("READY=1");
        shop.run(stop);
        notify_service_manager("STOPPING=1");
        return 0;
    });
}

}  // namespace millforce::host
