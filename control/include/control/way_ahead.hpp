// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is known of the way in front of the tool, and of the cut that it stands in (feed_ahead.hpp).

namespace millforce::control {

template <typename Scalar>
struct WayAhead {
    bool known = false;    ///< the map has agreed with the cut so far: it replaces what guards a blind tool
    bool may_cut = false;  ///< the map has a cut where the newest estimate was taken, or may have one; known or not yet
    Scalar feed_mm_s{0};   ///< the fastest from which the machine still brakes to each place ahead
    /// Of the cut that the newest estimate stands for; 0 in air:
    Scalar tooth_per_tangential{0};  ///< a mean tooth's largest force per mean tangential force
    Scalar tangential_N{0};          ///< F_at that the map and the material so far let expect; 0: not known
};

}  // namespace millforce::control
