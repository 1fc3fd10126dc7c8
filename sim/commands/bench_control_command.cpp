// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bench_control/bench_control.hpp"
#include "bench_control/bench_page.hpp"
#include "bench_control/text_file.hpp"
#include "bench_control/tuning.hpp"
#include "commands/command_line.hpp"
#include "commands/plant_commands.hpp"
#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/progress.hpp"
#include "files/results_folder.hpp"

namespace millforce::sim {

namespace {

struct BenchControlOptions {
    std::vector<std::string> parts;
    std::vector<std::string> controllers;
    int seeds = 30;
    std::uint32_t first_seed = 1;
    int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    int evaluations = 12;
    bool tune = false;
    bool traces = false;
    std::string settings;
    std::string out = "out/bench";
};

bool belongs_to(const BenchPart& part, const std::string& name) {
    return name == "all" || name == part.name || name == name_of(part.use) || name == name_of(part.kind);
}

std::string no_such_part(const std::string& name, const std::vector<std::string>& known) {
    const std::string nearest = host::nearest_name(name, known);
    return fmt::format("--parts: '{}' is no part and no kind of parts{}", name,
                       nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest));
}

std::vector<BenchPart> parts_of(const BenchControlOptions& options) {
    const std::vector<std::string> standard{options.tune ? "training" : "judging"};
    std::vector<std::string> known{"all", "training", "judging"};
    std::vector<BenchPart> parts;
    const auto& names = options.parts.empty() ? standard : options.parts;
    for (const BenchPart& part : bench_parts()) {
        known.emplace_back(part.name);
        known.emplace_back(name_of(part.kind));
        if (std::ranges::any_of(names, [&](const std::string& name) { return belongs_to(part, name); })) {
            parts.push_back(part);
        }
    }
    for (const std::string& name : names) {
        if (std::ranges::find(known, name) == known.end()) {
            throw host::InputError(no_such_part(name, known));
        }
    }
    return parts;
}

std::vector<const Contender*> contenders_of(const BenchControlOptions& options) {
    std::vector<const Contender*> chosen;
    for (const Contender& contender : contenders()) {
        // The bound always: times are told over it.
        if (options.controllers.empty() || contender.kind == Contender::Kind::bound ||
            std::ranges::find(options.controllers, contender.name) != options.controllers.end()) {
            chosen.push_back(&contender);
        }
    }
    return chosen;
}

std::vector<std::string> controller_choices() {
    std::vector<std::string> names;
    for (const Contender& contender : contenders()) {
        names.emplace_back(contender.name);
    }
    return names;
}

BenchSettings settings_of(const BenchControlOptions& options) {
    BenchSettings settings;
    settings.out = host::results_folder(options.out, "bench.html");
    if (options.traces) {
        settings.traces = host::results_folder((settings.out / "traces").string(), "trace.csv");
    }
    settings.parts = parts_of(options);
    settings.contenders = contenders_of(options);
    settings.first_seed = options.first_seed;
    settings.seeds = options.seeds;
    settings.threads = static_cast<unsigned>(options.threads);
    settings.rules = options.settings.empty() ? built_in_settings() : read_settings(options.settings);
    return settings;
}

/// One line on the terminal for each kind of work, one after the other.
class ProgressOfStages {
  public:
    void update(const std::string& stage, double share) {
        if (!progress_ || stage != stage_) {
            stage_ = stage;
            progress_.emplace(stage, 1);
        }
        progress_->update(share);
    }

