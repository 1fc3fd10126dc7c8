// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_learner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "part_map/memory_map.hpp"

namespace millforce::host {

namespace {

/// The distance to go may grow by that much within a block, where a corner is blended.
constexpr double blending_mm = 0.5;
/// Between two estimates: a longer way was not seen.
constexpr double longest_gap_mm = 10.0;

}  // namespace

MapLearner::MapLearner(const firmware::Parameters<float>& parameters)
    : MapLearner(parameters.machine, {{0, parameters.tool}}) {
    set_tool(0);
}

MapLearner::MapLearner(const firmware::MachineParameters<float>& machine,
                       const std::vector<firmware::NumberedTool>& tools)
    : machine_(machine), tools_(tools), tool_(tools.size()) {
    for (RunMemory* const run : {&run_, &longest_}) {
        run->blocks.reserve(most_blocks);
        run->bins.resize(RunMemory::bin_at(longest_mm));
    }
}

std::size_t MapLearner::place_of(std::uint32_t number) const {
    const auto found = std::find_if(tools_.begin(), tools_.end(),
                                    [number](const firmware::NumberedTool& tool) { return tool.number == number; });
    return static_cast<std::size_t>(found - tools_.begin());
}

void MapLearner::set_tool(std::uint32_t number) {
    tool_ = place_of(number);
    last_middle_mm_.reset();
}

void MapLearner::take(const firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) {
    const std::optional<double> path_mm = tool_ < tools_.size() ? follow(program) : std::nullopt;
    if (!path_mm) {
        last_middle_mm_.reset();
        return;
    }
    const estimation::CutEstimate<float>& e = tick.estimate();
    RunMemory::Block& block = run_.blocks.back();
    if (e.spindle_speed_rad_s > 0.0F) {
        block.spindle_speed_rad_s = e.spindle_speed_rad_s;
    }
    run_.path_mm = std::max(run_.path_mm, *path_mm);
    if (!tick.has_new_estimate() || !e.tangential_N.valid) {
        return;
    }
    const float behind_s = 0.5F * e.window_s + firmware::load_delay_s(machine_);
    const double middle_mm = std::max(0.0, *path_mm - static_cast<double>(e.feed_mm_s * behind_s));
    const double last_mm = last_middle_mm_.value_or(middle_mm);
    last_middle_mm_ = middle_mm;
    const double travel_mm = middle_mm - last_mm;
    const bool is_there = middle_mm < longest_mm - RunMemory::bin_mm;
    if (!(travel_mm > 0.0) || travel_mm > longest_gap_mm || !is_there) {
        return;
    }
    const std::size_t last = RunMemory::bin_at(middle_mm);
    for (std::size_t k = std::min(RunMemory::bin_at(last_mm) + 1, last); k <= last; ++k) {
        add(run_.bins[k], tick);
    }
    run_.used = std::max(run_.used, last + 1);
}

std::optional<double> MapLearner::follow(const hal::ProgramStatus& program) {
    const auto to_go_mm = static_cast<double>(program.distance_to_go_mm);
    if (program.line == 0 || !std::isfinite(to_go_mm) || to_go_mm < 0.0) {
        return std::nullopt;
    }
    const bool goes_on = !run_.blocks.empty() && run_.blocks.back().tool == tool_ &&
                         run_.blocks.back().line == program.line && to_go_mm <= to_go_mm_ + blending_mm;
    if (!goes_on) {
        begin_block(program);
    }
    to_go_mm_ = to_go_mm;
    RunMemory::Block& block = run_.blocks.back();
    block.rapid = block.rapid || program.rapid;
    block.feed_mm_s = std::max(block.feed_mm_s, program.programmed_feed_mm_s);
    return block.end_mm - to_go_mm;
}

void MapLearner::begin_block(const hal::ProgramStatus& program) {
    if (begins_again(program)) {
        begin_run();
    }
    if (run_.blocks.size() == most_blocks) {
        run_.blocks.back().line = program.line;  // the path beyond is not known
    } else {
        RunMemory::Block block;
        block.tool = tool_;
        block.line = program.line;
        block.begin_mm = run_.blocks.empty() ? 0.0 : run_.blocks.back().end_mm - to_go_mm_;
        run_.blocks.push_back(block);
    }
    run_.blocks.back().end_mm = run_.blocks.back().begin_mm + static_cast<double>(program.distance_to_go_mm);
}

/// Its first block is in work again.
bool MapLearner::begins_again(const hal::ProgramStatus& program) const {
    if (run_.blocks.size() < 2) {
        return false;
    }
    const RunMemory::Block& first = run_.blocks.front();
    const double length_mm = first.end_mm - first.begin_mm;
    return program.line == first.line &&
           std::abs(static_cast<double>(program.distance_to_go_mm) - length_mm) <= blending_mm;
}

void MapLearner::begin_run() {
    if (run_.path_mm >= longest_.path_mm) {
        std::swap(run_, longest_);
    }
    std::fill_n(run_.bins.begin(), run_.used, RunMemory::Bin{});
    run_.blocks.clear();
    run_.used = 0;
    run_.path_mm = 0.0;
    last_middle_mm_.reset();
}

void MapLearner::add(RunMemory::Bin& bin, const firmware::ForceControlTick<float>& tick) const {
    constexpr std::uint16_t enough = 1000;
    const estimation::CutEstimate<float>& e = tick.estimate();
    const float sd_N = std::sqrt(e.tangential_N.variance);
    // Half of what counts as contact, as the tick re-zeroes in air: a faster run would feel it.
    const float least_N = 0.5F * control::contact_level_N(tools_[tool_].parameters.control, sd_N);
    if (bin.air + bin.contact >= enough) {
        return;
    }
    if (!(e.tangential_N.value > least_N)) {
        add_air(bin, least_N, e.feed_mm_s);
        return;
    }
    ++bin.contact;
    if (e.tangential_N.value > bin.highest_N) {
        bin.highest_N = e.tangential_N.value;
        bin.feed_per_tooth_mm = e.feed_per_tooth_mm;
    }
    const estimation::EngagementEstimate<float> cut = tick.engagement();
    if (!cut.immersion_valid || !cut.depth_valid || !(cut.axial_depth_mm > 0.0F)) {
        return;
    }
    ++bin.cut;
    bin.up = static_cast<std::uint16_t>(bin.up + (cut.side == estimation::CutSide::up ? 1 : 0));
    bin.immersion += cut.radial_immersion;
    bin.immersion_variance += cut.radial_immersion_sd * cut.radial_immersion_sd;
    bin.depth_mm += cut.axial_depth_mm;
    bin.depth_variance_mm2 += cut.axial_depth_force_sd_mm * cut.axial_depth_force_sd_mm;
}

void MapLearner::add_air(RunMemory::Bin& bin, float hidden_N, float feed_mm_s) {
    constexpr float slowest_mm_s = 0.01F;
    const float hidden_N_s_per_mm = hidden_N / std::max(feed_mm_s, slowest_mm_s);
    const bool is_first = bin.air == 0;
    bin.hidden_N_s_per_mm = is_first ? hidden_N_s_per_mm : std::min(bin.hidden_N_s_per_mm, hidden_N_s_per_mm);
    ++bin.air;
}

PartMap MapLearner::map(std::uint32_t number) const {
    const std::size_t tool = place_of(number);
    if (tool == tools_.size()) {
        return {};
    }
    const firmware::Parameters<float> parameters{machine_, tools_[tool].parameters};
    return map_of(run_.path_mm >= longest_.path_mm ? run_ : longest_, tool, parameters, stock_tolerance_mm_);
}

std::string about_memory(const PartMap& map) {
    if (map.empty()) {
        return "nothing learnt";
    }
    double unknown_mm = 0.0;
    for (std::size_t k = 0; k + 1 < map.size(); ++k) {
        unknown_mm += map[k].known == Known::nothing ? map[k + 1].path_mm - map[k].path_mm : 0.0;
    }
    std::string text = fmt::format("{:.0f} mm of path learnt", map.back().path_mm);
    text += unknown_mm > 0.0 ? fmt::format(", {:.0f} mm of it not known", unknown_mm) : "";
    const bool has_cut = std::any_of(map.begin(), map.end(), is_seen_cut);
    return text + (has_cut || !(unknown_mm > 0.0)
                       ? ""
                       : "; it holds air alone: without currents of the axes a run does not know how wide it cuts");
}

}  // namespace millforce::host
