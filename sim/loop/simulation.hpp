// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "cnc/cnc.hpp"
#include "cnc/gcode.hpp"
#include "loop/milling_plant.hpp"
#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "report/run_result.hpp"

namespace millforce::sim {

struct SimulationSettings {
    double plant_step_s = 0.25e-3;
    double trace_interval_s = 0.02;  ///< one revolution where that is longer
    double longest_run_s = 3600.0;   ///< a program that has not ended by then is an error of the run, not of the user
    /// Called about every simulated second with the share of the path done; false stops the run.
    std::function<bool(double share)> progress;
    /// What happens beside the program, before each step of the plant: may alter the command, and the plant's edges.
    std::function<void(MillingPlant& plant, MillingPlant::Command& command)> interfere;
};

struct Simulated {
    RunResult result;
    HardestCut hardest_cut;
    bool interrupted = false;
};

/// The scenario's part program with what was left out of it, or the one straight move of a profile. Throws InputError.
GcodeProgram program_of(const Scenario& scenario);
std::vector<Move> moves_of(const Scenario& scenario);

/// A run, sample by sample, for whoever works out the override in a loop of his own:
///
///     while (run.next_sample()) {
///         run.answer(override_for(run.sample(), run.program()), controller);
///     }
///
/// The spindle turns for two seconds before the program begins, at time 0; the figures leave it out. Throws InputError
/// for a program that cannot be read. One thread.
class SteppedSimulation {
  public:
    explicit SteppedSimulation(const Scenario& scenario, const SimulationSettings& settings = {});

    /// Lets the plant run up to its next sample. False: the run has ended, or its progress callback has stopped it.
    /// `is_ready`: the program may begin.
    bool next_sample(bool is_ready = true);
    [[nodiscard]] const hal::DriveSample& sample() const { return sample_; }
    [[nodiscard]] hal::ProgramStatus program() const;

    /// The override that is in force until the next sample. `controller` describes what led to it.
    void answer(const hal::FeedOverride& output, const TraceSource& controller) { answer(output, controller, usual_); }
    /// `steps`: of the plant until the next sample.
    void answer(const hal::FeedOverride& output, const TraceSource& controller,
                const OverrideSource::PlantSteps& steps);
    /// As the machine's sample rate gives them.
    [[nodiscard]] const OverrideSource::PlantSteps& usual_steps() const { return usual_; }

    [[nodiscard]] double time_s() const { return plant_.time_s(); }
    [[nodiscard]] double path_share() const;
    /// What has been cut so far.
    [[nodiscard]] Simulated result(const std::string& controller_name);

  private:
    [[nodiscard]] bool has_ended();
    [[nodiscard]] bool is_stopped_by_progress();
    void turn_spindle();
    void step_plant();

    SimulationSettings settings_;
    Cnc cnc_;
    MillingPlant plant_;
    hal::DriveSample sample_{};
    hal::FeedOverride override_{};
    double commanded_speed_rad_s_ = 0.0;  // to the spindle, with what the operator does to it
    OverrideSource::PlantSteps usual_{};
    OverrideSource::PlantSteps steps_{};  ///< left until the next sample
    bool has_begun_ = false;              ///< the program
    bool was_stopped_ = false;
    double next_report_s_ = 1.0;
    std::chrono::steady_clock::time_point started_;
};

/// Runs a scenario against a controller, in closed loop: CNC → drives → tool and workpiece → cutting force → drives →
/// samples → controller → override → CNC. Deterministic: the same scenario, deviation and seed give the same bits.
Simulated simulate(const Scenario& scenario, OverrideSource& controller, const std::string& controller_name,
                   const SimulationSettings& settings = {});

/// K_s varies by ± 30 % between batches of a steel and with the wear of the edge: what a programmer must allow for who
/// chooses a constant feed.
inline constexpr double hardest_material = 1.3;

/// The largest constant override with which no tooth exceeds its limit anywhere on the part, for a material whose K_s
/// is `hardest` times that of the scenario. With 1.0 it is the best constant feed in hindsight, K_s known exactly.
/// The largest tooth force is then 96 to 100 % of the limit. Two simulations as a rule, four at most.
double safe_constant_override(const Scenario& scenario, double hardest = hardest_material,
                              const SimulationSettings& settings = {});

}  // namespace millforce::sim
