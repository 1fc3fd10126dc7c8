// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The command line of `millforce`, built on CLI11. Only two source files include CLI11 itself: it takes 10 s to
/// compile.

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace millforce::host {

struct BusPace;
struct ToolChoice;

/// One option or positional argument, as returned by Command. Refers to its program; cheap to copy.
class Option {
  public:
    Option& required();
    /// What `--help` shows in place of the type, e.g. "M.toml".
    Option& value_name(const std::string& name);
    /// A finite number from `low` to `high`.
    Option& within(double low, double high);
    Option& one_of(const std::vector<std::string>& names);
    /// Or a text that begins with `prefix`, as "socket:PATH": `--help` shows the latter.
    Option& one_of_or(const std::vector<std::string>& names, const std::string& prefix, const std::string& shown);
    /// `--help` shows the variable's present value as the default.
    Option& shows_default();
    /// Of a list: each time one value; what follows is another option's.
    Option& one_each_time();
    Option& needs(const Option& other);
    Option& excludes(const Option& other);

  private:
    friend class Command;
    explicit Option(CLI::Option* option) : option_(option) {}
    CLI::Option* option_;
};

/// A command, to which options and subcommands are added. The variables must live until the program has
/// run. Refers to its program; cheap to copy.
class Command {
  public:
    Command subcommand(const std::string& name, const std::string& description);
    /// Text below the options in `--help`.
    Command& footer(const std::string& text);
    /// One of the subcommands must be given.
    Command& requires_subcommand();

    /// `names`: "--long", "-s,--long", or a bare word for a positional argument.
    template <typename T>
    Option option(const std::string& names, T& value, const std::string& help);
    /// A file to write: refused where it is a file of another option, by whatever name or link, or stands as *.toml in
    /// the folder of one.
    template <typename Name>
    Option output_file(const std::string& names, Name& value, const std::string& help);
    Option flag(const std::string& names, bool& value, const std::string& help);

    /// An option that takes one of several names, each for a value of T (an enumeration). Upper or lower case.
    template <typename T, typename Target>
    Option choice(const std::string& names, Target& value, const std::string& help,
                  std::initializer_list<std::pair<const char*, T>> choices) {
        std::vector<std::string> words;
        std::vector<T> values;
        for (const auto& [word, choice] : choices) {
            words.emplace_back(word);
            values.push_back(choice);
        }
        return named_choice(names, help, words, [&value, values](std::size_t index) { value = values[index]; });
    }

    /// Where this command is chosen, `run` is called and returns the program's exit code: 0 done; 1 done, and a stated
    /// bound does not hold. Bad input throws InputError (code 2). It owns the option variables (a shared_ptr in its
    /// capture), so that they live as long as the program.
    void on_run(std::function<int()> run);

  private:
    friend class CommandLine;
    Command(CLI::App* app, int* exit_code)
        : app_(app), exit_code_(exit_code), output_files_(std::make_shared<std::vector<const CLI::Option*>>()) {}
    Option named_choice(const std::string& names, const std::string& help, const std::vector<std::string>& words,
                        const std::function<void(std::size_t)>& chosen);

    CLI::App* app_;
    int* exit_code_;
    std::shared_ptr<std::vector<const CLI::Option*>> output_files_;  ///< one list for all copies
};

extern template Option Command::option(const std::string&, std::string&, const std::string&);
extern template Option Command::option(const std::string&, std::filesystem::path&, const std::string&);
extern template Option Command::option(const std::string&, double&, const std::string&);
extern template Option Command::option(const std::string&, int&, const std::string&);
extern template Option Command::option(const std::string&, std::uint32_t&, const std::string&);
extern template Option Command::option(const std::string&, std::uint64_t&, const std::string&);
extern template Option Command::option(const std::string&, std::optional<double>&, const std::string&);
extern template Option Command::option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
extern template Option Command::option(const std::string&, std::vector<std::string>&, const std::string&);
extern template Option Command::option(const std::string&, std::vector<std::uint32_t>&, const std::string&);
extern template Option Command::option(const std::string&, std::vector<std::filesystem::path>&, const std::string&);
extern template Option Command::output_file(const std::string&, std::string&, const std::string&);
extern template Option Command::output_file(const std::string&, std::filesystem::path&, const std::string&);

/// --tool and --tools, of which one must be given: ToolChoice::require_one().
void add_tools(Command& command, ToolChoice& tools);

/// --slow-motion and --lock-step, of the commands on a bus.
void add_bus_pace(Command& command, BusPace& pace);

/// --report, of the commands that run the tick.
void add_report(Command& command, std::string& folder);

/// The program with its commands.
class CommandLine {
  public:
    CommandLine(const std::string& name, const std::string& description, const std::string& version);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    [[nodiscard]] Command root();
    /// Parses and runs. Returns the exit code; bad usage is one line on standard error and 2.
    [[nodiscard]] int run(int argc, const char* const* argv);

  private:
    std::unique_ptr<CLI::App> app_;
    std::string version_;
    int exit_code_ = 0;
};

}  // namespace millforce::host
