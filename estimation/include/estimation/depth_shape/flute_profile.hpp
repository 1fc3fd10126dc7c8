// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/depth_shape/detail/phasor.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>

/// The flute-average method (FAM; Yang, DeVor & Kapoor, section 3) as samples come in: signals averaged over all
/// stretches of the rotation that lie one tooth pitch φ_N apart, over whole revolutions. What remains is one profile
/// over one pitch.
///
/// Of F_x and F_y it is free of runout: what a protruding tooth cuts in excess, the next tooth does not cut, and the
/// sum of the chips at one angle stays that of equal teeth. It holds exactly for the part of the force that is linear
/// in the chip thickness, as long as any tooth cuts there. Of the resultant |F| (the paper's signal) it holds to first
/// order only, for a magnitude is not linear: average the components where both are known.
///
/// Samples come at any rate, evenly or not. Each signal is taken as linear between two samples and integrated over the
/// angle turned, and the integral is split exactly at the bins' borders. A gap or a step back of more than half a pitch
/// restarts the profile.
///
/// Memory: (Channels + 1)·Bins + some 10 scalars. Cost of add(): the bins that were passed, at least one; a few
/// operations each. No heap. Not thread-safe.

namespace millforce::estimation {

/// One profile over one pitch. Bin b is the mean over pitch shares b/Bins…(b + 1)/Bins; share 0: tooth 0 at angle 0.
template <typename Scalar, int Channels, int Bins>
struct FluteAverage {
    std::array<Eigen::Matrix<Scalar, Channels, 1>, static_cast<std::size_t>(Bins)> mean{};
    Scalar spindle_speed_rev_s{0};
    Scalar samples_per_pitch{0};  ///< of the raw signal, per tooth
    Scalar samples{0};            ///< in all
};

template <typename Scalar, int Channels = 2, int Bins = 180>
class FluteProfile {
    static_assert(Channels >= 1 && Bins >= 8);

  public:
    using Signals = Eigen::Matrix<Scalar, Channels, 1>;

    struct Settings {
        int teeth = 4;         ///< N of equal pitch, 1…12
        int revolutions = 20;  ///< of one profile, 1…1000
    };

    explicit FluteProfile(const Settings& settings = {}) : settings_(settings) {}

    void restart() {
        sum_.fill(Signals::Zero());
        turned_in_bin_.fill(Scalar(0));
        turned_pitches_ = Scalar(0);
        duration_s_ = Scalar(0);
        samples_ = Scalar(0);
        pitches_ = 0;
        has_previous_ = false;
    }

    /// Adds one sample. `turned_rev` since the last one (0 ≤ turned < half a pitch, else the profile starts anew),
    /// `angle_rev` after it (0…1). True where the profile has become complete: average() then holds it, until the
    /// next add() after restart(); further samples are not taken before that.
    bool add(Scalar dt_s, Scalar turned_rev, Scalar angle_rev, const Signals& signals) {
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

    [[nodiscard]] bool complete() const { return pitches_ >= settings_.teeth * settings_.revolutions; }

    [[nodiscard]] FluteAverage<Scalar, Channels, Bins> average() const {
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

  private:
    [[nodiscard]] Scalar share_of_pitch(Scalar angle_rev) const {
        using std::floor;
        const Scalar pitches = angle_rev * Scalar(settings_.teeth);
        return pitches - floor(pitches);
    }

    /// The line from the previous sample to this one, over `turned` pitches, bin by bin.
    void integrate(Scalar dt_s, Scalar turned, const Signals& signals) {
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

    Settings settings_;
    std::array<Signals, static_cast<std::size_t>(Bins)> sum_ = zeros();
    std::array<Scalar, static_cast<std::size_t>(Bins)> turned_in_bin_{};
    Signals previous_ = Signals::Zero();
    Scalar place_{0};           ///< of the previous sample in its pitch, 0…1
    Scalar turned_pitches_{0};  ///< beyond the whole ones
    Scalar duration_s_{0};
    Scalar samples_{0};
    int pitches_ = 0;
    bool has_previous_ = false;

    static std::array<Signals, static_cast<std::size_t>(Bins)> zeros() {
        std::array<Signals, static_cast<std::size_t>(Bins)> all;
        all.fill(Signals::Zero());
        return all;
    }
};

/// Fourier coefficients of a profile's plane force F_x + iF_y over the pitch: c_k at k·N per revolution, k = −K…K.
template <typename Scalar, int Harmonics>
struct ProfileSpectrum {
    static constexpr std::size_t lines = 2U * static_cast<std::size_t>(Harmonics) + 1U;
    std::array<Phasor<Scalar>, lines> line{};  ///< [k + K]
    Scalar spindle_speed_rev_s{0};
    int highest = Harmonics;  ///< above it the samples do not tell a harmonic from its aliases
};

/// Channels 0 and 1 are F_x and F_y. Attenuation from bin width and interpolation, sinc(πk/Bins) and sinc²(πk/samples
/// per pitch), is corrected. Harmonics with fewer than 2.2 samples per period lie above `highest` (an average without
/// samples_per_pitch is taken to be fine enough). Cost: 4·Harmonics·Bins products.
template <int Harmonics, typename Scalar, int Channels, int Bins>
ProfileSpectrum<Scalar, Harmonics> profile_spectrum(const FluteAverage<Scalar, Channels, Bins>& average) {
    static_assert(Channels >= 2);
    using std::sin;
    ProfileSpectrum<Scalar, Harmonics> spectrum;
    spectrum.spindle_speed_rev_s = average.spindle_speed_rev_s;
    constexpr Scalar below_nyquist = literal<Scalar>(0.45L);
    const Scalar told = below_nyquist * average.samples_per_pitch;
    spectrum.highest =
        average.samples_per_pitch > Scalar(0) && told < Scalar(Harmonics) ? static_cast<int>(told) : Harmonics;
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
