// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "faults/signal_fault.hpp"
#include "loop/scenario.hpp"

/// Parts that are milled in closed loop while one signal goes wrong at a drawn moment.

namespace millforce::faults {

/// One part. `duration_s`: of the run without a fault, in which the fault's begin is drawn.
struct Part {
    sim::Scenario scenario;
    firmware::Parameters<float> stated{};  ///< to the controller
    double duration_s = 0.0;
};

struct Outcome {
    FaultyMachine::Reaction reaction;
    double peak_over_limit = 0.0;
    int teeth_broken = 0;
};

/// The scenario of that name with the spindle's current alone, or with all currents.
Part part_named(const std::string& name, bool spindle_alone);

Outcome mill_with(const Part& part, SignalFault fault, std::uint64_t seed);

/// What the runs of one fault came to.
struct Tally {
    int runs = 0;          ///< in which the fault began before the part's end
    int broken_parts = 0;  ///< a tooth broke
    int over = 0;          ///< peak more than 10 % beyond the limit
    int faults = 0;        ///< latched at the end
    double largest_peak = 0.0;
    std::vector<double> reactions_s;  ///< of the runs that held the feed or faulted

    void add(const Outcome& outcome);
    [[nodiscard]] double median_reaction_s() const;
    [[nodiscard]] double longest_reaction_s() const;
};

}  // namespace millforce::faults