  private:
    std::string stage_;
    std::optional<host::Progress> progress_;
};

int tune(const BenchControlOptions& options) {
    const BenchSettings settings = settings_of(options);
    ProgressOfStages progress;
    const auto show = [&](const std::string& what, double share) { progress.update(what, share); };
    std::vector<PreparedPart> parts = prepare_all(settings, show);
    RuleSettings tuned = settings.rules;
    const std::string origin =
        fmt::format("Made by: millforce bench control --tune --seeds {} --first-seed {} --evaluations {}, {} parts",
                    settings.seeds, settings.first_seed, options.evaluations, settings.parts.size());
    for (const RuleDescription& controller : described_controllers()) {
        if (std::ranges::find(settings.contenders, contender_named(controller.name)) == settings.contenders.end()) {
            continue;
        }
        tuned[std::string(controller.name)] = tuned_settings(
            controller, parts, {settings.first_seed, settings.seeds, settings.threads}, options.evaluations,
            [&](double share) { show(fmt::format("choosing the settings of {}", controller.title), share); });
        write_text_file(settings.out / "tuned.toml", settings_text(tuned, origin));
    }
    fmt::print("{}\nwritten: {}\n", settings_text(tuned, origin), (settings.out / "tuned.toml").string());
    return 0;
}

host::Facts facts_of(const BenchSettings& settings) {
    std::string parts;
    for (const BenchPart& part : settings.parts) {
        parts += (parts.empty() ? "" : ", ") + std::string(part.name);
    }
    host::Facts facts = host::facts_of_this_process();
    facts.emplace_back("Parts", parts);
    facts.emplace_back("Seeds", fmt::format("{} to {}", settings.first_seed,
                                            settings.first_seed + static_cast<std::uint64_t>(settings.seeds) - 1));
    facts.emplace_back("Date", host::date_and_time());
    return facts;
}

int bench_control(const BenchControlOptions& options) {
    if (options.tune) {
        return tune(options);
    }
    const BenchSettings settings = settings_of(options);
    std::vector<BenchRun> runs;
    {
        ProgressOfStages progress;
        runs = run_bench(settings, [&](const std::string& what, double share) { progress.update(what, share); });
    }
    write_bench_page(settings.out, runs, facts_of(settings));
    const std::vector<ContenderFigures> figures = figures_of_runs(runs);
    fmt::print("{}\nMedian time over the bound (95th percentile of the peaks), part by part:\n\n{}\npage: {}\n",
               markdown(table_of(figures)), markdown(table_of_parts(figures_of_parts(runs, figures), figures)),
               (settings.out / "bench.html").string());
    return 0;
}

}  // namespace

void add_bench_control(host::Command& bench, const std::shared_ptr<std::optional<int>>& exit_code) {
    auto options = std::make_shared<BenchControlOptions>();
    host::Command command = bench.subcommand(
        "control", "Compare feed controllers: ours, load controls by their published rules, and a bound");
    command.footer(
        "24 parts in six kinds: twelve to choose settings on (training), twelve only to judge by (judging, the\n"
        "default). Each seed is a machine and a blank, the same for all controllers: K_s and friction, runout, noise,\n"
        "latency, place and size of the blank are drawn. The bound is the plan of one who knows the true force\n"
        "everywhere.\n"
        "Writes into DIR: bench.html and three plots, runs.csv with all runs, and each part as a scenario in parts/,\n"
        "for 'millforce simulate'. Stopped with Ctrl-C and called again, it goes on where it stood. A run takes a\n"
        "third of a second to a second: 30 seeds on the judging parts are 4000 runs.\n"
        "--tune chooses the settings of the load controls, and of ours that is told a safe feed, anew on the training\n"
        "parts: for each one the shortest time with peaks of at most 105 % in 95 % of the runs. Of --controllers "
        "where\n"
        "they are named; the others keep theirs. It writes tuned.toml after each controller, for --settings.");
    command.option("--parts", options->parts, "Parts: names, kinds (pocket, slot, …), training, judging or all")
        .value_name("NAME...");
    command.option("--controllers", options->controllers, "Controllers; default: all")
        .value_name("NAME...")
        .one_of(controller_choices());
    command.option("--seeds", options->seeds, "Number of plants for each part").within(1, 100000).shows_default();
    command.option("--first-seed", options->first_seed, "Seed of the first plant").shows_default();
    command.option("--threads", options->threads, "Runs at the same time").within(1, 1024).shows_default();
    command.option("--settings", options->settings, "Settings of the controllers; default: those brought along")
        .value_name("TUNED.toml");
    command.flag("--traces", options->traces,
                 "Write the trace of each run that is not in runs.csv yet into DIR/traces");
    command.flag("--tune", options->tune, "Choose the settings of the controllers, in place of comparing");
    command
        .option("--evaluations", options->evaluations,
                "With --tune: how often a controller is tried, for each of its settings")
        .within(1, 10000)
        .shows_default();
    command.option("--out", options->out, "Folder for the results").value_name("DIR").shows_default();
    command.on_run([options, exit_code] {
        *exit_code = bench_control(*options);
        return **exit_code;
    });
}

}  // namespace millforce::sim
