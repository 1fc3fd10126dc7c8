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

}  // namespace

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
