// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace millforce::host {

/// `--version` for the program and every subcommand, and the rules that all of them share.
void set_common_rules(CLI::App& app, const std::string& version);

/// Checks that an option is a finite number within [low, high]. CLI::Range lets NaN pass.
CLI::Validator number_from(double low, double high);

/// --slow-motion and --lock-step, of the commands on a bus.
struct BusPace {
    std::uint32_t slow_motion = 1;
    bool lock_step = false;
};
void add_bus_pace(CLI::App& command, BusPace& pace);

/// The one line that says what is wrong with the command line: the message of CLI11, with the nearest name of an
/// unknown command or option.
std::string usage_error(const CLI::App& app, int argc, const char* const* argv, const std::string& message);

}  // namespace millforce::host
