// SPDX-License-Identifier: Apache-2.0
#include "firmware/program/check/made_recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/check_recording.hpp"
#include "machine/machine_plant.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::test {

namespace {

struct Leg {
    double duration_s;
    double x_mm_s;
    double y_mm_s;
    bool in_cut;
};

std::vector<Leg> legs_of(const RecordingSettings& settings) {
    if (!settings.has_air) {
        return {{6.0, 15.0, 0.0, true}};
    }
    const double rest_s = settings.has_rest ? 0.8 : 0.0;
    const double y_mm_s = settings.has_y ? 20.0 : 0.0;
    return {{rest_s, 0.0, 0.0, false}, {1.0, 20.0, 0.0, false},   {1.0, -20.0, 0.0, false},
            {rest_s, 0.0, 0.0, false}, {1.0, 0.0, y_mm_s, false}, {1.0, 0.0, -y_mm_s, false},
            {rest_s, 0.0, 0.0, false}, {0.6, 15.0, 0.0, false},   {4.0, 15.0, 0.0, settings.has_cut},
            {0.6, 15.0, 0.0, false},   {rest_s, 0.0, 0.0, false}};
}

/// Teeth that meet an arc of 66°, each with half a sine; the runout loads them unequally by a tenth.
sim::MachinePlant::Load cutting_load(double spindle_rad, int teeth) {
    constexpr double arc_rad = 1.15;
    constexpr double peak_N = 400.0;
    constexpr double radius_m = 0.005;
    const double pitch_rad = 2.0 * std::numbers::pi / teeth;
    sim::MachinePlant::Load load;
    for (int tooth = 0; tooth < teeth; ++tooth) {
        const double angle = std::fmod(spindle_rad + tooth * pitch_rad, 2.0 * std::numbers::pi);
        if (angle < arc_rad) {
            const double runout = 1.0 + 0.1 * std::cos(tooth * pitch_rad);
            const double force_N = peak_N * runout * std::sin(std::numbers::pi * angle / arc_rad);
            load.spindle_torque_Nm += force_N * radius_m;
            load.force_on_workpiece_N += force_N * Eigen::Vector3d(0.3, 0.6, 0.0);
        }
    }
    return load;
}

/// Follows a velocity as a CNC would, and advances the machine.
class Driven {
  public:
    explicit Driven(const RecordingSettings& settings) : settings_(settings), machine_(plant(settings)) {
        machine_.start_at(command_.position_mm, command_.spindle_speed_rad_s = rad_s(settings));
    }

    void advance(double dt_s, const Leg& leg) {
        constexpr double acceleration_mm_s2 = 2000.0;
        const Eigen::Vector3d wanted(leg.x_mm_s, leg.y_mm_s, 0.0);
        const double most_mm_s = acceleration_mm_s2 * dt_s;
        for (int k = 0; k < 3; ++k) {
            command_.velocity_mm_s[k] += std::clamp(wanted[k] - command_.velocity_mm_s[k], -most_mm_s, most_mm_s);
        }
        command_.position_mm += dt_s * command_.velocity_mm_s;
        machine_.advance(
            dt_s, command_,
            leg.in_cut ? cutting_load(machine_.spindle_angle_rad(), settings_.teeth) : sim::MachinePlant::Load{});
    }
    [[nodiscard]] sim::MachinePlant& machine() { return machine_; }

  private:
    static double rad_s(const RecordingSettings& settings) { return settings.spindle_rpm * std::numbers::pi / 30.0; }
    static sim::MachinePlantSettings plant(const RecordingSettings& settings) {
        sim::MachinePlantSettings plant;
        plant.seed = settings.seed;
        for (sim::FeedPlantSettings& axis : plant.axes) {
            axis.friction_scale = settings.friction_scale;
        }
        return plant;
    }

    RecordingSettings settings_;
    sim::MachinePlant::Command command_{};
    sim::MachinePlant machine_;
};

}  // namespace

MadeRecording made_recording(const RecordingSettings& settings) {
    constexpr double dt_s = 0.25e-3;
    const auto steps_per_sample = static_cast<int>(std::lround(1.0 / (settings.rate_hz * dt_s)));
    Driven driven(settings);
    MadeRecording recording;
    int step = 0;
    for (const Leg& leg : legs_of(settings)) {
        for (int k = 0; k < static_cast<int>(leg.duration_s / dt_s); ++k) {
            driven.advance(dt_s, leg);
            if (++step % steps_per_sample == 0) {
                recording.push_back({driven.machine().time_s(), driven.machine().sample()});
            }
        }
    }
    return recording;
}

firmware::Parameters<float> right_parameters() {
    const std::string scenarios = MILLFORCE_SOURCE_DIR "/sim/scenarios/";
    return host::read_parameters(scenarios + "machines/vmc.toml", scenarios + "tools/endmill_10mm.toml");
}

std::string lines_of(const host::Findings& findings) {
    std::string lines;
    for (const host::Finding& finding : findings) {
        lines += host::line_of(finding) + '\n';
    }
    return lines;
}

std::string lines_for(const MadeRecording& recording, const firmware::Parameters<float>& parameters, bool has_index,
                      float commanded_rad_s) {
    host::RecordingCheck check(parameters, has_index);
    const hal::ProgramStatus program{.programmed_feed_mm_s = 20.0F, .commanded_speed_rad_s = commanded_rad_s};
    for (const RecordedSample& sample : recording) {
        check.add(sample.time_s, sample.drives, program);
    }
    return lines_of(check.findings("cut.csv"));
}

}  // namespace millforce::test
