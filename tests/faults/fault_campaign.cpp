// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <map>
#include <mutex>
#include <random>
#include <string>
#include <thread>

#include "calibration/plausible_units.hpp"
#include "control/cut_state.hpp"
#include "faults/campaign.hpp"
#include "files/input_error.hpp"
#include "percent.hpp"
#include "report/trace_csv.hpp"

/// Mills parts while one thing goes wrong, and prints what came of it: fault_campaign --help.

namespace {

using namespace millforce::faults;
namespace sim = millforce::sim;
using millforce::test::percent;

struct Options {
    int runs = 1000;
    std::uint64_t seed = 1;
    double sound_share = 0.1;
    double repaired_share = 0.2;
    std::vector<std::string> parts{"depth_ramp",         "width_step",         "slot_entry",
                                   "depth_ramp:spindle", "width_step:spindle", "slot_entry:spindle"};
    std::vector<std::string> paths{"tick", "can", "link"};
    std::vector<std::string> faults{};
    bool lists_violations = false;
    std::string trace{};
};

/// A row of the table: one fault on one path, with the parts on which it can happen.
struct Row {
    Path path;
    Fault fault;
    std::vector<const Part*> parts{};
    Tally tally{};

    [[nodiscard]] bool is_sound() const { return fault == Fault{SignalFault::none}; }
};

std::vector<Row> rows_of(const Options& options, const std::vector<Part>& parts) {
    std::vector<Row> rows;
    const auto add = [&](Path path, const Fault& fault, const Part& part) {
        const auto is_it = [&](const Row& row) { return row.path == path && row.fault == fault; };
        auto row = std::find_if(rows.begin(), rows.end(), is_it);
        if (row == rows.end()) {
            row = rows.insert(rows.end(), Row{path, fault});
        }
        row->parts.push_back(&part);
    };
    for (int k = 0; k < paths; ++k) {
        const auto path = static_cast<Path>(k);
        if (std::find(options.paths.begin(), options.paths.end(), name_of(path)) == options.paths.end()) {
            continue;
        }
        for (const Part& part : parts) {
            for (const Fault& fault : faults_on(path, part)) {
                const bool is_asked = options.faults.empty() || std::find(options.faults.begin(), options.faults.end(),
                                                                          name_of(fault)) != options.faults.end();
                if (is_asked) {
                    add(path, fault, part);
                }
            }
        }
    }
    return rows;
}

struct Run {
    std::size_t row = 0;
    const Part* part = nullptr;
    std::uint64_t seed = 0;
    bool is_repaired = false;
};

/// The sound runs first; the others in turn, over all rows and their parts.
std::vector<Run> runs_of(const Options& options, const std::vector<Row>& rows) {
    std::vector<std::size_t> sound;
    std::vector<std::size_t> faulty;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        (rows[k].is_sound() ? sound : faulty).push_back(k);
    }
    std::vector<Run> runs;
    const auto add = [&](const std::vector<std::size_t>& among, int count) {
        for (int n = 0; n < count && !among.empty(); ++n) {
            const auto index = static_cast<std::size_t>(n);
            const std::size_t row = among[index % among.size()];
            const auto& parts = rows[row].parts;
            const std::uint64_t seed = options.seed + runs.size();
            std::mt19937_64 random(seed);
            runs.push_back({row, parts[index / among.size() % parts.size()], seed,
                            std::bernoulli_distribution(options.repaired_share)(random)});
        }
    };
    const int sound_runs =
        faulty.empty() ? options.runs : static_cast<int>(options.sound_share * static_cast<double>(options.runs));
    add(sound, sound_runs);
    add(faulty, options.runs - static_cast<int>(runs.size()));
    return runs;
}

void say(const Row& row, const Run& run, const Outcome& outcome) {
    Tally one;
    one.add(outcome, is_unseen(row.fault, *run.part));
    const bool is_false_alarm = row.is_sound() && outcome.reaction.has_reacted;
    const bool is_unfinished = one.repaired > one.milled_on;
    if (one.violations() > 0 || one.unseen_violations > 0 || is_false_alarm || is_unfinished) {
        fmt::print(stderr, "{}: {}, {}, {}, seed {}, peak {:.0f} %, teeth broken {}, fault {}\n",
                   is_false_alarm              ? "false alarm"
                   : one.violations() > 0      ? "violation"
                   : one.unseen_violations > 0 ? "counted apart"
                                               : "does not mill on",
                   name_of(row.path), run.part->name, name_of(row.fault), run.seed,
                   100.0 * outcome.run.figures.peak_over_limit, outcome.run.figures.teeth_broken,
                   outcome.reaction.fault);
    }
}

void write_trace(const std::string& name, const sim::RunResult& run) {
    std::ofstream file(name);
    file << sim::trace_csv(run);
}

/// On a terminal: how far it is.
void show_progress(std::size_t done, std::size_t all) {
    static const bool is_terminal = ::isatty(STDERR_FILENO) != 0;
    const std::size_t step = std::max<std::size_t>(all / 100, 1);
    if (is_terminal && done % step == 0) {
        fmt::print(stderr, "\r{} of {} runs{}", done, all, done == all ? "\n" : "");
    }
}

/// What one check, a control::Fault, or a hold alone found, in all runs.
struct Finder {
    std::vector<double> after_s{};  ///< in the runs with a fault
    int false_alarms = 0;           ///< in those without
};
using Finders = std::map<std::uint8_t, Finder>;

void add(Finders& finders, const Reaction& reaction, bool is_sound) {
    if (!reaction.has_begun || !reaction.has_reacted) {
        return;
    }
    Finder& finder = finders[reaction.found_by];
    if (is_sound) {
        ++finder.false_alarms;
    } else {
        finder.after_s.push_back(reaction.after_s);
    }
}

