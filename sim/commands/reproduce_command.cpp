// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/progress.hpp"
#include "files/results_folder.hpp"
#include "reproduce/papers.hpp"
#include "reproduce_report/reproduction_json.hpp"
#include "reproduce_report/reproduction_page.hpp"
#include "reproduce_report/reproduction_text.hpp"

namespace millforce::sim {

namespace {

struct ReproduceOptions {
    std::string paper = "all";
    std::string out = "out/reproduce";
    bool verbose = false;
};

constexpr const char* page_file = "reproduce.html";

std::vector<std::string> paper_names() {
    std::vector<std::string> names;
    for (const Paper& paper : papers()) {
        names.emplace_back(paper.name);
    }
    names.emplace_back("all");
    return names;
}

std::string joined_names(const char* separator) {
    return fmt::format("{}", fmt::join(paper_names(), separator));
}

std::vector<Paper> chosen_papers(const std::string& name) {
    std::vector<Paper> chosen;
    std::copy_if(papers().begin(), papers().end(), std::back_inserter(chosen),
                 [&](const Paper& paper) { return name == "all" || name == paper.name; });
    if (chosen.empty()) {
        const std::string nearest = host::nearest_name(name, paper_names());
        throw host::InputError(fmt::format(
            "unknown paper '{}'; {}", name,
            nearest.empty() ? "expected one of " + joined_names(", ") : fmt::format("did you mean {}?", nearest)));
    }
    return chosen;
}

std::vector<Reproduction> reproduce_watched(const std::vector<Paper>& chosen) {
    host::Progress progress("reproducing");
    const auto start = std::chrono::steady_clock::now();
    return reproduce(chosen, [&](const std::vector<std::string_view>& running) {
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        progress.show(fmt::format("{}, {:.0f} s", fmt::join(running, " and "), elapsed.count()));
    });
}

void write_results(const std::filesystem::path& folder, const std::vector<Reproduction>& reproductions) {
    host::AtomicFile json(folder / "reproduce.json");
    host::AtomicFile page(folder / page_file);
    json.stream() << reproduction_json(reproductions);
    page.stream() << reproduction_page(reproductions);
    json.commit();
    page.commit();
}

int reproduce_papers(const ReproduceOptions& options) {
    const std::vector<Paper> chosen = chosen_papers(options.paper);
    const std::filesystem::path folder = host::results_folder(options.out, page_file);
    const std::vector<Reproduction> reproductions = reproduce_watched(chosen);
    write_results(folder, reproductions);
    bool all_hold = true;
    for (const Reproduction& reproduction : reproductions) {
        fmt::print("{}\n", reproduction_text(reproduction, options.verbose));
        all_hold = all_hold && reproduction.holds();
    }
    fmt::print("report: {}\n", (folder / page_file).string());
    return all_hold ? 0 : 1;
}

}  // namespace

void add_reproduce(host::Command& program) {
    auto options = std::make_shared<ReproduceOptions>();
    host::Command command =
        program.subcommand("reproduce", "Compare published figures with ours: value, difference, bound");
    command.footer(
        "Each paper's system runs on simulated cuts; every random number is seeded. Under \"paper\" stands only what "
        "the\n"
        "paper prints; all else is a check of our own. A figure without a bound gives its reason. DIR gets\n"
        "reproduce.html, with all figures, plots and deviations from print, and reproduce.json.\n"
        "Exit code 1: a bound is broken.");
    command.option("paper", options->paper, joined_names(" | ")).value_name("PAPER").shows_default();
    command.option("--out", options->out, "Folder for reproduce.html and reproduce.json")
        .value_name("DIR")
        .shows_default();
    command.flag("--verbose", options->verbose, "Print every row of the long tables");
    command.on_run([options] { return reproduce_papers(*options); });
}

}  // namespace millforce::sim
