#include "loop/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>

#include "cnc/cnc.hpp"
#include "cnc/gcode.hpp"
#include "files/input_error.hpp"
#include "loop/run_judge.hpp"
#include "loop/workpiece.hpp"
#include "machine/machine_plant.hpp"

namespace millforce::sim {

namespace {

/// One straight move for each feed of the profile.
std::vector<Move> profile_moves(const Scenario& scenario) {
    const double direction = scenario.profile.direction_deg * std::numbers::pi / 180.0;
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

std::unique_ptr<Workpiece> workpiece_of(const Scenario& scenario) {
    if (scenario.has_program()) {
        return std::make_unique<StockWorkpiece>(scenario.stock, scenario.cutter);
    }
    const auto& tool = scenario.parameters.tool;
    return std::make_unique<ProfileWorkpiece>(
        scenario.profile, scenario.cutter, static_cast<estimation::CutSide>(static_cast<unsigned char>(tool.side)),
        static_cast<double>(tool.centre_offset_mm));
}

/// The way that the tool has gone since the tooth before passed: the chip is what that tooth left. Looked up by the
/// spindle's angle, one pitch back, for the spindle slows down under a tooth.
class FeedHistory {
  public:
    void add(double angle_rad, double path_mm) {
        newest_ = (newest_ + 1) % places_.size();
        places_[newest_] = {angle_rad, path_mm};
        filled_ = std::min(filled_ + 1, places_.size());
        if (behind_ == newest_) {
            behind_ = after(behind_);
        }
    }
    [[nodiscard]] double feed_per_tooth_mm(double pitch_rad) {
        const double then_rad = places_[newest_].angle_rad - pitch_rad;
        if (filled_ < places_.size()) {
            behind_ = (newest_ + places_.size() + 1 - filled_) % places_.size();
        }
        while (after(behind_) != newest_ && places_[after(behind_)].angle_rad <= then_rad) {
            behind_ = after(behind_);
        }
        const Place& from = places_[behind_];
        const Place& to = places_[after(behind_)];
        const double turned_rad = places_[newest_].angle_rad - from.angle_rad;
        if (filled_ < 3 || !(turned_rad > 0.0)) {
            return 0.0;
        }
        if (turned_rad < pitch_rad) {
            return (places_[newest_].path_mm - from.path_mm) * pitch_rad / turned_rad;
        }
        const double step_rad = to.angle_rad - from.angle_rad;
        const double share = step_rad > 0.0 ? std::min((then_rad - from.angle_rad) / step_rad, 1.0) : 0.0;
        return places_[newest_].path_mm - (from.path_mm + share * (to.path_mm - from.path_mm));
    }

  private:
    struct Place {
        double angle_rad = 0.0;
        double path_mm = 0.0;
    };
    [[nodiscard]] std::size_t after(std::size_t place) const { return (place + 1) % places_.size(); }

    std::array<Place, 1024> places_{};
    std::size_t newest_ = 0;
    std::size_t behind_ = 1;
    std::size_t filled_ = 0;
};

class Loop {
  public:
    Loop(const Scenario& scenario, OverrideSource& controller, const SimulationSettings& settings)
        : scenario_(deviated(scenario, scenario.deviation, scenario.seed)),
          settings_(settings),
          controller_(controller),
          cnc_(cnc_settings(scenario, settings), moves_of(scenario)),
          machine_(scenario_.machine),
          cutting_(scenario_.cutter, scenario_.coefficients, scenario_.cutting_options),
          workpiece_(workpiece_of(scenario)),
          judge_(scenario_) {
        machine_.start_at(cnc_.position_mm(), cnc_.spindle_speed_rad_s());
        const double rate_hz = static_cast<double>(scenario.parameters.machine.cnc.sample_rate_hz);
        usual_.count = std::max(1, static_cast<int>(std::lround(1.0 / (rate_hz * settings.plant_step_s))));
        usual_.step_s = settings.plant_step_s;
        steps_ = usual_;
    }

    Simulated run(const std::string& name) {
        const auto started = std::chrono::steady_clock::now();
        Simulated simulated;
        double next_report_s = 1.0;
        wait_for_the_controller();
        while (!cnc_.finished() && machine_.time_s() < settings_.longest_run_s && !judge_.fault_stopped()) {
            step_plant();
            if (--steps_.count <= 0) {
                sample();
            }
            if (settings_.progress && machine_.time_s() > next_report_s) {
                next_report_s += 1.0;
                if (!settings_.progress(cnc_.path_mm() / std::max(cnc_.total_path_mm(), 1e-9))) {
                    simulated.interrupted = true;
                    break;
                }
            }
        }
        simulated.result = judge_.result(name, cnc_.finished());
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - started;
        simulated.result.figures.real_time_factor = machine_.time_s() / std::max(wall.count(), 1e-9);
        return simulated;
    }

  private:
    /// Spindle on, axes standing.
    void wait_for_the_controller() {
        const MachinePlant::Command standing{cnc_.position_mm(), Eigen::Vector3d::Zero(), cnc_.spindle_speed_rad_s()};
        while (!controller_.is_ready()) {
            machine_.advance(steps_.step_s, standing, {});
            if (--steps_.count <= 0) {
                override_ = controller_.step(machine_.sample(), program_status());
                steps_ = controller_.plant_steps(usual_);
            }
        }
    }

    void step_plant() {
        const double dt_s = steps_.step_s;
        cnc_.step(static_cast<double>(override_.ratio), override_.hold);
        const Eigen::Vector3d direction = cnc_.direction();
        machine_.advance(dt_s, {cnc_.position_mm(), direction * cnc_.feed_mm_s(), cnc_.spindle_speed_rad_s()}, load_);
        const Eigen::Vector3d velocity = machine_.velocity_mm_s();
        path_mm_ += velocity.norm() * dt_s;
        history_.add(machine_.spindle_angle_rad(), path_mm_);
        // The tool goes where the axes go; the command's direction serves while they hardly move.
        const Eigen::Vector3d travel = velocity.norm() > 0.5 ? velocity.normalized() : direction;
        if (!cnc_.is_rapid() || !scenario_.has_program()) {
            workpiece_->move_to(machine_.position_mm(), travel, cnc_.path_mm());
            cut(travel);
        } else {
            workpiece_->move_to(machine_.position_mm(), Eigen::Vector3d::UnitZ(), cnc_.path_mm());
            load_ = {};
        }
        judge_.observe(dt_s, {machine_.position_mm(), velocity.norm(), path_mm_, cnc_.programmed_feed_mm_s(),
                              cnc_.is_rapid(), machine_.spindle_speed_rad_s(), static_cast<double>(override_.ratio)},
                       cutting_load_, workpiece_->truth());
    }

    /// The force over the angle that the spindle turned in this step: as many points as keep a tooth from jumping
    /// over more than 3°.
    void cut(const Eigen::Vector3d& direction) {
        const double speed = machine_.spindle_speed_rad_s();
        cutting_load_ = {};
        load_ = {};
        if (!workpiece_->truth().cutting || !(speed > 1.0)) {
            return;
        }
        const double feed_per_tooth =
            history_.feed_per_tooth_mm(2.0 * std::numbers::pi / static_cast<double>(scenario_.cutter.teeth));
        const double turned_rad = speed * steps_.step_s;
        const int points = std::max(1, static_cast<int>(std::ceil(turned_rad / (3.0 * std::numbers::pi / 180.0))));
        for (int k = 0; k < points; ++k) {
            const double angle = machine_.spindle_angle_rad() - turned_rad * (1.0 - (k + 0.5) / points);
            const CuttingLoad part = cutting_.load(angle, feed_per_tooth, workpiece_->engagement());
            cutting_load_.fx_N += part.fx_N / points;
            cutting_load_.fy_N += part.fy_N / points;
            cutting_load_.fz_N += part.fz_N / points;
            cutting_load_.spindle_torque_Nm += part.spindle_torque_Nm / points;
            for (std::size_t tooth = 0; tooth < part.tooth_force_N.size(); ++tooth) {
                cutting_load_.tooth_force_N[tooth] = std::max(cutting_load_.tooth_force_N[tooth], part.tooth_force_N[tooth]);
            }
            peak_total_N_ = std::max(peak_total_N_, std::hypot(part.fx_N, part.fy_N));
        }
        judge_.observe_peak(peak_total_N_);
        peak_total_N_ = 0.0;
        const double along = std::max(direction.head<2>().norm(), 1e-9);
        const Eigen::Vector2d t = direction.head<2>() / along;
        load_.force_on_workpiece_N = {cutting_load_.fx_N * t.x() - cutting_load_.fy_N * t.y(),
                                      cutting_load_.fx_N * t.y() + cutting_load_.fy_N * t.x(), cutting_load_.fz_N};
        load_.spindle_torque_Nm = cutting_load_.spindle_torque_Nm;
    }

    [[nodiscard]] hal::ProgramStatus program_status() const {
        hal::ProgramStatus program;
        program.programmed_feed_mm_s = static_cast<float>(cnc_.programmed_feed_mm_s());
        program.rapid = cnc_.is_rapid();
        return program;
    }

    void sample() {
        override_ = controller_.step(machine_.sample(), program_status());
        steps_ = controller_.plant_steps(usual_);
        judge_.follow(machine_.time_s(), override_, controller_, settings_.trace_interval_s);
    }

    Scenario scenario_;
    SimulationSettings settings_;
    OverrideSource& controller_;
    Cnc cnc_;
    MachinePlant machine_;
    CuttingForce cutting_;
    std::unique_ptr<Workpiece> workpiece_;
    FeedHistory history_;
    RunJudge judge_;
    MachinePlant::Load load_{};
    CuttingLoad cutting_load_{};
    hal::FeedOverride override_{};
    double path_mm_ = 0.0;
    double peak_total_N_ = 0.0;
    OverrideSource::PlantSteps usual_{};
    OverrideSource::PlantSteps steps_{};  ///< left until the next sample
};

}  // namespace

std::vector<Move> moves_of(const Scenario& scenario) {
    if (!scenario.has_program()) {
        return profile_moves(scenario);
    }
    std::ifstream file(scenario.program_file);
    if (!file) {
        throw InputError(fmt::format("{}: no such file", scenario.program_file));
    }
    GcodeSettings settings;
    settings.start_mm = {scenario.stock.start_x_mm, scenario.stock.start_y_mm, scenario.stock.start_z_mm};
    return parse_gcode(file, scenario.program_file, settings);
}

Simulated simulate(const Scenario& scenario, OverrideSource& controller, const std::string& controller_name,
                   const SimulationSettings& settings) {
    return Loop(scenario, controller, settings).run(controller_name);
}

double safe_constant_override(const Scenario& scenario, double hardest, const SimulationSettings& settings) {
    Scenario hard = scenario;
    hard.deviation.cutting_force_scale *= hardest;
    const double exponent = 0.75;
    double ratio = 0.5;
    double best = 0.0;
    for (int round = 0; round < 5; ++round) {
        ConstantFeed constant(hard.parameters, ratio);
        const Simulated run = simulate(hard, constant, "constant", settings);
        if (run.interrupted) {
            return ratio;
        }
        const double share = run.result.figures.peak_over_limit;
        if (share <= 1.0) {
            best = std::max(best, ratio);
        }
        if (!(share > 0.0) || (share > 0.985 && share <= 1.0)) {
            break;
        }
        ratio = std::clamp(ratio * std::pow(0.995 / share, 1.0 / exponent), 0.01, 5.0);
    }
    return best > 0.0 ? best : ratio * 0.9;
}

}  // namespace millforce::sim
