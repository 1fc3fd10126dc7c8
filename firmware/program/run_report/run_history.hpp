// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "control/cut_state.hpp"
#include "firmware/tick_record.hpp"
#include "parameters/tool_set.hpp"
#include "run_report/ceiling_table.hpp"

/// What the page of a run is made of, gathered tick by tick in memory that does not grow: 0.3 MB for a second or a
/// week.

namespace millforce::host {

/// Smallest and largest of the values that there were; NaN: there was none.
struct ValueRange {
    float low = std::numeric_limits<float>::quiet_NaN();
    float high = std::numeric_limits<float>::quiet_NaN();

    void add(float value) {
        low = std::fmin(low, value);
        high = std::fmax(high, value);
    }
    void add(const ValueRange& other) {
        add(other.low);
        add(other.high);
    }
    [[nodiscard]] bool is_empty() const { return std::isnan(low); }
};

/// All ticks of a stretch of time.
struct RunBin {
    ValueRange tooth_force_N;        ///< where the immersion was known
    ValueRange tooth_force_bound_N;  ///< where it was not: the most that it can have been
    ValueRange tooth_force_limit_N;
    ValueRange radial_immersion;
    ValueRange radial_immersion_band;  ///< 95 % bands, from the lowest bound to the highest
    ValueRange axial_depth_mm;
    ValueRange axial_depth_band_mm;
    ValueRange override_ratio;
    std::array<float, control::limit_count> held_s{};  ///< how long each limit held the override
    std::uint8_t state = 0;                            ///< control::CutState: the most important one
    bool is_empty = true;

    void add(const RunBin& later);
    /// That held the override for longest.
    [[nodiscard]] control::Limit limit() const;
};

/// Largest load on a tooth.
struct RunPeak {
    float share = std::numeric_limits<float>::quiet_NaN();  ///< of its limit; NaN: there was no load
    double time_s = 0.0;
    double over_limit_s = 0.0;  ///< in the cut

    void add(float new_share, double at_s);
};

/// Mean over the time for which there was a value.
struct RunMean {
    double integral = 0.0;
    double known_s = 0.0;

    void add(float value, double step_s);
    [[nodiscard]] double mean() const { return integral / known_s; }
};

/// By how much the chip of one tooth is thicker than the mean one, at most.
struct RunRunout {
    float stated_um = 0.0F;                                    ///< runout_um of the tool's file
    float shown_um = std::numeric_limits<float>::quiet_NaN();  ///< newest that a cut has shown; NaN: none has

    /// The controller takes what is stated for it until a cut shows another; where 0 is stated it does not look.
    void add(float runout_um) {
        constexpr float same_um = 0.05F;
        shown_um = stated_um > 0.0F && std::fabs(runout_um - stated_um) > same_um ? runout_um
                                                                                  : shown_um;  // a NaN changes nothing
    }
    [[nodiscard]] bool is_shown() const { return !std::isnan(shown_um); }
};

/// Figures of the whole run.
struct RunTotals {
    std::uint64_t ticks = 0;
    double length_s = 0.0;   ///< from the first tick to the last
    double missing_s = 0.0;  ///< of it without ticks: gaps longer than `longest_step_s`
    CeilingTimes ceilings;
    RunMean radial_immersion;  ///< this and the next two: in the cut
    RunMean axial_depth_mm;
    RunMean override_ratio;
    double hold_s = 0.0;  ///< feed held, in any state
    std::array<double, control::state_count> in_state_s{};
    RunPeak peak;   ///< where the immersion was known
    RunPeak bound;  ///< where it was not: the most that it can have been
};

struct RunEvent {
    double time_s = 0.0;  ///< after the first tick; not before it
    bool is_fault = false;
    std::string text;
};

/// One thread. Cost of add(): some 100 operations and no heap but for an event; now and then all bins are joined in
/// pairs.
class RunHistory {
  public:
    static constexpr std::size_t bin_capacity = 1200;
    static constexpr std::size_t event_capacity = 500;
    static constexpr double longest_step_s = 0.5;

    explicit RunHistory(const ToolSet& tools);

    /// The next tick. A time that is not later than the one before (a log of several runs) counts on from there.
    void add(double time_s, const firmware::TickRecord& tick, std::uint32_t tool);
    /// Something else that happened, on the clock of the ticks.
    void note(double time_s, std::string_view text);
    /// Ticks that did not reach this history.
    void set_lost(std::uint64_t ticks) { lost_ = ticks; }

    [[nodiscard]] bool is_empty() const { return totals_.ticks == 0; }
    [[nodiscard]] const RunTotals& totals() const { return totals_; }
    /// By the tool's number; 0: the one tool.
    [[nodiscard]] const std::map<std::uint32_t, RunRunout>& runouts() const { return runouts_; }
    [[nodiscard]] double bin_width_s() const { return bin_width_s_; }
    [[nodiscard]] const std::vector<RunBin>& bins() const { return bins_; }
    /// In the order of their times. Of too many: the first ones and the last.
    [[nodiscard]] std::vector<RunEvent> events() const;
    [[nodiscard]] std::uint64_t events_left_out() const { return events_left_out_; }
    [[nodiscard]] std::uint64_t lost() const { return lost_; }

  private:
    struct RawEvent {
        double clock_s;
        bool is_fault;
        std::string text;
    };

    [[nodiscard]] double elapsed_s(double time_s);
    [[nodiscard]] float tooth_force_limit_N(std::uint32_t tool) const;
    void add_to_totals(double step_s, const firmware::TickRecord& tick, float limit_N);
    void add_to_bin(double step_s, const firmware::TickRecord& tick, float limit_N);
    RunBin& bin_at(double time_s);
    void join_pairs();
    void find_events(double time_s, const firmware::TickRecord& tick, std::uint32_t tool);
    void keep(double time_s, bool is_fault, std::string text);

    std::map<std::uint32_t, float> tooth_force_limits_N_{};
    std::map<std::uint32_t, RunRunout> runouts_{};
    bool has_numbers_;
    RunTotals totals_{};
    double bin_width_s_ = 0.02;
    std::vector<RunBin> bins_{};
    std::vector<RawEvent> events_{};
    std::uint64_t events_left_out_ = 0;
    std::uint64_t lost_ = 0;
    double first_clock_s_ = 0.0;
    double last_clock_s_ = 0.0;
    double set_back_s_ = 0.0;  // by which the clock was set back so far
    std::uint8_t fault_ = 0;
    std::uint32_t tool_ = 0;
};

}  // namespace millforce::host
