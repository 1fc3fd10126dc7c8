// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "calibration/calibration_report.hpp"
#include "calibration/force_drop_calibration.hpp"
#include "calibration/plausible_units.hpp"
#include "calibration/recorded_forces.hpp"
#include "estimation/depth_shape/depth_monitor.hpp"
#include "estimation/number/circle.hpp"
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "firmware/wide_band_settings.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {

using DepthMonitor = estimation::DepthMonitor<float>;
using TipAngle = estimation::Measurement<float>;

constexpr double rad_in_deg = 360.0 / estimation::turn_rad<double>;

/// The known depths are the nominal ones while the angle is sought.
DepthMonitor monitor_of(const StretchConditions& cut, firmware::ToolParameters<float> tool) {
    tool.depth_shape.nominal_axial_depth_mm = static_cast<float>(cut.axial_depth_mm);
    tool.depth_shape.nominal_radial_width_mm = static_cast<float>(cut.radial_width_mm);
    tool.depth_shape.tip_angle_sd_deg = 0.0F;
    return DepthMonitor(firmware::depth_shape_settings(tool), tool.depth_shape.revolutions);
}

void refuse_tools_without_shape(const ForceShapeCalibrationOptions& options,
                                const firmware::ToolParameters<float>& tool) {
    const auto refuse = [&](std::string_view why) {
        throw InputError(fmt::format("{}: {}", options.tool.string(), why));
    };
    if (!firmware::force_has_shape(tool) || tool.side == estimation::CutSide::unknown) {
        refuse("the angle of the tips takes helix_deg of at least 5 and side = \"down\" or \"up\"");
    }
    if (!firmware::has_force_sensor(tool)) {
        refuse("no low_pass_hz in [force_sensor], expected the force sensor's low-pass");
    }
    if (!(tool.depth_shape.feed_per_tooth_mm > 0.0F)) {
        refuse("no feed_per_tooth_mm in [depth_shape], expected that of the cuts");
    }
}

/// The shape is that of one feed per tooth: at another one the angle would not be that of the tips.
void refuse_another_feed(const StretchConditions& cut, const RecordedCutAverages& average,
                         const firmware::ToolParameters<float>& tool) {
    constexpr double largest_ratio = 3.0;
    if (average.spindle_rad_s == 0.0) {
        return;
    }
    const double feed_per_tooth_mm = average.feed_per_tooth_mm(cut.flutes);
    const double ratio = feed_per_tooth_mm / static_cast<double>(tool.depth_shape.feed_per_tooth_mm);
    if (ratio > largest_ratio || ratio < 1.0 / largest_ratio) {
        throw InputError(fmt::format(
            "{}: {:.3g} mm per tooth, and [depth_shape] of the tool's file has {:g}; expected a third to three times "
            "that; is a velocity in m/min or mm/min, or spindle_angle_rad in another unit?",
            cut.place, feed_per_tooth_mm, tool.depth_shape.feed_per_tooth_mm));
    }
}

struct FoundAngles {
    std::vector<TipAngle> of_cuts;
    std::vector<RecordedCutAverages> averages;
};

FoundAngles angles_of(const ForceShapeCalibrationOptions& options, const firmware::Parameters<float>& parameters,
                      const std::vector<StretchConditions>& cuts) {
    std::vector<DepthMonitor> monitors;
    FoundAngles found;
    std::vector<TipAngle>& angles = found.of_cuts;
    angles.resize(cuts.size());
    monitors.reserve(cuts.size());
    for (const StretchConditions& cut : cuts) {
        monitors.push_back(monitor_of(cut, parameters.tool));
    }
    found.averages =
        read_recorded_forces(options.data, cuts, parameters, [&](std::size_t k, float dt_s, const FeedForces& forces) {
            if (!forces.valid || forces.is_new_frame) {
                monitors[k].restart();
            }
            if (forces.valid &&
                monitors[k].add(dt_s, forces.angle_rev * estimation::turn_rad<float>, forces.along_N,
                                forces.across_N) &&
                !angles[k].valid) {
                const estimation::DepthsOfCut<float> known{static_cast<float>(cuts[k].axial_depth_mm),
                                                           static_cast<float>(cuts[k].radial_width_mm)};
                angles[k] = monitors[k].learn_tip_angle(known) ? monitors[k].tip_angle_rad() : TipAngle{};
            }
        });
    refuse_implausible_cuts(cuts, found.averages);
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        refuse_another_feed(cuts[k], found.averages[k], parameters.tool);
    }
    return found;
}

