// SPDX-License-Identifier: Apache-2.0
#include "linuxcnc/linuxcnc_plant.hpp"

#include "cutting/angle_units.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::sim {

namespace {

constexpr double plant_step_s = 0.25e-3;
constexpr double trace_interval_s = 0.02;
constexpr std::int32_t rapid_motion = 1;

/// LinuxCNC's controller is connected by HAL pins: its estimates as the pins show them.
class EstimatesOnPins : public TraceSource {
  public:
    explicit EstimatesOnPins(const millforce_plant_command& pins) : pins_(pins) {}
    void describe(TracePoint& point) const override {
        point.state = static_cast<std::uint8_t>(pins_.state_code);
        point.limit = static_cast<std::uint8_t>(pins_.limit_code);
        point.fault = static_cast<std::uint8_t>(pins_.fault_code);
        point.tangential_force_N = pins_.tangential_N;
        point.feed_force_N = pins_.feed_N;
        point.tooth_force_N = pins_.has_tooth_force != 0 ? pins_.estimated_tooth_N : host::no_estimate;
        if (pins_.has_immersion != 0) {
            point.radial_immersion = pins_.radial_immersion;
            point.radial_immersion_sd = pins_.radial_immersion_sd;
        }
        if (pins_.has_depth != 0) {
            point.axial_depth_mm = pins_.axial_depth_mm;
            point.axial_depth_sd_mm = pins_.axial_depth_sd_mm;
        }
    }

  private:
    const millforce_plant_command& pins_;
};

Eigen::Vector3d position_of(const millforce_plant_command& command) {
    return {command.position_mm[0], command.position_mm[1], command.position_mm[2]};
}

double speed_of(const millforce_plant_command& command) {
    return command.spindle_rev_s * turn;
}

/// Axes that follow at once, as before and after a run.
millforce_plant_reply ideal_reply(const millforce_plant_command& command, const Eigen::Vector3d& travel_mm) {
    millforce_plant_reply reply{};
    for (Eigen::Index axis = 0; axis < MILLFORCE_PLANT_AXES; ++axis) {
        reply.position_mm[axis] = command.position_mm[axis];
        reply.velocity_mm_s[axis] = travel_mm[axis] / command.period_s;
    }
    return reply;
}

}  // namespace

millforce_plant_reply LinuxCncPlant::step(const millforce_plant_command& command) {
    const Eigen::Vector3d position_mm = position_of(command);
    const bool spindle_turns = command.spindle_is_on != 0 && command.spindle_rev_s > 0.0;
    if (spindle_turns && !plant_) {
        plant_.emplace(scenario_);
        plant_->start_at(position_mm, 0.0);
        path_mm_ = 0.0;
        last_mm_ = position_mm;
    } else if (!spindle_turns && plant_) {
        end(true);
    }
    const Eigen::Vector3d travel_mm = position_mm - last_mm_.value_or(position_mm);
    millforce_plant_reply reply = ideal_reply(command, travel_mm);
    if (plant_) {
        advance(command, position_mm);
        judge(command);
        const hal::DriveSample sample = plant_->sample();
        const MachinePlant& machine = plant_->machine();
        for (std::size_t axis = 0; axis < MILLFORCE_PLANT_AXES; ++axis) {
            reply.position_mm[axis] = machine.position_mm()[static_cast<Eigen::Index>(axis)];
            reply.velocity_mm_s[axis] = static_cast<double>(sample.axis_velocity_mm_s[axis]);
            reply.current_A[axis] = static_cast<double>(sample.axis_current_A[axis]);
        }
        reply.count = sample.spindle_count;
        reply.index_count = sample.spindle_index_count;
        reply.index_number = sample.spindle_index_number;
        reply.spindle_current_A = static_cast<double>(sample.spindle_current_A);
        reply.spindle_rev_s = machine.spindle_speed_rad_s() / turn;
        reply.tooth_force_N = tooth_force_N_;
    }
    reply.cycle_number = command.cycle_number;
    last_mm_ = position_mm;
    return reply;
}

/// The commanded way of the cycle in plant steps, at even speed.
void LinuxCncPlant::advance(const millforce_plant_command& command, const Eigen::Vector3d& position_mm) {
    const Eigen::Vector3d travel_mm = position_mm - *last_mm_;
    const double way_mm = travel_mm.norm();
    const int steps = std::max(1, static_cast<int>(std::lround(command.period_s / plant_step_s)));
    MillingPlant::Command moved;
    moved.direction = way_mm > 0.0 ? Eigen::Vector3d(travel_mm / way_mm) : Eigen::Vector3d::Zero();
    moved.feed_mm_s = way_mm / command.period_s;
    moved.programmed_feed_mm_s = command.feed_mm_s;
    moved.is_rapid = command.kind_of_motion == rapid_motion;
    moved.spindle_speed_rad_s = speed_of(command);
    moved.override_ratio = command.override_ratio;
    tooth_force_N_ = 0.0;
    for (int k = 1; k <= steps; ++k) {
        const double share = static_cast<double>(k) / steps;
        moved.position_mm = *last_mm_ + share * travel_mm;
        moved.path_mm = path_mm_ + share * way_mm;
        plant_->advance(command.period_s / steps, moved);
        const auto& teeth = plant_->load().tooth_force_N;
        tooth_force_N_ = std::max(tooth_force_N_, *std::max_element(teeth.begin(), teeth.end()));
    }
    path_mm_ += way_mm;
}

void LinuxCncPlant::judge(const millforce_plant_command& command) {
    hal::FeedOverride output;
    output.ratio = static_cast<float>(command.override_ratio);
    output.fault = static_cast<std::uint8_t>(command.fault_code);
    plant_->judge().follow(plant_->time_s(), output, EstimatesOnPins(command), trace_interval_s);
}

void LinuxCncPlant::end(bool finished) {
    result_ = plant_->judge().result("millforce", finished);
    plant_.reset();
}

void LinuxCncPlant::disconnect() {
    if (plant_) {
        end(false);
    }
    last_mm_.reset();
}

std::optional<RunResult> LinuxCncPlant::take_result() {
    std::optional<RunResult> taken;
    taken.swap(result_);
    return taken;
}

}  // namespace millforce::sim
