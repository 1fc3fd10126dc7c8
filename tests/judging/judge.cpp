// SPDX-License-Identifier: Apache-2.0
#include "judging/judge.hpp"

#include "firmware/tick.hpp"
#include "judging/recording.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::judging {

namespace {

constexpr double detection_revolutions = 2.0;
constexpr double misfit_of_the_right_model = 3.84;  // in 95 of 100 windows

void look(const firmware::ForceControlTick<float>& tick, const DrawnCut& drawn, Verdict& verdict) {
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
    const auto misfit = static_cast<double>(e.misfit);
    verdict.largest_misfit = std::max(verdict.largest_misfit, misfit);
    if (e.immersion_valid) {
        ++verdict.immersions;
        const bool is_beyond = !within(immersion, estimate, 3.0 * sd);
        verdict.immersions_beyond += is_beyond ? 1 : 0;
        verdict.beyond_explained += is_beyond && misfit < misfit_of_the_right_model ? 1 : 0;
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

/// The override at which a tooth of the true cut is 5 % beyond its limit: as much as a gain's doubt of 2 % and the
/// caution for the rest may miss.
double allowed_override(const DrawnCut& drawn) {
    constexpr double most_mm = 1.0;
    constexpr double tolerated_share = 1.05;
    const double tolerated_N = tolerated_share * static_cast<double>(drawn.stated.tool.tooth_force_limit_N);
    const double allowed_mm = feed_per_tooth_at_limit_mm(drawn.cut, tolerated_N, most_mm);
    return drawn.override * allowed_mm / drawn.cut.feed_per_tooth_mm;
}

}  // namespace

Verdict judge(const DrawnCut& drawn) {
    const Recording recording = record(drawn);
    const double allowed = allowed_override(drawn);
    const double samples_per_turn = 1000.0 / drawn.turns_per_s;
    const auto first = recording.whole_from + static_cast<std::size_t>(4.0 * samples_per_turn);
    const auto every = static_cast<std::size_t>(4.0 * samples_per_turn);
    firmware::ForceControlTick<float> tick(drawn.stated);
    Verdict verdict;
    double above = 0.0;
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
        hal::ProgramStatus program = recording.program;
        program.rapid = i < recording.rapid_end;
        const hal::FeedOverride output = firmware::step_and_work(tick, recording.samples[i], program);
        if (i < first) {
            continue;
        }
        if ((i - first) % every == 0) {
            look(tick, drawn, verdict);
        }
        const double ratio = output.hold ? 0.0 : static_cast<double>(output.ratio);
        above = ratio > allowed ? above + 1.0 : 0.0;
        verdict.revolutions_above = std::max(verdict.revolutions_above, above / samples_per_turn);
        verdict.largest_excess = std::max(verdict.largest_excess, ratio / allowed);
        verdict.has_fault = verdict.has_fault || output.fault != 0;
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
    beyond_explained += v.beyond_explained;
    depths += v.depths;
    depths_beyond += v.depths_beyond;
    depths_beyond_flute += v.depths_beyond_flute;
    const bool is_too_fast = v.revolutions_above > detection_revolutions;
    cuts_too_fast += is_too_fast ? 1 : 0;
    too_fast_explained += is_too_fast && v.largest_misfit < misfit_of_the_right_model ? 1 : 0;
    largest_excess = is_too_fast ? std::max(largest_excess, v.largest_excess) : largest_excess;
    faults += v.has_fault ? 1 : 0;
}

}  // namespace millforce::judging
