// SPDX-License-Identifier: Apache-2.0
#include "reproduce/kim_campaign.hpp"

#include "cutting/angle_units.hpp"
#include "cutting/cutting_force.hpp"
#include "estimation/cutting/cut_geometry.hpp"
#include "estimation_calibration/friction_fit.hpp"
#include "machine/machine_plant.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace millforce::sim {

namespace {

constexpr double plant_step_s = 0.25e-3;
constexpr int steps_per_sample = 4;
constexpr double settling_mm = 2.0;
constexpr double screw_pitch_mm = 10.0;
constexpr double least_measured_s = 6.0;
constexpr double spindle_rad_s = KimStandardCut::spindle_rpm * turn / 60.0;

struct PlantForce {
    double feed_N = 0.0;
    double normal_N = 0.0;
    double torque_Nm = 0.0;
};

double plant_feed_per_tooth_mm(const KimCut& cut) {
    return cut.feed_mm_min / (KimStandardCut::flutes * KimStandardCut::spindle_rpm);
}

/// The plant's force over one tooth pitch, looked up by the spindle's angle.
class PitchForce {
  public:
    PitchForce() = default;
    PitchForce(const AverageChipLaw& law, const KimCut& cut) : cutting_(cut.radial_width_mm > 0.0) {
        if (!cutting_) {
            return;
        }
        Cutter cutter;
        cutter.teeth = KimStandardCut::flutes;
        cutter.diameter_mm = KimStandardCut::diameter_mm;
        cutter.flute_length_mm = 19.0;
        cutter.helix_rad = std::numbers::pi / 6.0;  // not printed
        const auto side = cut.up ? estimation::CutSide::up : estimation::CutSide::down;
        const auto angles =
            estimation::engagement_angles(side, 2.0 * cut.radial_width_mm / KimStandardCut::diameter_mm);
        const double f_z = plant_feed_per_tooth_mm(cut);
        const double t_a =
            f_z * (std::cos(angles.entry_rad) - std::cos(angles.exit_rad)) / (angles.exit_rad - angles.entry_rad);
        // The paper's chip, h = f_z sin φ. It keeps the volume of a narrow cut, f_z a_e, exactly.
        const CuttingForce force(cutter, coefficients_at(law, t_a), {.chip_model = ChipModel::circular});
        const EngagementMap map = uniform_engagement(angles.entry_rad, angles.exit_rad, cut.axial_depth_mm);
        for (std::size_t k = 0; k < points; ++k) {
            const double angle = pitch_rad * (static_cast<double>(k) + 0.5) / static_cast<double>(points);
            const CuttingLoad load = force.load(angle, f_z, map);
            table_[k] = {load.fx_N, load.fy_N, load.spindle_torque_Nm};
        }
    }

    [[nodiscard]] MachinePlant::Load at(double angle_rad) const {
        if (!cutting_) {
            return {};
        }
        const double turns = angle_rad / pitch_rad;
        const auto k = static_cast<std::size_t>((turns - std::floor(turns)) * static_cast<double>(points));
        const PlantForce& force = table_[std::min(k, points - 1)];
        return {.force_on_workpiece_N = {force.feed_N, force.normal_N, 0.0}, .spindle_torque_Nm = force.torque_Nm};
    }

  private:
    static constexpr std::size_t points = 180;
    static constexpr double pitch_rad = turn / KimStandardCut::flutes;
    bool cutting_ = false;
    std::array<PlantForce, points> table_{};
};

MachinePlantSettings plant_settings(const KimMachine& machine, std::uint64_t noise) {
    MachinePlantSettings settings;
    settings.seed = 1000 * machine.seed + noise;
    settings.spindle.torque_constant_Nm_per_A = machine.torque_constant_Nm_per_A;
    settings.spindle.friction_scale = machine.friction_scale;
    for (FeedPlantSettings& axis : settings.axes) {
        axis.force_constant_N_per_A = machine.force_constant_N_per_A;
        axis.friction_scale = machine.friction_scale;
    }
    return settings;
}

host::DriveReading reading_of(const hal::DriveSample& sample, double time_s, double angle_rad) {
    host::DriveReading reading{time_s, angle_rad, static_cast<double>(sample.spindle_current_A), {}, {}};
    for (std::size_t k = 0; k < reading.axis_current_A.size(); ++k) {
        reading.axis_current_A[k] = static_cast<double>(sample.axis_current_A[k]);
        reading.axis_velocity_mm_s[k] = static_cast<double>(sample.axis_velocity_mm_s[k]);
    }
    return reading;
}

/// Runs a machine stretch by stretch along x.
class StretchRunner {
  public:
    StretchRunner(const KimMachine& machine, std::uint64_t noise)
        : plant_(plant_settings(machine, noise)), place_mm_(machine.start_mm) {
        plant_.start_at({place_mm_, 0.0, 0.0}, spindle_rad_s);
    }

