// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "hal/drive_sample.hpp"
#include "machine/drive_plant.hpp"
#include "machine/force_sensor.hpp"
#include "machine/load_meter.hpp"

namespace millforce::sim {

/// The machine as a whole: one spindle, three feed axes, and their sensors.
struct MachinePlantSettings {
    SpindlePlantSettings spindle{};
    std::array<FeedPlantSettings, 3> axes = standard_axes();
    CurrentChannel current_channel = CurrentChannel::per_mille_int16;
    double current_noise_share = 0.01;        ///< share of the rated current, per sample
    double velocity_resolution_mm_s = 0.001;  ///< resolution of the drive's velocity object
    std::uint32_t encoder_counts_per_rev = 8192;
    double index_offset_rad = 1.0;       ///< the index may be anywhere relative to tooth 0
    ForceSensorSettings force_sensor{};  ///< under the workpiece
    LoadMeterSettings load_meter{};      ///< replaces the spindle's own current
    std::uint64_t seed = 1;

    /// A table that weighs 250 kg in x, 320 kg in y, and a head of 180 kg in z that a weight pulls down.
    static std::array<FeedPlantSettings, 3> standard_axes();
};

class MachinePlant {
  public:
    explicit MachinePlant(const MachinePlantSettings& settings);

    void start_at(const Eigen::Vector3d& position_mm, double spindle_speed_rad_s);
    void set_clock(double time_s) { time_s_ = time_s; }

    struct Command {
        Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
        Eigen::Vector3d velocity_mm_s = Eigen::Vector3d::Zero();
        double spindle_speed_rad_s = 0.0;
    };
    struct Load {
        Eigen::Vector3d force_on_workpiece_N = Eigen::Vector3d::Zero();  ///< in machine axes
        double spindle_torque_Nm = 0.0;
    };
    void advance(double dt_s, const Command& command, const Load& load);

    /// What the drives report now. The time is the machine's, in µs.
    [[nodiscard]] hal::DriveSample sample();

    [[nodiscard]] Eigen::Vector3d position_mm() const;
    [[nodiscard]] Eigen::Vector3d velocity_mm_s() const;
    [[nodiscard]] double spindle_angle_rad() const { return spindle_.angle_rad(); }
    [[nodiscard]] double spindle_speed_rad_s() const { return spindle_.speed_rad_s(); }
    [[nodiscard]] double time_s() const { return time_s_; }

  private:
    void advance_force_sensor(double dt_s, const Eigen::Vector3d& force_N);

    MachinePlantSettings settings_;
    SpindlePlant spindle_;
    std::array<FeedPlant, 3> axes_;
    CurrentSensor spindle_sensor_;
    std::array<CurrentSensor, 3> axis_sensors_;
    LoadMeter load_meter_;
    EncoderSensor encoder_;
    std::vector<ForceChannel> force_channels_;  ///< x and y; made with the first step, which sets their rate
    double time_s_ = 0.0;
};

}  // namespace millforce::sim
