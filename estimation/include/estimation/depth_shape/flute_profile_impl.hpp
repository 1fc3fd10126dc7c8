// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of flute_profile.hpp. src/depth_monitor.cpp and src/depth_variation.cpp instantiate them.

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/depth_shape/flute_profile.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

#include <cmath>

namespace millforce::estimation {

template <typename Scalar, int Channels, int Bins>
void FluteProfile<Scalar, Channels, Bins>::restart() {
    sum_.fill(Signals::Zero());
    turned_in_bin_.fill(Scalar(0));
    turned_pitches_ = Scalar(0);
    duration_s_ = Scalar(0);
    samples_ = Scalar(0);
    pitches_ = 0;
    has_previous_ = false;
}

template <typename Scalar, int Channels, int Bins>
bool FluteProfile<Scalar, Channels, Bins>::add(Scalar dt_s, Scalar turned_rev, Scalar angle_rev,
                                               const Signals& signals) {
    if (complete()) {
        return false;
    }
    const Scalar turned = turned_rev * Scalar(settings_.teeth);
    const Scalar place = share_of_pitch(angle_rev);
    if (!signals.allFinite() || !(turned >= Scalar(0)) || !(turned < Scalar(0.5F))) {
        restart();
        return false;
    }
    if (has_previous_) {
        integrate(dt_s, turned, signals);
    }
    has_previous_ = true;
    previous_ = signals;
    place_ = place;
    return complete();
}

template <typename Scalar, int Channels, int Bins>
FluteAverage<Scalar, Channels, Bins> FluteProfile<Scalar, Channels, Bins>::average() const {
    FluteAverage<Scalar, Channels, Bins> average;
    for (std::size_t b = 0; b < sum_.size(); ++b) {
        const Scalar turned = turned_in_bin_[b];
        average.mean[b] = turned > Scalar(0) ? Signals(sum_[b] / turned) : Signals(Signals::Zero());
    }
    const Scalar pitches = Scalar(pitches_) + turned_pitches_;
    average.samples = samples_;
    average.samples_per_pitch = pitches > Scalar(0) ? samples_ / pitches : Scalar(0);
    average.spindle_speed_rev_s =
        duration_s_ > Scalar(0) ? pitches / (duration_s_ * Scalar(settings_.teeth)) : Scalar(0);
    return average;
}

template <typename Scalar, int Channels, int Bins>
Scalar FluteProfile<Scalar, Channels, Bins>::share_of_pitch(Scalar angle_rev) const {
    using std::floor;
    const Scalar pitches = angle_rev * Scalar(settings_.teeth);
    return pitches - floor(pitches);
}

/// The line from the previous sample to this one, over `turned` pitches, bin by bin.
template <typename Scalar, int Channels, int Bins>
void FluteProfile<Scalar, Channels, Bins>::integrate(Scalar dt_s, Scalar turned, const Signals& signals) {
    if (!(turned > Scalar(0))) {
        duration_s_ += dt_s;
        return;
    }
    const Scalar left = Scalar(settings_.teeth * settings_.revolutions - pitches_) - turned_pitches_;
    const Scalar taken = turned < left ? turned : left;
    Scalar done{0};
    auto bin = static_cast<int>(place_ * Scalar(Bins));
    bin = bin < Bins ? bin : Bins - 1;
    Scalar border = Scalar(bin + 1) / Scalar(Bins) - place_;
    while (done < taken) {
        const Scalar end = border < taken ? border : taken;
        const Scalar width = end > done ? end - done : Scalar(0);
        const Scalar middle = (done + Scalar(0.5F) * width) / turned;
        const auto b = static_cast<std::size_t>(bin);
        sum_[b] += (previous_ + (signals - previous_) * middle) * width;
        turned_in_bin_[b] += width;
        done = end;
        border += Scalar(1) / Scalar(Bins);
        bin = bin + 1 < Bins ? bin + 1 : 0;
    }
    const Scalar share = taken / turned;
    duration_s_ += share * dt_s;
    samples_ += share;
    turned_pitches_ += taken;
    // Whole pitches are counted apart: a float's sum of small steps must not lose the end of the last revolution.
    while (turned_pitches_ >= Scalar(1)) {
        turned_pitches_ -= Scalar(1);
        ++pitches_;
    }
    if (turned >= left) {
        pitches_ = settings_.teeth * settings_.revolutions;
        turned_pitches_ = Scalar(0);
    }
}

template <typename Scalar, int Channels, int Bins>
std::array<typename FluteProfile<Scalar, Channels, Bins>::Signals, static_cast<std::size_t>(Bins)>
FluteProfile<Scalar, Channels, Bins>::zeros() {
    std::array<Signals, static_cast<std::size_t>(Bins)> all;
    all.fill(Signals::Zero());
    return all;
}

template <int Harmonics, typename Scalar, int Channels, int Bins>
ProfileSpectrum<Scalar, Harmonics> profile_spectrum(const FluteAverage<Scalar, Channels, Bins>& average) {
    static_assert(Channels >= 2);
    using std::sin;
    ProfileSpectrum<Scalar, Harmonics> spectrum;
    spectrum.spindle_speed_rev_s = average.spindle_speed_rev_s;
    constexpr Scalar below_nyquist = literal<Scalar>(0.45L);
    const Scalar resolved = below_nyquist * average.samples_per_pitch;
    spectrum.highest =
        average.samples_per_pitch > Scalar(0) && resolved < Scalar(Harmonics) ? static_cast<int>(resolved) : Harmonics;
    constexpr auto middle = static_cast<std::size_t>(Harmonics);
    const auto sinc = [](Scalar x) { return x > Scalar(0) ? sin(x) / x : Scalar(1); };
    for (int k = 0; k <= Harmonics; ++k) {
        const Scalar turn = Scalar(2) * pi<Scalar> * Scalar(k) / Scalar(Bins);
        const Phasor<Scalar> step = turned_by(-turn);
        Phasor<Scalar> at_bin = turned_by(Scalar(-0.5F) * turn);
        Phasor<Scalar> x;
        Phasor<Scalar> y;
        for (const auto& mean : average.mean) {
            x += at_bin * mean[0];
            y += at_bin * mean[1];
            at_bin = at_bin * step;
        }
        Scalar kept = Scalar(Bins) * sinc(Scalar(0.5F) * turn);
        if (average.samples_per_pitch > Scalar(2 * k)) {
            kept *= square(sinc(pi<Scalar> * Scalar(k) / average.samples_per_pitch));
        }
        const Scalar scale = Scalar(1) / kept;
        // x_{−k} and y_{−k} are the conjugates, for both signals are real.
        const auto order = static_cast<std::size_t>(k);
        spectrum.line[middle + order] = Phasor<Scalar>{x.re - y.im, x.im + y.re} * scale;
        spectrum.line[middle - order] = Phasor<Scalar>{x.re + y.im, y.re - x.im} * scale;
    }
    return spectrum;
}

}  // namespace millforce::estimation
