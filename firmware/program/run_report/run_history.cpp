// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "run_report/run_words.hpp"

namespace millforce::host {

namespace {

constexpr float band_sd = 1.959964F;  ///< two-sided 95 % of the normal distribution

/// So that a short hold is not lost in a long stretch.
constexpr int weight_of_state(std::uint8_t state) {
    constexpr int weights[control::state_count] = {0, 3, 1, 2, 4, 5};  // air, entry, in_cut, exit, hold, fault
    return state < control::state_count ? weights[state] : 0;
}

ValueRange band_of(float value, float sd) {
    ValueRange band;
    band.add(std::isnan(sd) ? sd : std::max(value - band_sd * sd, 0.0F));
    band.add(value + band_sd * sd);
    return band;
}

/// Without an immersion the tooth's force is that of the most unfavourable one.
bool is_bound(const firmware::TickRecord& tick) {
    return std::isnan(tick.radial_immersion);
}

}  // namespace

void RunPeak::add(float new_share, double at_s) {
    if (new_share > share || std::isnan(share)) {
        share = new_share;
        time_s = at_s;
    }
}

void RunMean::add(float value, double step_s) {
    if (!std::isnan(value)) {
        integral += static_cast<double>(value) * step_s;
        known_s += step_s;
    }
}

void RunBin::add(const RunBin& later) {
    if (later.is_empty) {
        return;
    }
    tooth_force_N.add(later.tooth_force_N);
    tooth_force_bound_N.add(later.tooth_force_bound_N);
    tooth_force_limit_N.add(later.tooth_force_limit_N);
    radial_immersion.add(later.radial_immersion);
    radial_immersion_band.add(later.radial_immersion_band);
    axial_depth_mm.add(later.axial_depth_mm);
    axial_depth_band_mm.add(later.axial_depth_band_mm);
    override_ratio.add(later.override_ratio);
    for (std::size_t k = 0; k < held_s.size(); ++k) {
        held_s[k] += later.held_s[k];
    }
    state = is_empty || weight_of_state(later.state) > weight_of_state(state) ? later.state : state;
    is_empty = false;
}

control::Limit RunBin::limit() const {
    return static_cast<control::Limit>(std::max_element(held_s.begin(), held_s.end()) - held_s.begin());
}

RunHistory::RunHistory(const ToolSet& tools) : has_numbers_(!tools.tools().empty()) {
    if (!has_numbers_) {
        tooth_force_limits_N_.emplace(0, tools.parameters().tool.tooth_force_limit_N);
        runouts_[0].stated_um = tools.parameters().tool.runout_um;
    }
    for (const NumberedTool& tool : tools.tools()) {
        tooth_force_limits_N_.emplace(tool.number, tool.parameters.tooth_force_limit_N);
        runouts_[tool.number].stated_um = tool.parameters.runout_um;
    }
    bins_.reserve(bin_capacity);
    events_.reserve(event_capacity);
}

void RunHistory::add(double time_s, const firmware::TickRecord& tick, std::uint32_t tool) {
    const double before_s = totals_.length_s;
    const double now_s = elapsed_s(time_s);
    const bool is_gap = now_s - before_s > longest_step_s;
    const double step_s = is_gap ? 0.0 : now_s - before_s;
    totals_.length_s = now_s;
    totals_.missing_s += is_gap ? now_s - before_s : 0.0;
    const float limit_N = tooth_force_limit_N(tool);
    add_to_totals(step_s, tick, limit_N);
    add_to_bin(step_s, tick, limit_N);
    if (const auto runout = runouts_.find(tool); runout != runouts_.end()) {
        runout->second.add(tick.runout_um);
    }
    find_events(time_s, tick, tool);
}

double RunHistory::elapsed_s(double time_s) {
    if (totals_.ticks == 0) {
        first_clock_s_ = time_s;
    } else if (time_s < last_clock_s_) {
        set_back_s_ += last_clock_s_ - time_s;
    }
    last_clock_s_ = time_s;
    ++totals_.ticks;
    return time_s - first_clock_s_ + set_back_s_;
}

float RunHistory::tooth_force_limit_N(std::uint32_t tool) const {
    const auto found = tooth_force_limits_N_.find(tool);
    return found != tooth_force_limits_N_.end() ? found->second : firmware::TickRecord::no_estimate;
}

void RunHistory::add_to_totals(double step_s, const firmware::TickRecord& tick, float limit_N) {
    const hal::FeedOverride& out = tick.feed_override;
    const auto state = static_cast<control::CutState>(out.state);
    totals_.in_state_s[out.state % control::state_count] += step_s;
    totals_.ceilings.add(step_s, static_cast<control::Limit>(tick.limit), state);
    totals_.hold_s += out.hold ? step_s : 0.0;
    RunPeak& peak = is_bound(tick) ? totals_.bound : totals_.peak;
    peak.add(tick.tooth_force_N / limit_N, totals_.length_s);
    if (!control::is_cutting(state)) {
        return;
    }
    totals_.radial_immersion.add(tick.radial_immersion, step_s);
    totals_.axial_depth_mm.add(tick.axial_depth_mm, step_s);
    totals_.override_ratio.add(out.ratio, step_s);
    peak.over_limit_s += tick.tooth_force_N > limit_N ? step_s : 0.0;
}

void RunHistory::add_to_bin(double step_s, const firmware::TickRecord& tick, float limit_N) {
    RunBin bin;
    bin.is_empty = false;
    (is_bound(tick) ? bin.tooth_force_bound_N : bin.tooth_force_N).add(tick.tooth_force_N);
    bin.tooth_force_limit_N.add(limit_N);
    bin.radial_immersion.add(tick.radial_immersion);
    bin.radial_immersion_band = band_of(tick.radial_immersion, tick.radial_immersion_sd);
    bin.axial_depth_mm.add(tick.axial_depth_mm);
    bin.axial_depth_band_mm = band_of(tick.axial_depth_mm, tick.axial_depth_sd_mm);
    bin.override_ratio.add(tick.feed_override.ratio);
    bin.held_s[tick.limit % control::limit_count] = static_cast<float>(step_s);
    bin.state = tick.feed_override.state;
    bin_at(totals_.length_s).add(bin);
}

RunBin& RunHistory::bin_at(double time_s) {
    while (time_s >= bin_width_s_ * static_cast<double>(bin_capacity)) {
        join_pairs();
    }
    const auto place = static_cast<std::size_t>(time_s / bin_width_s_);
    bins_.resize(std::max(bins_.size(), place + 1));
    return bins_[place];
}

void RunHistory::join_pairs() {
    for (std::size_t k = 0; k < bins_.size(); ++k) {
        if (k % 2 == 0) {
            bins_[k / 2] = bins_[k];
        } else {
            bins_[k / 2].add(bins_[k]);
        }
    }
    bins_.resize((bins_.size() + 1) / 2);
    bin_width_s_ *= 2.0;
}

void RunHistory::find_events(double time_s, const firmware::TickRecord& tick, std::uint32_t tool) {
    if (const std::uint8_t fault = tick.feed_override.fault; fault != fault_) {
        const auto words = static_cast<control::Fault>(fault);
        keep(
            time_s, fault != 0,
            fault == 0 ? "The fault was reset." : fmt::format("Fault {}: {}", control::name(words), meaning_of(words)));
        fault_ = fault;
    }
    if (has_numbers_ && (tool != tool_ || totals_.ticks == 1)) {
        keep(time_s, false,
             tool == 0 ? "The tool is not known: the override is the operator's." : fmt::format("Tool {}.", tool));
        tool_ = tool;
    }
}

void RunHistory::note(double time_s, std::string_view text) {
    keep(time_s, false, std::string(text));
}

/// Of too many the first are kept, which led to the others, and the newest in the last place.
void RunHistory::keep(double time_s, bool is_fault, std::string text) {
    RawEvent event{time_s + set_back_s_, is_fault, std::move(text)};
    if (events_.size() < event_capacity) {
        events_.push_back(std::move(event));
        return;
    }
    events_.back() = std::move(event);
    ++events_left_out_;
}

std::vector<RunEvent> RunHistory::events() const {
    std::vector<RunEvent> made;
    for (const RawEvent& event : events_) {
        const double time_s = is_empty() ? 0.0 : event.clock_s - first_clock_s_;
        made.push_back({std::clamp(time_s, 0.0, totals_.length_s), event.is_fault, event.text});
    }
    std::stable_sort(made.begin(), made.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
    return made;
}

}  // namespace millforce::host
