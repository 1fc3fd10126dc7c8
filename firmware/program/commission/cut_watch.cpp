// SPDX-License-Identifier: Apache-2.0
#include "commission/cut_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/atomic_file.hpp"

namespace millforce::host {

namespace {

constexpr double feed_tolerance_of_pass = 0.03;
constexpr double settling_mm = 2.0;  // after a change of the feed, or of the cut

/// Travel from the first touch of the side until the whole width is in cut.
double entry_mm(double radius_mm, double width_mm) {
    return std::sqrt(std::max(width_mm * (2.0 * radius_mm - width_mm), 0.0));
}

}  // namespace

CutWatch::CutWatch(const CutWatchSettings& settings) : settings_(settings), blocks_(settings.counts_per_rev) {}

void CutWatch::add(const TimedSample& timed) {
    if (const auto block = blocks_.add(timed)) {
        take_block(*block);
    }
}

/// One axis alone, at the feed and the speed of the part.
bool CutWatch::is_in_run(const RevolutionBlock& block) const {
    const double feed = block.velocity_mm_s.at(settings_.axis);
    return has_part_ && std::abs(feed - part_.feed_mm_s) <= feed_tolerance_of_pass * std::abs(part_.feed_mm_s) &&
           std::abs(block.spindle_rad_s - speed_rad_s_) <= 0.02 * speed_rad_s_;
}

void CutWatch::take_block(const RevolutionBlock& block) {
    constexpr double at_rest_mm_s = 0.2;
    double others_mm_s = 0.0;
    for (std::size_t axis = 0; axis < block.velocity_mm_s.size(); ++axis) {
        others_mm_s += axis == settings_.axis ? 0.0 : std::abs(block.velocity_mm_s[axis]);
    }
    const bool feeds = std::abs(block.velocity_mm_s.at(settings_.axis)) > at_rest_mm_s;
    if (!feeds || others_mm_s > at_rest_mm_s) {
        end_part();
        return;
    }
    if (!is_in_run(block)) {
        end_part();
        speed_rad_s_ = block.spindle_rad_s;
        begin_part(block, knows_air_ && block.spindle_current_A > air_A_ + 0.5 * settings_.smallest_rise_A);
        return;
    }
    // The idle current drifts as the bearing warms up: each part is compared with the air next to it.
    const bool in_cut = block.spindle_current_A > air_A_ + 0.5 * settings_.smallest_rise_A;
    if (knows_air_ && in_cut != part_.in_cut) {
        end_part();
        begin_part(block, in_cut);
        return;
    }
    ++part_.blocks;
    part_.end_s = block.end_s;
    part_.current_A += (block.spindle_current_A - part_.current_A) / static_cast<double>(part_.blocks);
    if (!part_.in_cut && part_.blocks >= 3) {
        air_A_ = part_.current_A;
        knows_air_ = true;
    }
}

void CutWatch::begin_part(const RevolutionBlock& block, bool in_cut) {
    has_part_ = true;
    part_ = {in_cut, block.start_s, block.end_s, block.spindle_current_A, block.velocity_mm_s.at(settings_.axis), 1};
}

void CutWatch::end_part() {
    if (has_part_) {
        use(part_);
    }
    has_part_ = false;
}

void CutWatch::end() {
    end_part();
    blocks_.reset();
}

FoundStretch CutWatch::middle_of(const Part& part, const CutPass& pass) const {
    const double speed_mm_s = std::abs(part.feed_mm_s);
    const double margin_s =
        (settling_mm + entry_mm(0.5 * settings_.tool_diameter_mm, pass.radial_width_mm)) / speed_mm_s;
    const double free_mm = (part.end_s - part.start_s - 2.0 * margin_s) * speed_mm_s;
    const double turns = std::floor(free_mm / settings_.travel_per_motor_turn_mm);
    if (turns < 1.0) {
        return {part.start_s, part.start_s};
    }
    const double start_s = part.start_s + margin_s;
    return {start_s, start_s + turns * settings_.travel_per_motor_turn_mm / speed_mm_s};
}

void CutWatch::use(const Part& part) {
    if (is_enough()) {
        return;
    }
    const CutPass& pass = settings_.passes[next_];
    const double feed_mm_s = pass.feed_mm_min / 60.0;
    if (std::abs(std::abs(part.feed_mm_s) - feed_mm_s) > feed_tolerance_of_pass * feed_mm_s) {
        return;
    }
    FoundStretch found = middle_of(part, pass);
    if (found.end_s <= found.start_s) {
        if (part.in_cut && part.blocks > 3) {
            tell(fmt::format("  cut {}: too short, {:.1f} mm", next_ + 1,
                             (part.end_s - part.start_s) * std::abs(part.feed_mm_s)));
        }
        return;
    }
    if (!part.in_cut) {
        pending_air_ = found;
        return;
    }
    if (pending_air_.end_s <= pending_air_.start_s) {
        tell(fmt::format("  cut {}: no air before it; not used", next_ + 1));
        return;
    }
    found.axial_depth_mm = pass.axial_depth_mm;
    found.radial_width_mm = pass.radial_width_mm;
    stretches_.push_back(pending_air_);
    stretches_.push_back(found);
    pending_air_ = {};
    ++next_;
    tell(fmt::format("  cut {} of {}: {:.0f} mm/min, {:g} mm wide: {:.3f} A above the air before it", next_,
                     settings_.passes.size(), pass.feed_mm_min, pass.radial_width_mm, part.current_A - air_A_));
}

std::string CutWatch::lacks() const {
    if (is_enough()) {
        return {};
    }
    const CutPass& pass = settings_.passes[next_];
    return fmt::format("{} of {} cuts, next {:.0f} mm/min, {:g} mm deep, {:g} mm wide, after air at the same feed",
                       settings_.passes.size() - next_, settings_.passes.size(), pass.feed_mm_min, pass.axial_depth_mm,
                       pass.radial_width_mm);
}

void CutWatch::write_table(const std::filesystem::path& table, const std::filesystem::path& recording) const {
    AtomicFile file(table);
    file.stream() << "recording,start_s,end_s,tool_diameter_mm,flutes,axial_depth_mm,radial_width_mm\n";
    for (const FoundStretch& stretch : stretches_) {
        file.stream() << fmt::format("{},{:.4f},{:.4f},{:g},{},{:g},{:g}\n", recording.filename().string(),
                                     stretch.start_s, stretch.end_s, settings_.tool_diameter_mm, settings_.flutes,
                                     stretch.axial_depth_mm, stretch.radial_width_mm);
    }
    file.commit();
}

}  // namespace millforce::host
