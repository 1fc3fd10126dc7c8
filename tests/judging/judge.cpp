// SPDX-License-Identifier: Apache-2.0
#include "judging/judge.hpp"

#include "firmware/tick.hpp"
#include "judging/recording.hpp"
#include "judging/twin.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace millforce::judging {

namespace {

constexpr double detection_revolutions = 2.0;

/// Searches only where it is asked.
class Twins {
  public:
    Twins(const DrawnCut& drawn, const Recording& recording) : drawn_(drawn), recording_(recording) {}
    std::vector<Twin> at(std::size_t sample) {
        if (!search_) {
            search_.emplace(drawn_, recording_);
        }
        return search_->twins_at(sample);
    }

  private:
    const DrawnCut& drawn_;
    const Recording& recording_;
    std::optional<TwinSearch> search_;
};

bool any_has_immersion(const std::vector<Twin>& twins, double radial_immersion, double tolerance) {
    return std::ranges::any_of(
        twins, [=](const Twin& twin) { return std::abs(twin.cut.radial_immersion - radial_immersion) <= tolerance; });
}

void look(const firmware::ForceControlTick<float>& tick, const DrawnCut& drawn, std::size_t sample, Twins& twins,
          Verdict& verdict) {
    const estimation::EngagementEstimate<float> e = tick.engagement();
    const auto within = [](double value, double centre, double sd) { return std::abs(value - centre) <= sd; };
    const double immersion = drawn.cut.radial_immersion;
    const double depth_mm = drawn.cut.axial_depth_mm;
    const auto estimate = static_cast<double>(e.radial_immersion);
    const auto sd = static_cast<double>(e.radial_immersion_sd);
    const auto estimate_mm = static_cast<double>(e.axial_depth_mm);
    const auto sd_mm = static_cast<double>(e.axial_depth_sd_mm);
    ++verdict.looks;
    verdict.last_has_immersion = e.immersion_valid;
    if (e.immersion_valid) {
        ++verdict.immersions;
        const bool is_beyond = !within(immersion, estimate, 3.0 * sd);
        verdict.immersions_beyond += is_beyond ? 1 : 0;
        verdict.beyond_with_twin += is_beyond && any_has_immersion(twins.at(sample), estimate, 3.0 * sd) ? 1 : 0;
        verdict.last_immersion_covers = immersion >= static_cast<double>(e.radial_immersion_low) &&
                                        immersion <= static_cast<double>(e.radial_immersion_high);
    }
    verdict.last_has_depth = e.depth_valid;
    if (e.depth_valid) {
        ++verdict.depths;
        verdict.depths_beyond += within(depth_mm, estimate_mm, 3.0 * sd_mm) ? 0 : 1;
        verdict.depths_beyond_flute += e.axial_depth_mm > drawn.stated.tool.flute_length_mm ? 1 : 0;
        verdict.last_depth_covers = within(depth_mm, estimate_mm, 1.96 * sd_mm);
    }
}

bool any_twin_allows(const std::vector<Twin>& twins, const DrawnCut& drawn, double override_ratio) {
    constexpr std::size_t most_tried = 24;
    const std::size_t step = twins.size() / most_tried + 1;
    for (std::size_t i = 0; i < twins.size(); i += step) {
        if (allowed_override(twins[i].cut, drawn) >= override_ratio) {
            return true;
        }
    }
    return false;
}

}  // namespace

Verdict judge(const DrawnCut& drawn) {
    const Recording recording = record(drawn);
    const double allowed = allowed_override(drawn.cut, drawn);
    const double samples_per_turn = 1000.0 / drawn.turns_per_s;
    const auto first = recording.whole_from + static_cast<std::size_t>(4.0 * samples_per_turn);
    const auto every = static_cast<std::size_t>(4.0 * samples_per_turn);
    firmware::ForceControlTick<float> tick(drawn.stated);
    Twins twins(drawn, recording);
    Verdict verdict;
    double above = 0.0;
    double fastest = allowed;  // at a look
    std::size_t fastest_at = 0;
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
        hal::ProgramStatus program = recording.program;
        program.rapid = i < recording.rapid_end;
        const hal::FeedOverride output = firmware::step_and_work(tick, recording.samples[i], program);
        if (i < first) {
            continue;
        }
        const double ratio = output.hold ? 0.0 : static_cast<double>(output.ratio);
        if ((i - first) % every == 0) {
            look(tick, drawn, i, twins, verdict);
            fastest_at = ratio > fastest ? i : fastest_at;
            fastest = std::max(fastest, ratio);
        }
        above = ratio > allowed ? above + 1.0 : 0.0;
        verdict.revolutions_above = std::max(verdict.revolutions_above, above / samples_per_turn);
        verdict.largest_excess = std::max(verdict.largest_excess, ratio / allowed);
        verdict.has_fault = verdict.has_fault || output.fault != 0;
    }
    if (verdict.revolutions_above > detection_revolutions && fastest_at > 0) {
        verdict.is_right_for_a_twin = any_twin_allows(twins.at(fastest_at), drawn, fastest);
    }
    return verdict;
}

void Tally::add(const Verdict& v) {
    ++cuts;
    cuts_with_immersion += v.last_has_immersion ? 1 : 0;
    immersions_cover += v.last_has_immersion && v.last_immersion_covers ? 1 : 0;
    cuts_with_depth += v.last_has_depth ? 1 : 0;
    depths_cover += v.last_has_depth && v.last_depth_covers ? 1 : 0;
    immersions += v.immersions;
    immersions_beyond += v.immersions_beyond;
    beyond_with_twin += v.beyond_with_twin;
    depths += v.depths;
    depths_beyond += v.depths_beyond;
    depths_beyond_flute += v.depths_beyond_flute;
    const bool is_too_fast = v.revolutions_above > detection_revolutions;
    cuts_too_fast += is_too_fast ? 1 : 0;
    too_fast_with_twin += is_too_fast && v.is_right_for_a_twin ? 1 : 0;
    largest_excess = is_too_fast ? std::max(largest_excess, v.largest_excess) : largest_excess;
    faults += v.has_fault ? 1 : 0;
}

}  // namespace millforce::judging
