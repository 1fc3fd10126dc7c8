// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "estimation/cut_estimate.hpp"
#include "firmware/feed_dip.hpp"
#include "firmware/lone_fall.hpp"
#include "firmware/parameters.hpp"
#include "firmware/slow_fall.hpp"
#include "firmware/steady_cut.hpp"

namespace millforce::firmware {

/// Where the tool is at an estimate.
struct DoubtStage {
    bool in_cut = false;         ///< it neither enters nor leaves
    bool is_cutting = false;     ///< or it does
    bool cut_is_known = false;   ///< from a part map
    bool width_is_seen = false;  ///< by force drops, which no drift of a current changes
};

template <typename Scalar>
struct PossibleForce {
    Scalar tooth_N{0};
    bool is_bound = false;  ///< of a cut that is as possible as the estimated one
};

/// The tooth force and the feed of a cut in which a current may have drifted.
///
/// The force is the largest that the forces leave possible: steady_cut.hpp where the width is known, lone_fall.hpp
/// where it is not, slow_fall.hpp where the spindle's current is the only one.
///
/// The feed is bounded while there is a question, which a dip of the feed answers (feed_dip.hpp):
///   - the width alone seems to have changed;
///   - both forces have jumped in a cut in doubt. The jump is a new cut, but what has drifted by then has drifted. The
///     feed is held at that of the jump, or at that of an entry if that is higher, until a dip finds both forces alike
///     or re-zeroing in air finds the currents as they should be.
/// A dip that finds them unlike is made again 100 estimates later. A cut that a part map knows is not asked, nor one
/// whose width is seen by force drops.
///
/// Cost: that of its parts. No heap. One thread.
template <typename Scalar>
class DriftDoubt {
  public:
    using Estimate = estimation::CutEstimate<Scalar>;

    explicit DriftDoubt(const Parameters<Scalar>& parameters);

    /// Re-zeroing in air has found the currents to be as they should.
    void clear();
    /// A new estimate. Returns the tooth force that it leaves possible, not below `tooth_force_N`. `period_s`: of a
    /// tooth.
    PossibleForce<Scalar> follow(const Estimate& e, Scalar tooth_force_N, Scalar period_s, const DoubtStage& stage);
    /// The spindle's force has gone, but not that of the axes: no air to re-zero in.
    [[nodiscard]] bool may_still_cut(const Estimate& e) const;
    /// No faster than this; 0: no bound.
    [[nodiscard]] Scalar bound_mm_s() const { return dip_.is_asking() ? dip_.bound_mm_s() : held_mm_s_; }

  private:
    [[nodiscard]] static Scalar per_root_feed(const Estimate& e);
    Scalar by_two_forces(const Estimate& e, Scalar tooth_force_N, Scalar period_s, const DoubtStage& stage);
    void ask(const Estimate& e, const DoubtStage& stage);
    void take(typename FeedDip<Scalar>::Answer answer);

    SteadyCut<Scalar> steady_cut_;
    LoneFall<Scalar> lone_fall_{};
    SlowFall<Scalar> slow_fall_;
    FeedDip<Scalar> dip_{};
    Scalar entry_feed_per_tooth_mm_;
    std::uint8_t pause_ = 0;  // estimates until the next question
    Scalar held_mm_s_{0};     // since a jump in a cut in doubt; 0: no such jump
};

}  // namespace millforce::firmware
