// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/number/measurement.hpp"

namespace millforce::firmware {

/// The immersion from force drops, carried from the revolutions of the drops to the present cut.
///
/// What the section (width × depth) has grown by since then may be width or depth: the growth is split as it was
/// between earlier drop estimates, of which the last two count half, and the immersion is as uncertain as if every
/// split were equally likely. After a growth by half the drops say nothing of the present cut.
template <typename Scalar>
class CarriedImmersion {
  public:
    /// One estimate of the revolutions that the next drops are averaged over.
    void follow_section(Scalar section_mm2);
    /// The average of the drops has restarted: so does that of the section.
    void forget_sections();
    /// A new immersion from the drops of the revolutions up to now, and what the last one has become by now.
    void take(const estimation::Measurement<Scalar>& immersion, const estimation::Measurement<Scalar>& last);

    /// The immersion of the last drops, as their monitor has it now, at the section of the present cut.
    [[nodiscard]] estimation::Measurement<Scalar> carry(estimation::Measurement<Scalar> immersion,
                                                        Scalar section_mm2) const;

  private:
    static constexpr Scalar width_share_unknown{0.5F};

    Scalar section_of_drops_mm2_{0};
    Scalar width_share_{width_share_unknown};  // of the section's growth
    Scalar section_sum_mm2_{0};
    int sections_ = 0;
};

}  // namespace millforce::firmware
