// SPDX-License-Identifier: Apache-2.0
#include "commands/command_line.hpp"

#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "commands/usage.hpp"
#include "files/input_error.hpp"
#include "files/overwriting.hpp"
#include "parameters/tool_set.hpp"
#include "run_log/bus_clock.hpp"

namespace millforce::host {

namespace {

/// CLI11 pads by bytes: an option whose name or limits are not all ASCII would stand to the left.
class HelpFormatter : public CLI::Formatter {
  public:
    std::string make_option(const CLI::Option* option, bool is_positional) const override {
        const std::string name = "  " + make_option_name(option, is_positional) + make_option_opts(option);
        std::string line = CLI::Formatter::make_option(option, is_positional);
        if (name.size() < get_column_width()) {
            const auto is_continued = [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; };
            line.insert(name.size(), static_cast<std::size_t>(std::count_if(name.begin(), name.end(), is_continued)),
                        ' ');
        }
        return line;
    }
};

/// Whole numbers with all their digits.
std::string limit_text(double limit) {
    return limit == std::floor(limit) && std::abs(limit) < 1e10 ? fmt::format("{:.0f}", limit)
                                                                : fmt::format("{:g}", limit);
}

/// CLI::Range lets NaN pass.
CLI::Validator number_from(double low, double high) {
    const auto check = [low, high](const std::string& text) {
        double value = 0.0;
        const bool is_number = CLI::detail::lexical_cast(text, value);
        return is_number && value >= low && value <= high
                   ? std::string()
                   : fmt::format("{}: expected a number from {} to {}", text, limit_text(low), limit_text(high));
    };
    return CLI::Validator(check, fmt::format("{}…{}", limit_text(low), limit_text(high)));
}

std::string list_of(const std::vector<std::string>& words) {
    return fmt::format("{{{}}}", fmt::join(words, ","));
}

std::size_t place_of(const std::vector<std::string>& words, const std::string& text) {
    const std::string lower = CLI::detail::to_lower(text);
    return static_cast<std::size_t>(std::find(words.begin(), words.end(), lower) - words.begin());
}

bool is_same_name(const std::filesystem::path& one, const std::filesystem::path& other) {
    return std::filesystem::absolute(one).lexically_normal() == std::filesystem::absolute(other).lexically_normal();
}

/// Also of two files that are not there yet.
void check_output_files(const CLI::App& app, const std::vector<const CLI::Option*>& outputs) {
    for (const CLI::Option* output : outputs) {
        const std::string file = output->count() > 0 ? output->as<std::string>() : std::string();
        for (const CLI::Option* other : app.get_options()) {
            if (file.empty() || other == output || other->count() == 0) {
                continue;
            }
            const bool is_output = std::find(outputs.begin(), outputs.end(), other) != outputs.end();
            for (const std::string& name : other->results()) {
                if (is_output && is_same_name(file, name)) {
                    throw InputError(fmt::format("{}, {}: both are {}, expected two files", output->get_name(),
                                                 other->get_name(), file));
                }
                refuse_overwriting(file, {name});
            }
        }
    }
}

void set_common_rules(CLI::App& app, const std::string& version) {
    app.set_version_flag("--version", version, "Print the version and exit");
    app.formatter(std::make_shared<HelpFormatter>());
    app.get_formatter()->column_width(36);
    for (CLI::App* command : app.get_subcommands(nullptr)) {
        set_common_rules(*command, version);
    }
}

}  // namespace

Option& Option::required() {
    option_->required();
    return *this;
}

Option& Option::value_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}

Option& Option::within(double low, double high) {
    option_->check(number_from(low, high));
    return *this;
}

Option& Option::one_of(const std::vector<std::string>& names) {
    option_->type_name(list_of(names))->check(CLI::IsMember(names).description(""));
    return *this;
}

Option& Option::one_of_or(const std::vector<std::string>& names, const std::string& prefix, const std::string& shown) {
    std::vector<std::string> all = names;
    all.push_back(shown);
    const CLI::Validator is_member = CLI::IsMember(all);
    option_->type_name(list_of(all))->check([is_member, prefix](const std::string& value) {
        return value.starts_with(prefix) ? std::string() : is_member(value);
    });
    return *this;
}

Option& Option::shows_default() {
    option_->capture_default_str();
    return *this;
}

