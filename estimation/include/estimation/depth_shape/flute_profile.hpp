// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/fixed_point.hpp"
#include "estimation/number/phasor.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>

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
/// Bodies: flute_profile_impl.hpp.

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
        int teeth = 0;        ///< N of equal pitch, 1…12
        int revolutions = 0;  ///< of one profile, 1…1000; 0: never complete
    };

    explicit FluteProfile(const Settings& settings = {}) : settings_(settings) {}

    void restart();

    /// Adds one sample. `turned_rev` since the last one (0 ≤ turned < half a pitch, else the profile starts again),
    /// `angle_rev` after it (0…1). True where the profile has become complete: average() then holds it, until the
    /// next add() after restart(); further samples are not taken before that.
    bool add(Scalar dt_s, Scalar turned_rev, Scalar angle_rev, const Signals& signals);

    [[nodiscard]] bool complete() const {
        return settings_.revolutions > 0 && pitches_ >= settings_.teeth * settings_.revolutions;
    }

    [[nodiscard]] FluteAverage<Scalar, Channels, Bins> average() const;

  private:
    [[nodiscard]] Scalar share_of_pitch(Scalar angle_rev) const;
    void integrate(Scalar dt_s, Scalar turned, const Signals& signals);

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

    static std::array<Signals, static_cast<std::size_t>(Bins)> zeros();
};

/// Fourier coefficients of a profile's plane force F_x + iF_y over the pitch: c_k at k·N per revolution, k = −K…K.
template <typename Scalar, int Harmonics>
struct ProfileSpectrum {
    static constexpr std::size_t lines = 2U * static_cast<std::size_t>(Harmonics) + 1U;
    std::array<Phasor<Scalar>, lines> line{};  ///< [k + K]
    Scalar spindle_speed_rev_s{0};
    int highest = Harmonics;  ///< above it a harmonic and its aliases cannot be distinguished
};

/// Channels 0 and 1 are F_x and F_y. Attenuation from bin width and interpolation, sinc(πk/Bins) and sinc²(πk/samples
/// per pitch), is corrected. Harmonics with fewer than 2.2 samples per period lie above `highest` (an average without
/// samples_per_pitch is taken to be fine enough). Cost: 4·Harmonics·Bins products.
template <int Harmonics, typename Scalar, int Channels, int Bins>
ProfileSpectrum<Scalar, Harmonics> profile_spectrum(const FluteAverage<Scalar, Channels, Bins>& average);

extern template class FluteProfile<float>;
extern template class FluteProfile<Fixed>;

}  // namespace millforce::estimation
