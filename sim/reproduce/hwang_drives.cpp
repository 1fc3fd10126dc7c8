// SPDX-License-Identifier: Apache-2.0
#include "reproduce/hwang_drives.hpp"

#include <cmath>

#include "cutting/angle_units.hpp"
#include "machine/machine_plant.hpp"

namespace millforce::sim {

DriveRecording drive_recording(const DriveCut& drive_cut) {
    constexpr double step_s = 1e-4;
    const BenchCut& cut = drive_cut.cut;
    MachinePlantSettings settings;
    settings.seed = drive_cut.seed;
    MachinePlant machine(settings);
    const double spindle_rad_s = cut.spindle_speed_rpm * turn / 60.0;
    machine.start_at(Eigen::Vector3d::Zero(), spindle_rad_s);
    const CuttingForce plant(bench_cutter(cut), cut.material.coefficients, {.resolution = {.axial_slices = 6}});
    const EngagementMap map = bench_engagement(cut, cut.immersion);
    const Eigen::Vector3d along(std::cos(drive_cut.feed_direction_rad), std::sin(drive_cut.feed_direction_rad), 0.0);
    const Eigen::Vector3d across(-along.y(), along.x(), 0.0);
    const Eigen::Vector3d feed_mm_s = along * (cut.feed_per_tooth_mm * cut.teeth * cut.spindle_speed_rpm / 60.0);

    DriveRecording recording;
    recording.encoder_counts_per_rev = settings.encoder_counts_per_rev;
    const long end = std::lround((drive_cut.air_s + drive_cut.cut_s) / step_s);
    const long per_sample = std::lround(drive_cut.sample_s / step_s);
    for (long step = 0; step < end; ++step) {
        const double time_s = static_cast<double>(step) * step_s;
        MachinePlant::Load load;
        if (time_s >= drive_cut.air_s) {
            const CuttingLoad force = plant.load(machine.spindle_angle_rad(), cut.feed_per_tooth_mm, map);
            load = {.force_on_workpiece_N = along * force.fx_N + across * force.fy_N,
                    .spindle_torque_Nm = force.spindle_torque_Nm};
        }
        machine.advance(
            step_s,
            {.position_mm = feed_mm_s * time_s, .velocity_mm_s = feed_mm_s, .spindle_speed_rad_s = spindle_rad_s},
            load);
        if (step % per_sample == 0) {
            const hal::DriveSample sample = machine.sample();
            if (time_s >= drive_cut.air_s + 0.5) {
                recording.samples.push_back(sample);
            }
        }
    }
    return recording;
}

}  // namespace millforce::sim