    /// 2 mm to settle, then whole turns of the screw that are averaged; `direction` +1 or −1.
    host::RecordedStretch run(const AverageChipLaw& law, const KimCut& cut, double direction = 1.0) {
        const double feed_mm_s = direction * cut.feed_mm_min / 60.0;
        const PitchForce force(law, cut);
        const double start_s = plant_.time_s();
        const double settled_s = start_s + settling_mm / std::abs(feed_mm_s);
        // Whole turns of the screw: its ripple averages out.
        const double turns = std::ceil(least_measured_s * std::abs(feed_mm_s) / screw_pitch_mm);
        const double end_s = settled_s + turns * screw_pitch_mm / std::abs(feed_mm_s);
        host::StretchAverage average;
        for (long step = 1; plant_.time_s() < end_s; ++step) {
            place_mm_ += feed_mm_s * plant_step_s;
            plant_.advance(plant_step_s,
                           {.position_mm = {place_mm_, 0.0, 0.0},
                            .velocity_mm_s = {feed_mm_s, 0.0, 0.0},
                            .spindle_speed_rad_s = spindle_rad_s},
                           force.at(plant_.spindle_angle_rad()));
            if (step % steps_per_sample == 0) {
                const hal::DriveSample sample = plant_.sample();
                if (plant_.time_s() >= settled_s) {
                    average.add(reading_of(sample, plant_.time_s(), plant_.spindle_angle_rad()));
                }
            }
        }
        host::StretchConditions conditions;
        conditions.recording = "simulated";
        conditions.place = "simulated";
        conditions.start_s = settled_s;
        conditions.end_s = end_s;
        conditions.tool_diameter_mm = KimStandardCut::diameter_mm;
        conditions.flutes = KimStandardCut::flutes;
        conditions.axial_depth_mm = cut.radial_width_mm > 0.0 ? cut.axial_depth_mm : 0.0;
        conditions.radial_width_mm = cut.radial_width_mm;
        return average.stretch(conditions);
    }

  private:
    MachinePlant plant_;
    double place_mm_;
};

/// Step 1: the friction current of x in both directions.
std::vector<KimAirCut> simulate_air_cuts(const KimMachine& machine) {
    StretchRunner runner(machine, 1);
    std::vector<KimAirCut> air;
    for (const double feed_mm_min : {100.0, 175.0, 250.0, 350.0, 500.0, 700.0, 1000.0}) {
        for (const double direction : {1.0, -1.0}) {
            const host::RecordedStretch stretch = runner.run({}, {feed_mm_min, 0.0, 0.0}, direction);
            air.push_back({stretch.feed_m_per_min(), stretch.axis_current_A});
        }
    }
    return air;
}

void fill_friction(const std::vector<KimAirCut>& air, host::MachineParameters& machine) {
    estimation::FeedCurrentFit fit;
    for (const KimAirCut& cut : air) {
        fit.add(cut.feed_m_per_min, cut.current_A);
    }
    const auto p = fit.solve().parameters;
    auto& x = machine.axes[0];
    x.positive = {static_cast<float>(p(estimation::positive_K_x1)), static_cast<float>(p(estimation::positive_K_x2))};
    x.negative = {static_cast<float>(p(estimation::negative_K_x1)), static_cast<float>(p(estimation::negative_K_x2))};
    x.K_x3_A = static_cast<float>(p(estimation::common_K_x3));
    x.gravity_A = static_cast<float>(p(estimation::gravity_offset));
}

}  // namespace

