// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/phasor.hpp"

#include <array>
#include <cstddef>

/// Closed Fourier coefficients of a helical cutter's plane force, at the multiples m = kN of the spindle's frequency.
///
/// Written as F_x + iF_y, a disc of unit height at angle φ gives (F_t + iF_r) e^{−iφ}. With a law of the chip g(φ) per
/// feed, F_t + iF_r = Σ_b c_b λ_b(g), the coefficients c_b complex, the disc's line m is Σ_b c_b ∫ λ_b e^{−i(m+1)φ} dφ
/// over the engagement. The helix shifts each disc: all lines are multiplied by ∫ e^{−imψ} dψ over the sweep. Both
/// integrals are sums of e^{iqφ}; nothing is integrated numerically.
///
/// The laws: g itself, a constant (edge force), and hats (1 − g/g_h)₊ that let thin chips depart from the straight
/// line: size effect, rubbing, and teeth that runout lifts out of a thin chip. g = sin φ + ε [½ cos²φ − sin φ cos
/// φ/φ_N], ε = f_z/R: the trochoid to first order. Bodies: flute_spectrum_impl.hpp.

namespace millforce::estimation {

template <typename Scalar, int Harmonics>
class FluteSpectrum {
  public:
    static constexpr std::size_t lines = 2U * static_cast<std::size_t>(Harmonics) + 1U;
    static constexpr std::size_t laws = 5;
    using Lines = std::array<Phasor<Scalar>, lines>;  ///< [k + Harmonics]
    using LawLines = std::array<Lines, laws>;

    FluteSpectrum(int teeth, Scalar feed_in_radii, CutSide side, int used);

    [[nodiscard]] static std::size_t line(int k);
    [[nodiscard]] static int order(std::size_t line) { return static_cast<int>(line) - Harmonics; }
    [[nodiscard]] int used() const { return used_; }
    [[nodiscard]] Scalar pitch_rad() const { return Scalar(2) * pi<Scalar> / Scalar(teeth_); }

    [[nodiscard]] EngagementAngles<Scalar> cut(Scalar engagement_rad) const;
    /// The end of the engagement that moves with its width: both ways it grows with it.
    [[nodiscard]] Scalar moving_edge_rad(Scalar engagement_rad) const;

    [[nodiscard]] Scalar chip(Scalar phi_rad) const;
    [[nodiscard]] static Scalar law(std::size_t index, Scalar chip);

    /// Lines of chip and edge force only; the hats stay zero.
    [[nodiscard]] LawLines straight_laws(Scalar engagement_rad) const;
    [[nodiscard]] LawLines all_laws(Scalar engagement_rad) const;

    /// ∫₀^{α_sw} e^{−ikNψ} dψ.
    [[nodiscard]] Lines helix(Scalar sweep_rad) const;

    /// e^{ikx}.
    [[nodiscard]] Lines turn(Scalar x) const;

  private:
    struct Ends;

    [[nodiscard]] static Scalar knot(std::size_t index);
    void add_straight(const EngagementAngles<Scalar>& part, Lines& chip_lines, Lines& edge_lines) const;
    void add_line(Scalar width_rad, int k, Ends at, const Ends& step, Lines& chip_lines, Lines& edge_lines) const;
    void add_hat(const EngagementAngles<Scalar>& whole, std::size_t index, Lines& hat) const;

    int teeth_;
    Scalar feed_in_radii_;
    CutSide side_;
    int used_;
};

}  // namespace millforce::estimation
