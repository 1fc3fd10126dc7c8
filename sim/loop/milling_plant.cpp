// SPDX-License-Identifier: Apache-2.0
#include "loop/milling_plant.hpp"

#include <algorithm>
#include <cmath>

#include "cutting/angle_units.hpp"

namespace millforce::sim {

MillingPlant::MillingPlant(const Scenario& scenario)
    : scenario_(deviated(scenario, scenario.deviation, scenario.seed)),
      machine_(scenario_.machine),
      cutting_(scenario_.cutter, scenario_.coefficients, scenario_.cutting_options),
      workpiece_(workpiece_of(scenario)),
      since_tooth_before_(turn / static_cast<double>(scenario.cutter.teeth)),
      since_last_revolution_(turn),
      judge_(scenario_) {}

void MillingPlant::start_at(const Eigen::Vector3d& position_mm, double spindle_speed_rad_s) {
    machine_.start_at(position_mm, spindle_speed_rad_s);
}

void MillingPlant::set_wear(double of_section, double of_edge) {
    CuttingCoefficients worn = scenario_.coefficients;
    for (double* K : {&worn.K_tc_N_mm2, &worn.K_rc_N_mm2, &worn.K_ac_N_mm2}) {
        *K *= of_section;
    }
    for (double* K : {&worn.K_te_N_mm, &worn.K_re_N_mm, &worn.K_ae_N_mm}) {
        *K *= of_edge;
    }
    cutting_.set_coefficients(worn);
}

void MillingPlant::advance(double dt_s, const Command& command) {
    machine_.advance(dt_s, {command.position_mm, command.direction * command.feed_mm_s, command.spindle_speed_rad_s},
                     load_);
    const Eigen::Vector3d velocity = machine_.velocity_mm_s();
    path_mm_ += velocity.norm() * dt_s;
    for (FeedHistory* history : {&since_tooth_before_, &since_last_revolution_}) {
        history->add(machine_.spindle_angle_rad(), machine_.position_mm());
    }
    // While the tool stands still, the command's direction is used: the measured one would be noise.
    constexpr double standing_mm = 2e-3;
    const Eigen::Vector3d way_mm = since_last_revolution_.way_mm();
    direction_ = way_mm.norm() > standing_mm ? way_mm.normalized() : command.direction;
    if (!command.is_rapid || !scenario_.has_program()) {
        workpiece_->move_to(machine_.position_mm(), direction_, command.path_mm);
        cut(dt_s, since_tooth_before_.way_mm().norm());
    } else {
        workpiece_->move_to(machine_.position_mm(), Eigen::Vector3d::UnitZ(), command.path_mm);
        load_ = {};
    }
    judge_.observe(dt_s,
                   {machine_.position_mm(), velocity.norm(), path_mm_, command.programmed_feed_mm_s, command.is_rapid,
                    machine_.spindle_speed_rad_s(), command.override_ratio},
                   cutting_load_, workpiece_->truth());
}

/// The force over the angle that the spindle turned in this step.
void MillingPlant::cut(double dt_s, double feed_per_tooth_mm) {
    const double speed = machine_.spindle_speed_rad_s();
    cutting_load_ = {};
    load_ = {};
    if (!workpiece_->truth().cutting || !(speed > 1.0)) {
        return;
    }
    const double turned_rad = speed * dt_s;
    // φ counts from the feed's left, whatever the feed's direction; the teeth turn with the machine.
    const double angle_rad = machine_.spindle_angle_rad() + std::atan2(direction_.y(), direction_.x());
    const int points =
        std::max(1, static_cast<int>(std::ceil(turned_rad / scenario_.cutting_options.resolution.largest_turn_rad)));
    for (int k = 0; k < points; ++k) {
        const double angle = angle_rad - turned_rad * (1.0 - (k + 0.5) / points);
        const CuttingLoad part =
            cutting_.load(angle, feed_per_tooth_mm, workpiece_->engagement(), workpiece_->bounds());
        cutting_load_.fx_N += part.fx_N / points;
        cutting_load_.fy_N += part.fy_N / points;
        cutting_load_.fz_N += part.fz_N / points;
        cutting_load_.spindle_torque_Nm += part.spindle_torque_Nm / points;
        for (std::size_t tooth = 0; tooth < part.tooth_force_N.size(); ++tooth) {
            cutting_load_.tooth_force_N[tooth] =
                std::max(cutting_load_.tooth_force_N[tooth], part.tooth_force_N[tooth]);
        }
        peak_total_N_ = std::max(peak_total_N_, std::hypot(part.fx_N, part.fy_N));
    }
    const double tooth_N = *std::max_element(cutting_load_.tooth_force_N.begin(), cutting_load_.tooth_force_N.end());
    if (tooth_N > hardest_cut_.tooth_force_N) {
        hardest_cut_ = {tooth_N, feed_per_tooth_mm, workpiece_->engagement()};
    }
    judge_.observe_peak(peak_total_N_);
    peak_total_N_ = 0.0;
    const double along = std::max(direction_.head<2>().norm(), 1e-9);
    const Eigen::Vector2d t = direction_.head<2>() / along;
    load_.force_on_workpiece_N = {cutting_load_.fx_N * t.x() - cutting_load_.fy_N * t.y(),
                                  cutting_load_.fx_N * t.y() + cutting_load_.fy_N * t.x(), cutting_load_.fz_N};
    load_.spindle_torque_Nm = cutting_load_.spindle_torque_Nm;
}

}  // namespace millforce::sim
