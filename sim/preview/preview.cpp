// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "cnc/cnc.hpp"
#include "loop/simulation.hpp"
#include "loop/workpiece.hpp"

namespace millforce::sim {

namespace {

std::vector<host::EngagedArc> arcs_in(const EngagementMap& engagement) {
    std::vector<host::EngagedArc> arcs;
    for (const UniformArc& arc : uniform_arcs(engagement)) {
        arcs.push_back({arc.entry_rad, arc.exit_rad, arc.height_mm});
    }
    return arcs;
}

/// Across the feed, in units of the radius, times the depth.
double section_of(const std::vector<host::EngagedArc>& cut) {
    double section = 0.0;
    for (const host::EngagedArc& arc : cut) {
        section += arc.axial_depth_mm * (std::cos(arc.entry_rad) - std::cos(arc.exit_rad));
    }
    return section;
}

/// What the controller takes for the same cut in another steel.
bool is_alike(const std::vector<host::EngagedArc>& drawn, const std::vector<host::EngagedArc>& shifted) {
    constexpr double alike_rad = 0.3;
    constexpr double smallest_share = 0.6;
    constexpr double largest_share = 1.5;
    const double share = section_of(shifted) / section_of(drawn);
    return (drawn.empty() && shifted.empty()) ||
           (share > smallest_share && share < largest_share &&
            std::ranges::equal(drawn, shifted, [](const host::EngagedArc& a, const host::EngagedArc& b) {
                return std::abs(a.entry_rad - b.entry_rad) < alike_rad && std::abs(a.exit_rad - b.exit_rad) < alike_rad;
            }));
}

/// The cuts of one place, for each blank that may be there.
class PossibleCuts {
  public:
    explicit PossibleCuts(const host::MapPlace& drawn)
        : drawn_(&drawn), largest_(drawn.cut), least_section_(section_of(drawn.cut)) {}

    void add(const std::vector<host::EngagedArc>& cut) {
        are_alike_ = are_alike_ && is_alike(drawn_->cut, cut);
        least_section_ = std::min(least_section_, section_of(cut));
        if (section_of(cut) > section_of(largest_)) {
            largest_ = cut;
        }
    }

    [[nodiscard]] host::MapPlace place() const {
        constexpr double steps = 10.0;  // or no two neighbours were alike
        constexpr double most = 0.9;    // where the sections are equal, but not the arcs
        host::MapPlace place = *drawn_;
        if (!are_alike_) {
            place.known = host::Known::at_most;
            place.cut = largest_;
            place.least_share = std::min(most, std::floor(steps * least_section_ / section_of(largest_)) / steps);
        }
        return place;
    }

  private:
    const host::MapPlace* drawn_;
    std::vector<host::EngagedArc> largest_;
    double least_section_;
    bool are_alike_ = true;
};

}  // namespace

host::PartMap preview_within(const Scenario& scenario, double stock_tolerance_mm, double step_mm) {
    host::PartMap drawn = preview(scenario, step_mm);
    if (!(stock_tolerance_mm > 0.0) || !scenario.has_program()) {
        return drawn;
    }
    std::vector<PossibleCuts> cuts(drawn.begin(), drawn.end());
    for (const double x_sign : {-1.0, 1.0}) {
        for (const double y_sign : {-1.0, 1.0}) {
            Scenario shifted = scenario;
            shifted.stock.move_by(x_sign * stock_tolerance_mm, y_sign * stock_tolerance_mm);
            const host::PartMap off = preview(shifted, step_mm);
            for (std::size_t k = 0; k < cuts.size(); ++k) {
                cuts[k].add(off[k].cut);
            }
        }
    }
    host::PartMap map;
    map.reserve(cuts.size());
    for (const PossibleCuts& possible : cuts) {
        map.push_back(possible.place());
    }
    return map;
}

host::PartMap preview(const Scenario& scenario, double step_mm) {
    return preview(scenario, step_mm, [](const host::MapPlace&, const EngagementMap&) {});
}

host::PartMap preview(const Scenario& scenario, double step_mm, const PreviewVisit& visit) {
    const std::unique_ptr<Workpiece> workpiece = workpiece_of(scenario);
    const double rapid_mm_s = CncSettings{}.rapid_feed_mm_s;
    host::PartMap map;
    host::MapPlace place;
    double before_move_mm = 0.0;
    for (const Move& move : moves_of(scenario)) {
        const double length = length_mm(move);
        place.line = move.line;
        place.block_end_mm = before_move_mm + length;
        place.rapid = move.kind == MoveKind::rapid;
        place.programmed_feed_mm_s = place.rapid ? rapid_mm_s : move.feed_mm_s;
        place.spindle_speed_rad_s = move.spindle_speed_rad_s;
        const auto steps = static_cast<long>(std::ceil(length / step_mm));
        for (long k = 0; k < steps; ++k) {
            const double s_mm = std::min(static_cast<double>(k) * step_mm, length);
            place.path_mm = before_move_mm + s_mm;
            workpiece->move_to(position_at(move, s_mm), direction_at(move, s_mm), place.path_mm);
            place.cut = arcs_in(workpiece->engagement());
            map.push_back(place);
            visit(place, workpiece->engagement());
        }
        before_move_mm += length;
    }
    place.path_mm = before_move_mm;
    place.cut.clear();
    map.push_back(place);
    return map;
}

}  // namespace millforce::sim
