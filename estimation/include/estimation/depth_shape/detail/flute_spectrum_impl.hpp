// SPDX-License-Identifier: Apache-2.0
#pragma once

// Bodies of flute_spectrum.hpp. Only flute_spectrum_fit_impl.hpp includes them.

#include "estimation/depth_shape/detail/flute_spectrum.hpp"
#include "estimation/number/literal.hpp"

#include <cmath>

namespace millforce::estimation {

/// A phasor at entry and at exit.
template <typename Scalar, int Harmonics>
struct FluteSpectrum<Scalar, Harmonics>::Ends {
    Phasor<Scalar> entry;
    Phasor<Scalar> exit;
};

template <typename Scalar, int Harmonics>
FluteSpectrum<Scalar, Harmonics>::FluteSpectrum(int teeth, Scalar feed_in_radii, CutSide side, int used)
    : teeth_(teeth), feed_in_radii_(feed_in_radii), side_(side), used_(used) {}

template <typename Scalar, int Harmonics>
std::size_t FluteSpectrum<Scalar, Harmonics>::line(int k) {
    const int index = Harmonics + k;
    return static_cast<std::size_t>(index);
}

template <typename Scalar, int Harmonics>
EngagementAngles<Scalar> FluteSpectrum<Scalar, Harmonics>::cut(Scalar engagement_rad) const {
    return side_ == CutSide::up ? EngagementAngles<Scalar>{Scalar(0), engagement_rad}
                                : EngagementAngles<Scalar>{pi<Scalar> - engagement_rad, pi<Scalar>};
}

template <typename Scalar, int Harmonics>
Scalar FluteSpectrum<Scalar, Harmonics>::moving_edge_rad(Scalar engagement_rad) const {
    return side_ == CutSide::up ? engagement_rad : pi<Scalar> - engagement_rad;
}

template <typename Scalar, int Harmonics>
Scalar FluteSpectrum<Scalar, Harmonics>::chip(Scalar phi_rad) const {
    using std::cos;
    using std::sin;
    const Scalar s = sin(phi_rad);
    const Scalar c = cos(phi_rad);
    return s + feed_in_radii_ * (Scalar(0.5F) * c * c - s * c / pitch_rad());
}

template <typename Scalar, int Harmonics>
Scalar FluteSpectrum<Scalar, Harmonics>::law(std::size_t index, Scalar chip) {
    if (index < 2) {
        return index == 0 ? chip : Scalar(1);
    }
    const Scalar share = Scalar(1) - chip / knot(index);
    return share > Scalar(0) ? share : Scalar(0);
}

template <typename Scalar, int Harmonics>
typename FluteSpectrum<Scalar, Harmonics>::LawLines FluteSpectrum<Scalar, Harmonics>::straight_laws(
    Scalar engagement_rad) const {
    LawLines all{};
    add_straight(cut(engagement_rad), all[0], all[1]);
    return all;
}

template <typename Scalar, int Harmonics>
typename FluteSpectrum<Scalar, Harmonics>::LawLines FluteSpectrum<Scalar, Harmonics>::all_laws(
    Scalar engagement_rad) const {
    LawLines all = straight_laws(engagement_rad);
    for (std::size_t h = 2; h < laws; ++h) {
        add_hat(cut(engagement_rad), h, all[h]);
    }
    return all;
}

template <typename Scalar, int Harmonics>
typename FluteSpectrum<Scalar, Harmonics>::Lines FluteSpectrum<Scalar, Harmonics>::helix(Scalar sweep_rad) const {
    Lines all{};
    const Phasor<Scalar> step = turned_by(-Scalar(teeth_) * sweep_rad);
    Phasor<Scalar> at_top = step;
    all[line(0)] = {sweep_rad, Scalar(0)};
    for (int k = 1; k <= used_; ++k) {
        const Phasor<Scalar> integral =
            over_i(Phasor<Scalar>{Scalar(1), Scalar(0)} - at_top) * (Scalar(1) / Scalar(k * teeth_));
        all[line(k)] = integral;
        all[line(-k)] = conjugate(integral);
        at_top = at_top * step;
    }
    return all;
}

template <typename Scalar, int Harmonics>
typename FluteSpectrum<Scalar, Harmonics>::Lines FluteSpectrum<Scalar, Harmonics>::turn(Scalar x) const {
    Lines all{};
    const Phasor<Scalar> step = turned_by(x);
    Phasor<Scalar> at{Scalar(1), Scalar(0)};
    for (int k = 0; k <= used_; ++k) {
        all[line(k)] = at;
        all[line(-k)] = conjugate(at);
        at = at * step;
    }
    return all;
}

/// Where the hats end, in feeds per tooth.
template <typename Scalar, int Harmonics>
Scalar FluteSpectrum<Scalar, Harmonics>::knot(std::size_t index) {
    constexpr Scalar knots[laws - 2] = {literal<Scalar>(0.1L), literal<Scalar>(0.3L), literal<Scalar>(0.6L)};
    return knots[index - 2];
}

template <typename Scalar, int Harmonics>
void FluteSpectrum<Scalar, Harmonics>::add_straight(const EngagementAngles<Scalar>& part, Lines& chip_lines,
                                                    Lines& edge_lines) const {
    const Phasor<Scalar> entry = turned_by(-part.entry_rad);
    const Phasor<Scalar> exit = turned_by(-part.exit_rad);
    const Scalar width_rad = part.exit_rad - part.entry_rad;
    const Phasor<Scalar> entry_step = power(entry, teeth_);
    const Phasor<Scalar> exit_step = power(exit, teeth_);
    Phasor<Scalar> at_entry{Scalar(1), Scalar(0)};
    Phasor<Scalar> at_exit{Scalar(1), Scalar(0)};
    for (int k = 0; k <= used_; ++k) {
        const Ends step{entry, exit};
        add_line(width_rad, k, {at_entry * conjugate(entry), at_exit * conjugate(exit)}, step, chip_lines, edge_lines);
        if (k > 0) {
            add_line(width_rad, -k, {conjugate(at_entry * entry), conjugate(at_exit * exit)}, step, chip_lines,
                     edge_lines);
        }
        at_entry = at_entry * entry_step;
        at_exit = at_exit * exit_step;
    }
}

/// `at`: e^{−i(m−1)φ} at both ends, m = kN; `step`: e^{−iφ}.
template <typename Scalar, int Harmonics>
void FluteSpectrum<Scalar, Harmonics>::add_line(Scalar width_rad, int k, Ends at, const Ends& step, Lines& chip_lines,
                                                Lines& edge_lines) const {
    Phasor<Scalar> E[5];  // E(q) = ∫ e^{−iqφ} dφ for q = m − 1 … m + 3
    for (int j = 0; j < 5; ++j) {
        const int q = k * teeth_ - 1 + j;
        E[j] = q == 0 ? Phasor<Scalar>{width_rad, Scalar(0)} : over_i(at.entry - at.exit) * (Scalar(1) / Scalar(q));
        at = {at.entry * step.entry, at.exit * step.exit};
    }
    const Scalar eps = feed_in_radii_;
    edge_lines[line(k)] += E[2];
    chip_lines[line(k)] += over_i(E[1] - E[3]) * Scalar(0.5F) + E[2] * (Scalar(0.25F) * eps) +
                           (E[0] + E[4]) * (Scalar(0.125F) * eps) -
                           over_i(E[0] - E[4]) * (Scalar(0.25F) * eps / pitch_rad());
}

/// A hat lives where sin φ < g_h: near φ = 0 and near φ = π.
template <typename Scalar, int Harmonics>
void FluteSpectrum<Scalar, Harmonics>::add_hat(const EngagementAngles<Scalar>& whole, std::size_t index,
                                               Lines& hat) const {
    using std::asin;
    const Scalar thin_rad = asin(knot(index));
    const Scalar thick_rad = pi<Scalar> - thin_rad;
    const EngagementAngles<Scalar> parts[2] = {
        {whole.entry_rad, whole.exit_rad < thin_rad ? whole.exit_rad : thin_rad},
        {whole.entry_rad > thick_rad ? whole.entry_rad : thick_rad, whole.exit_rad}};
    for (const EngagementAngles<Scalar>& part : parts) {
        if (!(part.exit_rad > part.entry_rad)) {
            continue;
        }
        Lines chip_lines{};
        Lines edge_lines{};
        add_straight(part, chip_lines, edge_lines);
        for (std::size_t l = 0; l < hat.size(); ++l) {
            hat[l] += edge_lines[l] - chip_lines[l] * (Scalar(1) / knot(index));
        }
    }
}

}  // namespace millforce::estimation
