// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of depth_monitor.hpp. src/depth_monitor.cpp instantiates them for float and Fixed.

#include "estimation/depth_shape/depth_monitor.hpp"
#include "estimation/depth_shape/flute_profile_fit_impl.hpp"
#include "estimation/depth_shape/flute_profile_impl.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar, int Harmonics, int Bins>
DepthMonitor<Scalar, Harmonics, Bins>::DepthMonitor(const FluteProfileFitSettings<Scalar>& settings, int revolutions)
    : settings_(settings), profile_({.teeth = settings.cutter.teeth, .revolutions = revolutions}) {}

template <typename Scalar, int Harmonics, int Bins>
bool DepthMonitor<Scalar, Harmonics, Bins>::add(Scalar dt_s, Scalar spindle_angle_rad, Scalar fx_N, Scalar fy_N) {
    using std::floor;
    const Scalar turns = spindle_angle_rad / (Scalar(2) * pi<Scalar>);
    const Scalar angle_rev = turns - floor(turns);
    Scalar turned_rev = angle_rev - angle_rev_;
    turned_rev -= floor(turned_rev + Scalar(0.5F));
    angle_rev_ = angle_rev;
    typename FluteProfile<Scalar, 2, Bins>::Signals forces;
    forces << fx_N, fy_N;
    profile_.add(dt_s, started_ ? turned_rev : Scalar(0), angle_rev, forces);
    started_ = true;
    return profile_.complete();
}

template <typename Scalar, int Harmonics, int Bins>
typename DepthMonitor<Scalar, Harmonics, Bins>::Estimate DepthMonitor<Scalar, Harmonics, Bins>::evaluate() {
    if (!profile_.complete()) {
        return {};
    }
    const Estimate estimate = FluteProfileFit<Scalar, Harmonics>(settings_).estimate(take_spectrum());
    return estimate;
}

template <typename Scalar, int Harmonics, int Bins>
bool DepthMonitor<Scalar, Harmonics, Bins>::learn_tip_angle(const DepthsOfCut<Scalar>& known, Scalar relative_sd) {
    if (!profile_.complete()) {
        return false;
    }
    const auto angle =
        FluteProfileFit<Scalar, Harmonics>(settings_).calibrate_tip_angle(take_spectrum(), known, relative_sd);
    if (angle.valid) {
        settings_.tip_angle_rad = angle;
    }
    return angle.valid;
}

template <typename Scalar, int Harmonics, int Bins>
void DepthMonitor<Scalar, Harmonics, Bins>::restart() {
    profile_.restart();
    started_ = false;
}

template <typename Scalar, int Harmonics, int Bins>
ProfileSpectrum<Scalar, Harmonics> DepthMonitor<Scalar, Harmonics, Bins>::take_spectrum() {
    const auto spectrum = profile_spectrum<Harmonics>(profile_.average());
    profile_.restart();
    return spectrum;
}

}  // namespace millforce::estimation
