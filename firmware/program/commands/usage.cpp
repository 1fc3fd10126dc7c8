// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "commands/usage.hpp"
#include "files/nearest_name.hpp"

namespace millforce::host {

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands(nullptr)) {
        names.push_back(command->get_name());
    }
    return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string joined(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) {
        list += (list.empty() ? "" : ", ") + name;
    }
    return list;
}

std::string unknown(const char* what, const std::string& name, const std::vector<std::string>& known) {
    const std::string nearest = nearest_name(name, known);
    return fmt::format("unknown {} '{}'; {}", what, name,
                       nearest.empty() ? "expected one of " + joined(known) : "did you mean " + nearest + "?");
}

/// Walks down the commands and returns the first command or option that does not exist.
std::string unknown_name(const CLI::App& program, int argc, const char* const* argv, std::string& command_path) {
    const CLI::App* app = &program;
    for (int k = 1; k < argc; ++k) {
        const std::string word = argv[k];
        const std::vector<std::string> commands = command_names(*app);
        if (word.starts_with("--")) {
            const std::string name = word.substr(0, word.find('='));
            if (!holds(option_names(*app), name)) {
                return unknown("option", name, option_names(*app));
            }
        } else if (holds(commands, word)) {
            app = app->get_subcommand(word);
            command_path += " " + word;
        } else if (!commands.empty() && !word.starts_with("-")) {
            return unknown("command", word, commands);
        }
    }
    const std::vector<std::string> commands = command_names(*app);
    return commands.empty() ? std::string() : "no command; expected one of " + joined(commands);
}

/// CLI11's messages may hold line breaks.
std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
    return text;
}

}  // namespace

std::string usage_error(const CLI::App& app, int argc, const char* const* argv, const std::string& message) {
    std::string command_path = app.get_name();
    const std::string name = unknown_name(app, argc, argv, command_path);
    return fmt::format("{} (see '{} --help')", one_line(name.empty() ? message : name), command_path);
}

}  // namespace millforce::host