Option& Option::one_each_time() {
    option_->allow_extra_args(false);
    return *this;
}

Option& Option::needs(const Option& other) {
    option_->needs(other.option_);
    return *this;
}

Option& Option::excludes(const Option& other) {
    option_->excludes(other.option_);
    return *this;
}

Command Command::subcommand(const std::string& name, const std::string& description) {
    return {app_->add_subcommand(name, description), exit_code_};
}

Command& Command::footer(const std::string& text) {
    app_->footer(text);
    return *this;
}

Command& Command::requires_subcommand() {
    app_->require_subcommand(1);
    return *this;
}

template <typename T>
Option Command::option(const std::string& names, T& value, const std::string& help) {
    return Option(app_->add_option(names, value, help));
}

template Option Command::option(const std::string&, std::string&, const std::string&);
template Option Command::option(const std::string&, std::filesystem::path&, const std::string&);
template Option Command::option(const std::string&, double&, const std::string&);
template Option Command::option(const std::string&, int&, const std::string&);
template Option Command::option(const std::string&, std::uint32_t&, const std::string&);
template Option Command::option(const std::string&, std::uint64_t&, const std::string&);
template Option Command::option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option Command::option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::option(const std::string&, std::vector<std::uint32_t>&, const std::string&);
template Option Command::option(const std::string&, std::vector<std::filesystem::path>&, const std::string&);

template <typename Name>
Option Command::output_file(const std::string& names, Name& value, const std::string& help) {
    Option file = option(names, value, help);
    output_files_->push_back(file.option_);
    return file;
}

template Option Command::output_file(const std::string&, std::string&, const std::string&);
template Option Command::output_file(const std::string&, std::filesystem::path&, const std::string&);

Option Command::flag(const std::string& names, bool& value, const std::string& help) {
    return Option(app_->add_flag(names, value, help));
}

Option Command::named_choice(const std::string& names, const std::string& help, const std::vector<std::string>& words,
                             const std::function<void(std::size_t)>& chosen) {
    const std::string list = list_of(words);
    const auto check = [words, list](const std::string& text) {
        return place_of(words, text) < words.size() ? std::string() : fmt::format("{}: expected one of {}", text, list);
    };
    const auto take = [words, chosen](const std::string& text) { chosen(place_of(words, text)); };
    return Option(app_->add_option_function<std::string>(names, take, help)->type_name(list)->check(check));
}

void Command::on_run(std::function<int()> run) {
    app_->callback([app = app_, output_files = output_files_, run = std::move(run), exit_code = exit_code_] {
        check_output_files(*app, *output_files);
        *exit_code = run();
    });
}

void add_tools(Command& command, ToolChoice& tools) {
    command.option("--tool", tools.file, "Tool parameters").value_name("T.toml");
    command
        .option("--tools", tools.folder,
                "Folder of tool parameters T<number>.toml, in place of --tool: the CNC sends the tool's number")
        .value_name("FOLDER");
}

void add_bus_pace(Command& command, BusPace& pace) {
    const Option slow_motion =
        command
            .option("--slow-motion", pace.slow_motion,
                    "Time on the bus passes N times slower; give the same N to controller, plant and replay")
            .value_name("N")
            .within(1.0, largest_slowness);
    command
        .flag("--lock-step", pace.lock_step,
              "Time on the bus advances with SYNC, which waits for the drives; give it to controller, plant and replay")
        .excludes(slow_motion);
}

void add_report(Command& command, std::string& folder) {
    command
        .option("--report", folder,
                "Folder for report.html: engagement and forces, and which ceiling held the feed for how long")
        .value_name("DIR");
}

CommandLine::CommandLine(const std::string& name, const std::string& description, const std::string& version)
    : app_(std::make_unique<CLI::App>(description, name)), version_(version) {
    app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

Command CommandLine::root() {
    return {app_.get(), &exit_code_};
}

int CommandLine::run(int argc, const char* const* argv) {
    set_common_rules(*app_, version_);
    try {
        app_->parse(argc, argv);
        return exit_code_;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app_->exit(error);
        }
        fmt::print(stderr, "{}: {}\n", app_->get_name(), usage_error(*app_, argc, argv, error.what()));
        return 2;
    }
}

}  // namespace millforce::host