KimMachine KimMachine::numbered(std::uint64_t number) {
    KimMachine machine;
    machine.seed = number;
    if (number > 1) {
        std::mt19937_64 random(number);
        const auto within = [&](double share) {
            return 1.0 + share * (2.0 * static_cast<double>(random() >> 11) * 0x1.0p-53 - 1.0);
        };
        machine.torque_constant_Nm_per_A *= within(0.1);
        machine.force_constant_N_per_A *= within(0.1);
        machine.friction_scale *= within(0.2);
        machine.start_mm = 5.0 * within(1.0);
    }
    return machine;
}

std::vector<host::RecordedStretch> simulate_cuts(const KimMachine& machine, const AverageChipLaw& law,
                                                 const std::vector<KimCut>& cuts, std::uint64_t noise) {
    StretchRunner runner(machine, noise);
    std::vector<host::RecordedStretch> stretches;
    for (const KimCut& cut : cuts) {
        stretches.push_back(runner.run(law, {cut.feed_mm_min, 0.0, 0.0}));
        stretches.push_back(runner.run(law, cut));
    }
    stretches.push_back(runner.run(law, {cuts.back().feed_mm_min, 0.0, 0.0}));
    return stretches;
}

std::vector<KimCut> kim_standard_cuts() {
    return {{100.0}, {175.0}, {250.0}, {400.0}, {700.0}, {250.0, 0.4}, {250.0, 1.6}};
}

std::vector<KimCut> kim_unknown_cuts() {
    return {{100.0, 0.4}, {100.0, 0.8}, {250.0, 0.2}, {250.0, 0.8}, {250.0, 2.0},
            {450.0, 0.4}, {450.0, 1.6}, {700.0, 0.2}, {700.0, 0.8}, {700.0, 2.0}};
}

estimation::CuttingLaw<double> closed_law(const AverageChipLaw& law) {
    estimation::CuttingLaw<double> closed;
    closed.k_s_N_per_mm2 = law.k_s;
    closed.p_s = law.p_s;
    closed.k_1 = law.k_1;
    closed.p_1 = law.p_1;
    return closed;
}

KimCampaign calibrate_machine(const KimMachine& machine, const AverageChipLaw& database) {
    KimCampaign campaign;
    campaign.machine = machine;
    campaign.air_cuts = simulate_air_cuts(machine);
    host::MachineParameters& calibrated = campaign.calibrated;
    calibrated.spindle.K_t1_Nm_per_A = 0.7F;     // the data sheets'
    calibrated.spindle.warm_up_time_s = 240.0F;  // from a separate calibration: see warm_up_fit.hpp
    calibrated.axes[0].K_x4_N_per_A = 120.0F;
    fill_friction(campaign.air_cuts, calibrated);
    campaign.standard_cuts = simulate_cuts(machine, database, kim_standard_cuts(), 2);
    campaign.gains =
        host::standard_cut_gains(campaign.standard_cuts, calibrated, closed_law(database), estimation::CutSide::down);
    const auto& spindle = campaign.gains.spindle;
    const auto& feed = *campaign.gains.axes[0];
    calibrated.spindle.K_t1_Nm_per_A = static_cast<float>(spindle.gain);
    calibrated.spindle.K_t2_Nm = static_cast<float>(spindle.offset);
    calibrated.axes[0].K_x4_N_per_A = static_cast<float>(feed.gain);
    calibrated.axes[0].K_x5_N_m_per_min = static_cast<float>(feed.offset);
    campaign.gain_doubt = {spindle.gain_se / spindle.gain, feed.gain_se / feed.gain, 0.0};
    const SpindlePlantSettings plant = plant_settings(machine, 2).spindle;
    campaign.idle_torque_Nm =
        plant.friction_scale * (plant.bearing_torque_Nm + plant.bearing_viscous_Nm_s * spindle_rad_s);
    return campaign;
}

KimUnknownTool calibrate_tool(const KimCampaign& campaign, const AverageChipLaw& law, std::uint64_t noise) {
    KimUnknownTool tool;
    tool.stretches = simulate_cuts(campaign.machine, law, kim_unknown_cuts(), noise);
    tool.cuts = host::forces_of_cuts(tool.stretches, campaign.calibrated);
    tool.fit = host::fit_cuts_from_currents(tool.cuts, estimation::CuttingLawForm::power, estimation::CutSide::down,
                                            campaign.gain_doubt);
    return tool;
}

}  // namespace millforce::sim
