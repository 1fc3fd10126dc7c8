// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bench_control/contenders.hpp"
#include "bench_control/disturbance.hpp"
#include "bench_control/parallel.hpp"
#include "bench_control/parts.hpp"
#include "preview/memory.hpp"
#include "wrong_maps/drawn_map.hpp"

/// Mills the parts of `millforce bench control` by part maps that are right or wrong: wrong_map_campaign --help.

namespace {

using namespace millforce;
using namespace millforce::test;

struct Options {
    std::size_t runs = 1000;
    std::uint64_t seed = 1;
    unsigned threads = 2;
    std::optional<MapError> error;  // of all runs
};

/// What a seed stands for: a map's error, a part, a machine and a plant.
struct Drawn {
    MapError error = MapError::none;
    std::size_t part = 0;
    std::size_t other = 0;
    sim::BenchMachine machine = sim::BenchMachine::currents;
};

Drawn drawn(std::uint64_t seed, std::size_t parts, std::mt19937_64& random) {
    Drawn drawn;
    drawn.error = all_map_errors[seed % all_map_errors.size()];
    drawn.part = static_cast<std::size_t>(random() % parts);
    drawn.other = (drawn.part + 1 + static_cast<std::size_t>(random() % (parts - 1))) % parts;
    drawn.machine = static_cast<sim::BenchMachine>(random() % 3);
    return drawn;
}

struct Row {
    std::size_t refuted = 0;
    std::size_t broken = 0;
    std::size_t broken_without_map_too = 0;
    std::size_t unfinished = 0;
    std::vector<double> peaks{};

    [[nodiscard]] double peak(double share) {
        std::ranges::sort(peaks);
        return peaks[static_cast<std::size_t>(share * static_cast<double>(peaks.size() - 1))];
    }
};

std::string_view name_of(sim::BenchMachine machine) {
    switch (machine) {
        case sim::BenchMachine::currents:
            return "all currents";
        case sim::BenchMachine::spindle_alone:
            return "spindle alone";
        case sim::BenchMachine::converter:
            return "a converter's load";
    }
    return "";
}

class Campaign {
  public:
    Campaign(const Options& options, std::vector<sim::PreparedPart> parts)
        : options_(options), parts_(std::move(parts)), rows_(all_map_errors.size()) {}

    void mill(std::size_t k) {
        const std::uint64_t seed = options_.seed + k;
        std::mt19937_64 random(seed);
        Drawn it = drawn(seed, parts_.size(), random);
        it.error = options_.error.value_or(it.error);
        const sim::PreparedPart& part = parts_[it.part];
        const sim::Scenario plant = sim::disturbed(part.on_machine[static_cast<std::size_t>(it.machine)],
                                                   sim::drawn_disturbance(seed), part.part.depth_mm, seed);
        const sim::LearntPart run =
            sim::mill_and_learn(plant, drawn_map(it.error, part.map, parts_[it.other].map, random));
        const bool is_broken = run.figures.teeth_broken > 0;
        const bool breaks_without = is_broken && sim::mill_and_learn(plant).figures.teeth_broken > 0;
        const std::scoped_lock hold(lock_);
        Row& row = rows_[static_cast<std::size_t>(it.error)];
        row.refuted += run.is_refuted ? 1U : 0U;
        row.broken += is_broken ? 1U : 0U;
        row.broken_without_map_too += breaks_without ? 1U : 0U;
        row.unfinished += run.figures.finished ? 0U : 1U;
        row.peaks.push_back(run.figures.peak_over_limit);
        if (is_broken || !run.figures.finished) {
            fmt::print(stderr, "seed {}: {}, map {}, {}, peak {:.0f} %, teeth broken {}{}{}\n", seed, part.part.name,
                       name_of(it.error), name_of(it.machine), 100.0 * run.figures.peak_over_limit,
                       run.figures.teeth_broken, breaks_without ? ", without a map too" : "",
                       run.figures.finished ? "" : ", not finished");
        }
    }

    /// False if a tooth broke that does not break without a map, or a part was not finished.
    bool print() {
        bool is_sound = true;
        fmt::print(
            "| map | runs | refuted | peak, median | 95 % | worst | runs with a broken tooth | without a map too |\n"
            "|---|---|---|---|---|---|---|---|\n");
        for (const MapError error : all_map_errors) {
            Row& row = rows_[static_cast<std::size_t>(error)];
            if (row.peaks.empty()) {
                continue;
            }
            fmt::print(
                "| {} | {} | {:.0f} % | {:.0f} % | {:.0f} % | {:.0f} % | {} | {} |\n", name_of(error), row.peaks.size(),
                100.0 * static_cast<double>(row.refuted) / static_cast<double>(row.peaks.size()), 100.0 * row.peak(0.5),
                100.0 * row.peak(0.95), 100.0 * row.peak(1.0), row.broken, row.broken_without_map_too);
            is_sound = is_sound && row.broken == row.broken_without_map_too && row.unfinished == 0;
        }
        return is_sound;
    }

  private:
    Options options_;
    std::vector<sim::PreparedPart> parts_;
    std::vector<Row> rows_;
    std::mutex lock_;
};

/// On a terminal.
void show_progress(double share, std::size_t runs) {
    static const bool is_terminal = ::isatty(STDERR_FILENO) != 0;
    if (is_terminal) {
        fmt::print(stderr, "\r{:.0f} of {} runs{}", share * static_cast<double>(runs), runs, share < 1.0 ? "" : "\n");
    }
}

int run(const Options& options) {
    const std::span<const sim::BenchPart> drawings = sim::bench_parts();
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("millforce_wrong_maps_{}", ::getpid());
    std::filesystem::create_directories(folder);
    std::vector<sim::PreparedPart> parts(drawings.size());
    sim::run_parallel(
        parts.size(), options.threads, [&](std::size_t k) { parts[k] = sim::prepare(folder, drawings[k]); },
        [](double) {});
    Campaign campaign(options, std::move(parts));
    sim::run_parallel(
        options.runs, options.threads, [&](std::size_t k) { campaign.mill(k); },
        [&](double share) { show_progress(share, options.runs); });
    std::filesystem::remove_all(folder);
    return campaign.print() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Mill the parts of 'millforce bench control' by part maps that are right or wrong");
    app.add_option("runs", options.runs, "Runs")->check(CLI::Range(1, 1'000'000))->capture_default_str();
    app.add_option("--first-seed", options.seed,
                   "A seed is a map's error, a part, a machine (all currents, spindle alone, a converter's load) and "
                   "a plant")
        ->capture_default_str();
    std::map<std::string, MapError> errors;
    for (const MapError error : all_map_errors) {
        errors.emplace(name_of(error), error);
    }
    app.add_option("--map", options.error, "Error of all maps, as the table names it; default: by the seed")
        ->transform(CLI::Transformer(errors))
        ->option_text("NAME");
    app.add_option("--threads", options.threads, "Runs at the same time")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.footer("Exit code: 0 no tooth broke that does not break without a map, and all parts were finished; 1 else.");
    CLI11_PARSE(app, argc, argv);
    return run(options);
}
