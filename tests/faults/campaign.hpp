// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "faults/bus_fault.hpp"
#include "faults/controller_on_link.hpp"
#include "faults/faulty_machine.hpp"
#include "faults/signal_fault.hpp"
#include "loop/scenario.hpp"
#include "report/run_result.hpp"

/// Parts that are milled in closed loop while one thing goes wrong at a drawn moment.

namespace millforce::faults {

/// What stands between the machine and the tick. A seed has the same material, friction and noise in all of them.
enum class Path : std::uint8_t {
    tick,  ///< nothing: samples and overrides in memory
    can,   ///< drives, CNC and CanController on a bus in memory
    link,  ///< messages to and from a LinkController
};
inline constexpr int paths = static_cast<int>(Path::link) + 1;
const char* name_of(Path path);

using Fault = std::variant<SignalFault, BusFault, LinkFault>;
const char* name_of(const Fault& fault);

/// One part. `duration_s`: of the run without a fault, in which the fault's begin is drawn.
struct Part {
    std::string name;  ///< of its scenario, with what follows it, below
    sim::Scenario scenario;
    firmware::Parameters<float> stated{};  ///< to the controller
    bool is_spindle_alone = false;
    bool is_load_seldom = false;  ///< a converter's load
    bool is_declared = true;      ///< its depth does not step, and the controller is told so
    double duration_s = 0.0;
};
/// "NAME:spindle": the axes' currents are not read. "NAME:vfd": nor the spindle's, but the load that a frequency
/// converter gives ten times a second and late. "NAME:undeclared", "NAME:undeclared:spindle": nothing is told of the
/// part's depth, so a step of it may come (depth_step_ratio).
Part part_named(const std::string& name);

/// After it nothing says what the tool does: the spindle's current or its encoder is not there, or does not change. A
/// load that a converter gives seldom may rightly stay the same in a steady cut
/// (firmware/program/check/unseen_faults.hpp).
[[nodiscard]] bool leaves_blind(const Fault& fault, const Part& part);

/// No signal contradicts it (firmware/program/check/unseen_faults.hpp), and nothing else bounds the feed: a CNC that
/// goes on telling a rapid; an axis' current that has suddenly another gain; and a current that drifts, or whose gain
/// is wrong by less than a factor of two or ever more so, as if the cut had become lighter. The last ones where the
/// depth is declared or the axes' currents are not read: elsewhere a step of the depth may come, and the feed waits for
/// it.
[[nodiscard]] bool is_unseen(const Fault& fault, const Part& part);

/// What can go wrong on this path, with what is read on this machine: a frame brings neither NaN nor the drive's time.
[[nodiscard]] std::vector<Fault> faults_on(Path path, const Part& part);

struct Outcome {
    Reaction reaction;
    sim::RunResult run;
    bool crawled = false;          ///< the part took half as long again, without a fault or a hold
    double peak_until_held = 0.0;  ///< force of a tooth over its limit, from the fault's begin until the axes stood
};
/// `is_repaired`: what holds the feed for held_for_good_s is put right then, the operator resets, and the part goes on.
Outcome mill_with(const Part& part, Path path, const Fault& fault, std::uint64_t seed, bool is_repaired = false);
/// On another path, e.g. a controller in another process.
Outcome mill_with_controller(const Part& part, sim::OverrideSource& controller, const Fault& fault, std::uint64_t seed,
                             const OnPath& on_path = {});

/// What the runs of one fault came to.
struct Tally {
    int runs = 0;          ///< in which the fault began before the part's end
    int broken_parts = 0;  ///< a tooth broke
    int over = 0;          ///< peak more than 10 % beyond the limit
    int beyond_bound = 0;  ///< an override outside its bounds
    int ran_in_fault = 0;
    int rose_blind = 0;
    int stopped_silently = 0;
    int crawled = 0;
    int repaired = 0;
    int milled_on = 0;  ///< the part was finished after the repair
    double largest_peak = 0.0;
    double largest_peak_until_held = 0.0;  ///< of the runs that held the feed or faulted
    std::vector<double> reactions_s;       ///< of the runs that held the feed or faulted
    int unseen_runs = 0;                   ///< of the runs: is_unseen
    int unseen_violations = 0;             ///< of those

    void add(const Outcome& outcome, bool is_unseen = false);
    /// What must never be, but by a fault that nothing shows.
    [[nodiscard]] int violations() const {
        return broken_parts + beyond_bound + ran_in_fault + rose_blind + stopped_silently - unseen_violations;
    }
};

}  // namespace millforce::faults
