// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cutting/angle_units.hpp"
#include "estimation/depth_shape/depth_monitor.hpp"
#include "estimation/depth_shape/depth_variation.hpp"
#include "reproduce/force_record.hpp"

/// From a force record to what the estimators take: profiles of one signal, and a monitor that has seen it all.

namespace millforce::sim::yang {

inline constexpr int profile_revolutions = 20;
inline constexpr int index_bins = 720;
using IndexProfile = estimation::FluteAverage<float, 1, index_bins>;

inline float single(double value) {
    return static_cast<float>(value);
}

inline double resultant_N(const ForceSample& sample) {
    return std::hypot(sample.fx_N, sample.fy_N, sample.fz_N);
}
inline double scalar_sum_N(const ForceSample& sample) {
    return sample.scalar_sum_N;
}

/// The flute average of the signal that `signal` makes of a sample.
template <typename Signal>
IndexProfile flute_average(const std::vector<ForceSample>& record, const ForceSensor& sensor, std::size_t teeth,
                           const Signal& signal) {
    using Profile = estimation::FluteProfile<float, 1, index_bins>;
    Profile profile({.teeth = static_cast<int>(teeth), .revolutions = profile_revolutions});
    const auto per_revolution = static_cast<std::size_t>(sensor.samples_per_revolution);
    const double step_rev = 1.0 / static_cast<double>(per_revolution);
    for (std::size_t i = 0; i < record.size() && !profile.complete(); ++i) {
        const double angle_rev = static_cast<double>(i % per_revolution) * step_rev;
        typename Profile::Signals value;
        value << single(signal(record[i]));
        profile.add(single(step_rev / sensor.spindle_speed_rev_s), single(i > 0 ? step_rev : 0.0), single(angle_rev),
                    value);
    }
    return profile.average();
}

/// Restarts the monitor with this record's plane forces.
inline void feed(const std::vector<ForceSample>& record, const ForceSensor& sensor,
                 estimation::DepthMonitor<float>& monitor) {
    monitor.restart();
    const auto per_revolution = static_cast<std::size_t>(sensor.samples_per_revolution);
    const double step_rad = turn / static_cast<double>(per_revolution);
    const double dt_s = 1.0 / (sensor.spindle_speed_rev_s * static_cast<double>(per_revolution));
    for (std::size_t i = 0; i < record.size(); ++i) {
        const double angle_rad = static_cast<double>(i % per_revolution) * step_rad;
        if (monitor.add(single(dt_s), single(angle_rad), single(record[i].fx_N), single(record[i].fy_N))) {
            return;
        }
    }
}

inline estimation::FluteGeometry<float> geometry_of(const Cutter& cutter) {
    return {static_cast<int>(cutter.teeth), single(0.5 * cutter.diameter_mm), single(cutter.helix_rad)};
}

inline estimation::DepthsOfCut<float> depths_of(const SteadyCut& cut) {
    return {single(cut.axial_depth_mm), single(cut.radial_depth_mm)};
}

/// A fit around nominal depths: ±55 %, so that a cut at ±50 % is not at the end of the search.
inline estimation::FluteProfileFitSettings<float> fit_settings(const SteadyCut& nominal, const ForceSensor& sensor) {
    constexpr double reach = 0.55;
    estimation::FluteProfileFitSettings<float> settings;
    settings.cutter = geometry_of(nominal.cutter);
    settings.feed_per_tooth_mm = single(nominal.feed_per_tooth_mm);
    settings.side = nominal.up_milling ? estimation::CutSide::up : estimation::CutSide::down;
    settings.axial = {single((1.0 - reach) * nominal.axial_depth_mm), single((1.0 + reach) * nominal.axial_depth_mm)};
    settings.radial = {single((1.0 - reach) * nominal.radial_depth_mm),
                       single(std::min((1.0 + reach) * nominal.radial_depth_mm, nominal.cutter.diameter_mm))};
    settings.low_pass = {2, single(sensor.low_pass_Hz)};
    return settings;
}

}  // namespace millforce::sim::yang
