// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// When the drives latched their values, in the time of the SYNCs' stamps.
///
/// A stamp is not on time in two ways. The SYNC itself is late (arbitration, a busy producer) and the drives latch late
/// with it: w. Or only the stamp is late (interrupt latency), or the drives have their own clock, locked to the SYNC:
/// v. The first must be believed and the second must not: 20 µs in 1 ms look like 2 % of spindle speed. The spindle
/// helps, since its inertia keeps its speed for some periods: the angle that it turned gives the time, except for the
/// error that forces and the step of the counts add: u. Stamps and counts are followed alike (position gain 1/4); what
/// each is off by
///
///     s = stamp - expected stamp = w + v,    c = (count - expected count) / speed = w + u
///
/// has E[s c] = σ_w², E[s²] - E[s c] = σ_v², E[c²] - E[s c] = σ_u², over about 1000 periods, as w, v and u have nothing
/// to do with each other. The latch time is the mean of three, each weighted by what it is worth:
///
///     latch = base + ((stamp - base) / σ_v² + c / σ_u²) / (1 / σ_v² + 1 / σ_u² + 1 / σ_w²)
///
/// where base is a grid of even periods (gain 1/64), but moved to the expected stamp by the share of their distance
/// that is more than v would make of it (σ_v²/4): where all of a stamp is w, it is trusted however slowly w changes.
///
/// Counts that contradict the stamp (4 sd) are a spindle that changes its speed, and are left out. Stamps are taken as
/// they are until 200 periods were seen with the spindle turning by at least 4 counts per period. A stamp more than a
/// quarter of a period off the grid begins a new grid. Latch times of stamps that are at least half a period apart
/// increase. Integers and about 100 float operations per SYNC; 88 bytes; no errors. One thread.

namespace millforce::cia402 {

class SyncClock {
  public:
    explicit SyncClock(std::uint32_t period_us);

    /// The newest SYNC. Times do not run backwards by more than a clock that was set.
    void on_sync(std::uint64_t stamp_us);
    /// The spindle's count that was latched at the newest SYNC. Not called where it did not come.
    void on_count(std::uint32_t count);
    /// When the drives latched at the newest SYNC, by what is known so far.
    [[nodiscard]] std::uint64_t latched_us() const;

  private:
    void restart_at(std::uint64_t stamp_us);
    void follow_stamp(float periods);
    [[nodiscard]] bool count_follows() const;  ///< a count so soon after the last that their difference is a speed
    void restart_counting(std::uint32_t count);
    void learn(float by_counts_us);
    void weigh(float by_counts_us);

    std::uint64_t period_ns_;
    std::uint64_t grid_ns_ = 0;  ///< time of the newest SYNC
    float drift_ns_ = 0.0F;      ///< drift of the grid, per period
    float by_stamp_us_ = 0.0F;   ///< newest stamp minus the grid
    float ahead_us_ = 0.0F;      ///< followed stamps - grid
    float ahead_us_per_period_ = 0.0F;
    float expected_us_ = 0.0F;     ///< by_stamp_us_ of the newest stamp, before it came
    float latched_off_us_ = 0.0F;  ///< latch - grid
    bool has_count_ = false;
    std::uint32_t since_count_ = 0;  ///< periods from the last count's SYNC to the newest
    std::uint32_t last_count_ = 0;
    float ahead_counts_ = 0.0F;  ///< followed position - last count
    float counts_per_period_ = 0.0F;
    std::uint32_t followed_ = 0;  ///< counts since the spindle is followed, at most settled
    float learnt_ = 0.0F;         ///< periods in the mean squares, at most 1 / memory
    float mean_ss_us2_ = 0.0F;
    float mean_cc_us2_ = 0.0F;
    float mean_sc_us2_ = 0.0F;
    float mean_wander_us2_ = 0.0F;  ///< mean square wander of expected_us_
};

}  // namespace millforce::cia402
