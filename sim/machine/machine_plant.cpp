// SPDX-License-Identifier: Apache-2.0
#include "machine/machine_plant.hpp"

#include <cmath>

namespace millforce::sim {

namespace {

CurrentSensor axis_sensor(const MachinePlantSettings& settings, std::size_t axis) {
    return {settings.current_channel, settings.axes[axis].rated_current_A, settings.current_noise_share,
            settings.seed * 4U + axis + 1U};
}

}  // namespace

std::array<FeedPlantSettings, 3> MachinePlantSettings::standard_axes() {
    FeedPlantSettings x;
    FeedPlantSettings y = x;
    y.mass_kg = 320.0;
    y.coulomb_positive_N = 230.0;
    y.coulomb_negative_N = 215.0;
    FeedPlantSettings z = x;
    z.mass_kg = 180.0;
    z.weight_N = 180.0 * 9.81 * 0.35;  // the rest hangs on the counterbalance
    return {x, y, z};
}

MachinePlant::MachinePlant(const MachinePlantSettings& settings)
    : settings_(settings),
      spindle_(settings.spindle),
      axes_{FeedPlant(settings.axes[0]), FeedPlant(settings.axes[1]), FeedPlant(settings.axes[2])},
      spindle_sensor_(settings.current_channel, settings.spindle.rated_current_A, settings.current_noise_share,
                      settings.seed * 4U),
      axis_sensors_{axis_sensor(settings, 0), axis_sensor(settings, 1), axis_sensor(settings, 2)},
      load_meter_(settings.load_meter),
      encoder_(settings.encoder_counts_per_rev, settings.index_offset_rad) {}

void MachinePlant::start_at(const Eigen::Vector3d& position_mm, double spindle_speed_rad_s) {
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        axes_[k].start_at(position_mm[static_cast<Eigen::Index>(k)]);
    }
    spindle_.start_at(spindle_speed_rad_s);
    load_meter_.start_at(spindle_.current_A());
}

void MachinePlant::advance(double dt_s, const Command& command, const Load& load) {
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        axes_[k].advance(dt_s, command.position_mm[axis], command.velocity_mm_s[axis], load.force_on_workpiece_N[axis]);
    }
    spindle_.advance(dt_s, command.spindle_speed_rad_s, load.spindle_torque_Nm);
    encoder_.update(spindle_.angle_rad());
    if (settings_.load_meter.is_there()) {
        load_meter_.advance(dt_s, spindle_sensor_.read(spindle_.current_A()));
    }
    if (settings_.force_sensor.is_there()) {
        advance_force_sensor(dt_s, load.force_on_workpiece_N);
    }
    time_s_ += dt_s;
}

void MachinePlant::advance_force_sensor(double dt_s, const Eigen::Vector3d& force_N) {
    if (force_channels_.empty()) {
        for (std::uint64_t k = 0; k < 2; ++k) {
            force_channels_.emplace_back(settings_.force_sensor, 1.0 / dt_s, settings_.seed * 2U + k);
        }
    }
    for (std::size_t k = 0; k < force_channels_.size(); ++k) {
        force_channels_[k].step(force_N[static_cast<Eigen::Index>(k)]);
    }
}

hal::DriveSample MachinePlant::sample() {
    hal::DriveSample sample;
    sample.time_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround(time_s_ * 1e6)));
    sample.present = hal::all_present;
    sample.spindle_count = encoder_.count();
    sample.spindle_index_count = encoder_.index_count();
    sample.spindle_index_number = encoder_.index_number();
    sample.spindle_current_A = static_cast<float>(
        settings_.load_meter.is_there() ? load_meter_.shown_A() : spindle_sensor_.read(spindle_.current_A()));
    const double step = settings_.velocity_resolution_mm_s;
    for (std::size_t k = 0; k < axes_.size(); ++k) {
        sample.axis_current_A[k] = static_cast<float>(axis_sensors_[k].read(axes_[k].current_A()));
        sample.axis_velocity_mm_s[k] = static_cast<float>(std::round(axes_[k].velocity_mm_s() / step) * step);
    }
    for (std::size_t k = 0; k < force_channels_.size(); ++k) {
        sample.force_N[k] = static_cast<float>(force_channels_[k].reading_N());
        sample.present |= hal::mask(hal::Present::force_sensor);
    }
    return sample;
}

Eigen::Vector3d MachinePlant::position_mm() const {
    return {axes_[0].position_mm(), axes_[1].position_mm(), axes_[2].position_mm()};
}

Eigen::Vector3d MachinePlant::velocity_mm_s() const {
    return {axes_[0].velocity_mm_s(), axes_[1].velocity_mm_s(), axes_[2].velocity_mm_s()};
}

}  // namespace millforce::sim