/// The weighted mean on the circle, and how far the angles are from it in units of their deviations.
struct MeanAngle {
    double angle_rad = 0.0;
    double sd_rad = 0.0;
    double worst_disagreement = 0.0;
    std::size_t cuts = 0;
};

MeanAngle mean_of(const std::vector<TipAngle>& angles, double period_rad) {
    MeanAngle mean;
    double weights = 0.0;
    std::optional<double> first;
    double offset = 0.0;
    const auto away = [&](const TipAngle& angle) {
        return std::remainder(static_cast<double>(angle.value) - *first, period_rad);
    };
    for (const TipAngle& angle : angles) {
        if (angle.valid) {
            first = first.value_or(static_cast<double>(angle.value));
            const double weight = 1.0 / static_cast<double>(angle.variance);
            offset += weight * away(angle);
            weights += weight;
            ++mean.cuts;
        }
    }
    if (mean.cuts == 0) {
        return mean;
    }
    offset /= weights;
    mean.angle_rad = std::fmod(*first + offset + 2.0 * period_rad, period_rad);
    mean.sd_rad = 1.0 / std::sqrt(weights);
    for (const TipAngle& angle : angles) {
        if (angle.valid) {
            const double error = std::remainder(away(angle) - offset, period_rad);
            mean.worst_disagreement =
                std::max(mean.worst_disagreement, std::abs(error) / std::sqrt(static_cast<double>(angle.variance)));
        }
    }
    return mean;
}

}  // namespace

int calibrate_tip_angle(const ForceShapeCalibrationOptions& options, std::ostream& out) {
    constexpr double largest_disagreement = 4.0;
    const auto parameters = read_parameters(options.machine.string(), options.tool.string());
    refuse_tools_without_shape(options, parameters.tool);
    const auto cuts = cuts_of_tool(options.cuts, options.data, parameters.tool);
    const double pitch_rad = 2.0 * static_cast<double>(estimation::pi<float>) / parameters.tool.teeth;
    const FoundAngles found = angles_of(options, parameters, cuts);
    const MeanAngle mean = mean_of(found.of_cuts, pitch_rad);
    if (mean.cuts == 0) {
        throw InputError(
            fmt::format("{}: '{}' cannot be determined: no cut shows it; expected {} revolutions of a steady "
                        "cut of known depths, its sweep no whole number of tooth pitches",
                        options.cuts.string(), tip_angle_key.name, parameters.tool.depth_shape.revolutions));
    }
    const UnitQuestions questions = look_at_recorded_forces(options.cuts, cuts, found.averages, parameters.tool);
    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Where the teeth stand against the encoder's zero, for the depths from the force's shape.");
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.table("depth_shape");
    toml.key(tip_angle_key.name, mean.angle_rad * rad_in_deg);
    toml.key(tip_angle_doubt_key.name, mean.sd_rad * rad_in_deg);
    file.commit();
    out << fmt::format("angle of the tips {:.2f} ± {:.2f}°, from {} of {} cuts\n", mean.angle_rad * rad_in_deg,
                       mean.sd_rad * rad_in_deg, mean.cuts, cuts.size());
    return ask(out, questions, mean.worst_disagreement > largest_disagreement ? exit_bound_broken : exit_done);
}

}  // namespace millforce::host
