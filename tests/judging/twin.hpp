// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "judging/drawn_cut.hpp"
#include "judging/recording.hpp"

/// The twins of a cut that was recorded with a wrong assumption: right cuts whose drives show the same means. Who knows
/// the means alone, and that much of the machine, cannot tell a cut from its twin.

namespace millforce::judging {

/// A right cut: the same tool at the same feed, speed and direction, of the law and on the machine of the files, within
/// what these leave open; no signal lies.
struct Twin {
    TrueCut cut;
    double misfit = 0.0;  ///< squared deviations between what it shows and what was seen
};

/// Means of the spindle's and both axes' currents, less those of the air before the cut, as forces by the files. Each
/// is known to within
///   - noise, over eight windows of whole revolutions and at least 12 samples: as long as the estimator remembers;
///   - the part of a moving axis' friction that depends on its position;
///   - the gains, r_1 and its exponent, by their stated deviations.
/// An axis at rest may carry its break-away friction in addition. K_s needs no deviation: another depth makes up for
/// it. A twin has a misfit below 3.84: one right cut in 20 differs more from itself. No twin is deeper than the flute.
/// Where the currents in air are not those of the machine, by three stated deviations, nothing has a twin.
class TwinSearch {
  public:
    TwinSearch(const DrawnCut& seen, const Recording& recording);

    /// Of the forces up to this sample.
    [[nodiscard]] std::vector<Twin> twins_at(std::size_t sample) const;

  private:
    static constexpr std::size_t spindle = 0;  // and from 1 on the axes
    static constexpr std::size_t signals = 3;
    using Signals = std::array<double, signals>;

    /// Of a cut that is one millimetre deep.
    struct Node {
        bool is_up = false;
        double radial_immersion = 0.0;
        Signals force_N{};
        Signals by_r_1_N{};  ///< change for a deviation of r_1
    };

    [[nodiscard]] Signals mean_A(std::size_t from, std::size_t to) const;
    [[nodiscard]] bool air_is_right() const;
    [[nodiscard]] Signals mean_force_N(const TrueCut& cut) const;
    [[nodiscard]] Node node_at(bool is_up, double engagement_rad) const;
    [[nodiscard]] Twin twin_of(const Node& node, const Signals& seen_N, const Signals& noise_N) const;

    DrawnCut seen_;
    const Recording& recording_;
    TrueCut stated_;  ///< the tool and the law of the files
    double r_1_relative_sd_ = 0.0;
    std::array<bool, 2> moves_{};
    Signals N_per_A_{};
    Signals air_A_{};
    std::vector<Node> nodes_;
};

/// The override at which a tooth of this cut is 5 % beyond its limit: as much as a gain's doubt of 2 % and the caution
/// for the rest may miss. `drawn`: recorded at its override and feed per tooth.
[[nodiscard]] double allowed_override(const TrueCut& cut, const DrawnCut& drawn);

}  // namespace millforce::judging
