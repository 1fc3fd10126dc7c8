// SPDX-License-Identifier: Apache-2.0
#include "loop/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "cnc/cnc.hpp"
#include "cnc/gcode.hpp"
#include "cnc/rs274.hpp"
#include "cutting/angle_units.hpp"
#include "files/input_error.hpp"
#include "files/text_lines.hpp"

namespace millforce::sim {

namespace {

/// One straight move for each feed of the profile.
std::vector<Move> profile_moves(const Scenario& scenario) {
    const double direction = scenario.profile.direction_deg * degree;
    const Eigen::Vector3d along(std::cos(direction), std::sin(direction), 0.0);
    Move move;
    move.kind = MoveKind::feed_line;
    move.feed_mm_s = scenario.feed_mm_s;
    move.spindle_speed_rad_s = scenario.spindle_speed_rad_s;
    move.line = 1;
    std::vector<Move> moves;
    double start_mm = 0.0;
    const auto add_up_to = [&](double path_mm) {
        if (path_mm > start_mm) {
            move.start_mm = along * start_mm;
            move.end_mm = along * path_mm;
            moves.push_back(move);
            start_mm = path_mm;
        }
    };
    for (const ProfilePoint& point : scenario.profile.points) {
        if (point.feed_mm_s > 0.0 && point.path_mm < scenario.profile.length_mm) {
            add_up_to(point.path_mm);
            move.feed_mm_s = point.feed_mm_s;
        }
    }
    add_up_to(scenario.profile.length_mm);
    return moves;
}

CncSettings cnc_settings(const Scenario& scenario, const SimulationSettings& settings) {
    CncSettings cnc;
    cnc.servo_period_s = settings.plant_step_s;
    cnc.acceleration_mm_s2 = static_cast<double>(scenario.parameters.machine.cnc.acceleration_mm_s2);
    cnc.override_latency_s = static_cast<double>(scenario.parameters.machine.cnc.override_latency_s);
    return cnc;
}

/// Long enough for the override to rise from its minimum in the first rapid, even over a bus that is still starting.
constexpr double spindle_start_s = 2.0;

}  // namespace

SteppedSimulation::SteppedSimulation(const Scenario& scenario, const SimulationSettings& settings)
    : settings_(settings),
      cnc_(cnc_settings(scenario, settings), moves_of(scenario)),
      plant_(scenario),
      started_(std::chrono::steady_clock::now()) {
    plant_.start_at(cnc_.position_mm(), cnc_.spindle_speed_rad_s());
    plant_.set_clock(-spindle_start_s);
    const double rate_hz = static_cast<double>(scenario.parameters.machine.cnc.sample_rate_hz);
    usual_.count = std::max(1, static_cast<int>(std::lround(1.0 / (rate_hz * settings.plant_step_s))));
    usual_.step_s = settings.plant_step_s;
    steps_ = usual_;
}

bool SteppedSimulation::next_sample(bool is_ready) {
    do {
        has_begun_ = has_begun_ || (is_ready && plant_.time_s() >= -0.5 * steps_.step_s);
        if (!has_begun_) {
            turn_spindle();
        } else if (has_ended()) {
            return false;
        } else {
            step_plant();
        }
    } while (--steps_.count > 0);
    sample_ = plant_.sample();
    return true;
}

void SteppedSimulation::answer(const hal::FeedOverride& output, const TraceSource& controller,
                               const OverrideSource::PlantSteps& steps) {
    override_ = output;
    steps_ = steps;
    if (has_begun_) {
        plant_.judge().follow(plant_.time_s(), override_, controller, settings_.trace_interval_s);
    }
}

bool SteppedSimulation::has_ended() {
    return cnc_.finished() || plant_.time_s() >= settings_.longest_run_s || plant_.judge().fault_stopped() ||
           is_stopped_by_progress();
}

bool SteppedSimulation::is_stopped_by_progress() {
    if (settings_.progress && plant_.time_s() > next_report_s_) {
        next_report_s_ += 1.0;
        was_stopped_ = was_stopped_ || !settings_.progress(path_share());
    }
    return was_stopped_;
}

double SteppedSimulation::path_share() const {
    return cnc_.path_mm() / std::max(cnc_.total_path_mm(), 1e-9);
}

Simulated SteppedSimulation::result(const std::string& controller_name) {
    Simulated simulated;
    simulated.result = plant_.judge().result(controller_name, cnc_.finished());
    simulated.hardest_cut = plant_.hardest_cut();
    simulated.interrupted = was_stopped_;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started_;
    simulated.result.figures.real_time_factor = plant_.time_s() / std::max(wall.count(), 1e-9);
    return simulated;
}

/// Spindle on, axes at rest: for the time that a CNC waits for its spindle, and until the controller has answered.
void SteppedSimulation::turn_spindle() {
    commanded_speed_rad_s_ = cnc_.spindle_speed_rad_s();
    plant_.idle(steps_.step_s, {cnc_.position_mm(), Eigen::Vector3d::Zero(), commanded_speed_rad_s_});
}

void SteppedSimulation::step_plant() {
    cnc_.step(static_cast<double>(override_.ratio), override_.hold);
    MillingPlant::Command command{
        cnc_.position_mm(), cnc_.direction(), cnc_.feed_mm_s(),           cnc_.programmed_feed_mm_s(),
        cnc_.path_mm(),     cnc_.is_rapid(),  cnc_.spindle_speed_rad_s(), static_cast<double>(override_.ratio)};
    if (settings_.interfere) {
        settings_.interfere(plant_, command);
    }
    commanded_speed_rad_s_ = command.spindle_speed_rad_s;
    plant_.advance(steps_.step_s, command);
}

hal::ProgramStatus SteppedSimulation::program() const {
    hal::ProgramStatus program;
    program.programmed_feed_mm_s = static_cast<float>(cnc_.programmed_feed_mm_s());
    program.rapid = cnc_.is_rapid();
    program.line = static_cast<std::uint32_t>(cnc_.line());
    program.distance_to_go_mm = static_cast<float>(cnc_.distance_to_go_mm());
    program.commanded_speed_rad_s = static_cast<float>(commanded_speed_rad_s_);
    return program;
}

namespace {

GcodeProgram read_by_ourselves(const std::string& name, const GcodeSettings& settings) {
    std::ifstream file = host::open_to_read(name);
    return read_gcode(file, name, settings);
}

/// What our reader refuses LinuxCNC's may know.
GcodeProgram read_by_either(const std::string& name, const GcodeSettings& settings) {
    try {
        return read_by_ourselves(name, settings);
    } catch (const host::InputError& ours) {
        if (!std::filesystem::is_regular_file(name) || !has_rs274()) {
            throw;
        }
        try {
            GcodeProgram program = read_by_rs274(name, settings);
            program.notes.push_back(ours.what());
            return program;
        } catch (const host::InputError& theirs) {
            throw host::InputError(fmt::format("{}; and {}", ours.what(), theirs.what()));
        }
    }
}

}  // namespace

GcodeProgram program_of(const Scenario& scenario) {
    if (!scenario.has_program()) {
        return {profile_moves(scenario), {}};
    }
    GcodeSettings settings;
    settings.start_mm = {scenario.stock.start_x_mm, scenario.stock.start_y_mm, scenario.stock.start_z_mm};
    settings.may_change_tool = !scenario.numbered_cutters.empty();
    switch (scenario.interpreter) {
        case Interpreter::own:
            return read_by_ourselves(scenario.program_file, settings);
        case Interpreter::rs274:
            return read_by_rs274(scenario.program_file, settings);
        case Interpreter::automatic:
            break;
    }
    return read_by_either(scenario.program_file, settings);
}

std::vector<Move> moves_of(const Scenario& scenario) {
    return program_of(scenario).moves;
}

Simulated simulate(const Scenario& scenario, OverrideSource& controller, const std::string& controller_name,
                   const SimulationSettings& settings) {
    SteppedSimulation run(scenario, settings);
    while (run.next_sample(controller.is_ready())) {
        const hal::FeedOverride output = controller.step(run.sample(), run.program());
        run.answer(output, controller, controller.plant_steps(run.usual_steps()));
    }
    return run.result(controller_name);
}

}  // namespace millforce::sim