Finders mill_all(const std::vector<Run>& runs, std::vector<Row>& rows, const Options& options) {
    Finders finders;
    std::mutex lock;
    std::atomic<std::size_t> next{0};
    std::size_t done = 0;
    const auto work = [&] {
        for (std::size_t k = next++; k < runs.size(); k = next++) {
            Row& row = rows[runs[k].row];
            const Outcome outcome = mill_with(*runs[k].part, row.path, row.fault, runs[k].seed, runs[k].is_repaired);
            const std::scoped_lock hold(lock);
            row.tally.add(outcome, is_unseen(row.fault, *runs[k].part));
            add(finders, outcome.reaction, row.is_sound());
            show_progress(++done, runs.size());
            if (options.lists_violations) {
                say(row, runs[k], outcome);
            }
            if (!options.trace.empty()) {
                write_trace(options.trace, outcome.run);
            }
        }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) {
        threads.emplace_back(work);
    }
    work();
    for (std::thread& thread : threads) {
        thread.join();
    }
    return finders;
}

std::string median_and_longest(const std::vector<double>& after_s) {
    return after_s.empty() ? ""
                           : fmt::format("{:.2f}, {:.2f}", millforce::host::median_of(after_s),
                                         *std::max_element(after_s.begin(), after_s.end()));
}

/// Which check found how many faults, and how often it found one where there was none.
void print(const Finders& finders) {
    if (finders.empty()) {
        return;
    }
    fmt::print("\n| found by | runs with a fault | after, s: median, longest | false alarms |\n|---|---|---|---|\n");
    for (const auto& [fault, finder] : finders) {
        const bool is_hold = fault == static_cast<std::uint8_t>(millforce::control::Fault::none);
        const std::string name =
            is_hold ? "a hold"
                    : fmt::format("`{}`", millforce::control::name(static_cast<millforce::control::Fault>(fault)));
        fmt::print("| {} | {} | {} | {} |\n", name, finder.after_s.size(), median_and_longest(finder.after_s),
                   finder.false_alarms);
    }
}

void print(const Row& row) {
    const Tally& t = row.tally;
    const bool has_reacted = !t.reactions_s.empty();
    fmt::print("| {} | {} | {} | {} | {} | {:.0f} | {} | {} | {} | {} | {} | {} |\n", name_of(row.fault),
               name_of(row.path), t.runs, percent(t.broken_parts, t.runs), percent(t.over, t.runs),
               100.0 * t.largest_peak, percent(static_cast<int>(t.reactions_s.size()), t.runs),
               median_and_longest(t.reactions_s),
               has_reacted ? fmt::format("{:.0f}", 100.0 * t.largest_peak_until_held) : "", percent(t.crawled, t.runs),
               t.repaired > 0 ? fmt::format("{}/{}", t.milled_on, t.repaired) : "", t.violations());
}

int run(const Options& options) {
    std::vector<Part> parts;
    for (const std::string& name : options.parts) {
        parts.push_back(part_named(name));
    }
    std::vector<Row> rows = rows_of(options, parts);
    if (rows.empty()) {
        fmt::print(stderr, "fault_campaign: no such fault on these paths\n");
        return 2;
    }
    const Finders finders = mill_all(runs_of(options, rows), rows, options);
    fmt::print(
        "| fault | path | runs | tooth broken, % | peak above 110 %, % | largest peak, % | feed held, % | after, s: "
        "median, longest | peak until held, % | crawls, % | mill on | "
        "violations |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    int violations = 0;
    int unseen = 0;
    int unseen_runs = 0;
    int sound_runs = 0;
    int false_alarms = 0;
    for (const Row& row : rows) {
        if (row.tally.runs == 0) {
            continue;
        }
        print(row);
        violations += row.tally.violations();
        unseen += row.tally.unseen_violations;
        unseen_runs += row.tally.unseen_runs;
        if (row.is_sound()) {
            sound_runs += row.tally.runs;
            false_alarms += static_cast<int>(row.tally.reactions_s.size());
        }
    }
    print(finders);
    fmt::print("\n{} violations, and {} in {} runs by what no signal contradicts; {} false alarms in {} sound runs\n",
               violations, unseen, unseen_runs, false_alarms, sound_runs);
    constexpr int runs_per_false_alarm = 1000;
    return violations > 0 || false_alarms * runs_per_false_alarm > sound_runs ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Mills parts in closed loop while one thing goes wrong at a drawn moment.");
    Options options;
    app.add_option("--runs", options.runs, "in all")->check(CLI::Range(1, 10'000'000))->capture_default_str();
    app.add_option("--seed", options.seed, "of the first run")->capture_default_str();
    app.add_option("--sound", options.sound_share, "share of the runs without a fault")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--repaired", options.repaired_share,
                   "share of the runs in which a fault that held the feed for a second ends then, the operator resets, "
                   "and the part goes on")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--part", options.parts,
                   "scenarios; NAME:spindle is a machine that reads its spindle's current alone, NAME:vfd one with a "
                   "frequency converter's load instead; NAME:undeclared, NAME:undeclared:spindle, NAME:undeclared:vfd: "
                   "the controller is told nothing of the depth");
    app.add_option("--path", options.paths, "between machine and controller")
        ->check(CLI::IsMember({"tick", "can", "link"}));
    app.add_option("--fault", options.faults, "as the table names them");
    app.add_flag("--list", options.lists_violations, "each run that broke a rule, with its seed");
    app.add_option("--trace", options.trace, "CSV file of the last run");
    CLI11_PARSE(app, argc, argv);
    try {
        return run(options);
    } catch (const millforce::host::InputError& error) {
        fmt::print(stderr, "fault_campaign: {}\n", error.what());
        return 2;
    }
}
