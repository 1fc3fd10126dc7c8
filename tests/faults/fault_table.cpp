// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "faults/campaign.hpp"
#include "percent.hpp"

/// Prints what faults at the tick's input lead to: fault_table [RUNS] [FIRST_SEED] [PART…]. RUNS for each fault and
/// part, ten times as many without a fault. A part's name with :spindle is the machine whose axes' currents nobody
/// reads.

namespace {

using namespace millforce::faults;
using millforce::test::percent;

void print(SignalFault fault, const Tally& t) {
    fmt::print("| {} | {} | {} | {} | {:.0f} | {} | {} | {:.2f} | {:.2f} |\n", name_of(fault), t.runs,
               percent(t.broken_parts, t.runs), percent(t.over, t.runs), 100.0 * t.largest_peak,
               percent(static_cast<int>(t.reactions_s.size()), t.runs), percent(t.faults, t.runs),
               t.median_reaction_s(), t.longest_reaction_s());
}

Part part_of(const std::string& argument) {
    constexpr std::string_view spindle = ":spindle";
    const bool spindle_alone = argument.ends_with(spindle);
    return part_named(spindle_alone ? argument.substr(0, argument.size() - spindle.size()) : argument, spindle_alone);
}

}  // namespace

int main(int argc, char** argv) {
    const int runs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 20;
    const auto first_seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
    std::vector<std::string> names(argv + std::min(argc, 3), argv + argc);
    if (names.empty()) {
        names = {"depth_ramp",         "width_step",         "slot_entry",
                 "depth_ramp:spindle", "width_step:spindle", "slot_entry:spindle"};
    }
    std::vector<Part> parts;
    for (const std::string& name : names) {
        parts.push_back(part_of(name));
    }
    std::vector<Tally> tallies(signal_faults);
    std::mutex lock;
    std::atomic<int> next{0};
    const auto work = [&] {
        constexpr int more_without = 9;  // a false alarm is rarer
        constexpr int kinds = signal_faults + more_without;
        const int all = kinds * static_cast<int>(parts.size()) * runs;
        for (int k = next++; k < all; k = next++) {
            const int fault = std::max(0, k % kinds - more_without);
            const Part& part = parts[static_cast<std::size_t>(k / kinds) % parts.size()];
            const Outcome outcome =
                mill_with(part, static_cast<SignalFault>(fault), first_seed + static_cast<std::uint64_t>(k));
            const std::scoped_lock hold(lock);
            tallies[static_cast<std::size_t>(fault)].add(outcome);
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
    fmt::print(
        "| fault | runs | a tooth broke, % | peak > 110 %, % | largest peak, % | held or faulted, % | faulted, % | "
        "reaction, s: median | longest |\n|---|---|---|---|---|---|---|---|---|\n");
    for (int fault = 0; fault < signal_faults; ++fault) {
        print(static_cast<SignalFault>(fault), tallies[static_cast<std::size_t>(fault)]);
    }
}
