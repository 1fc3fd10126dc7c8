// SPDX-License-Identifier: Apache-2.0
#include "preview/preview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>

#include "cnc/cnc.hpp"
#include "files/input_error.hpp"
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

/// Writes down what a tool meets on its own moves.
class MapWriter {
  public:
    MapWriter(double step_mm, const PreviewVisit& visit) : step_mm_(step_mm), visit_(visit) {}

    void follow(const Move& move, Workpiece& workpiece) {
        const double length = length_mm(move);
        place_.line = move.line;
        place_.block_end_mm = before_move_mm_ + length;
        place_.rapid = move.kind == MoveKind::rapid;
        place_.programmed_feed_mm_s = place_.rapid ? CncSettings{}.rapid_feed_mm_s : move.feed_mm_s;
        place_.spindle_speed_rad_s = move.spindle_speed_rad_s;
        const auto steps = static_cast<long>(std::ceil(length / step_mm_));
        for (long k = 0; k < steps; ++k) {
            const double s_mm = std::min(static_cast<double>(k) * step_mm_, length);
            place_.path_mm = before_move_mm_ + s_mm;
            workpiece.move_to(position_at(move, s_mm), direction_at(move, s_mm), place_.path_mm);
            place_.cut = arcs_in(workpiece.engagement());
            map_.push_back(place_);
            visit_(place_, workpiece.engagement());
        }
        before_move_mm_ += length;
    }

    /// With the end of the path.
    [[nodiscard]] host::PartMap map() const {
        host::PartMap map = map_;
        map.push_back(place_);
        map.back().path_mm = before_move_mm_;
        map.back().cut.clear();
        return map;
    }

  private:
    double step_mm_;
    PreviewVisit visit_;
    host::PartMap map_{};
    host::MapPlace place_{};
    double before_move_mm_ = 0.0;
};

void nobody(const host::MapPlace& /*place*/, const EngagementMap& /*engagement*/) {}

/// Null: it is not among them.
const Cutter* cutter_for(const Move& move, const Scenario& scenario) {
    const auto found = std::ranges::find(scenario.numbered_cutters, move.tool, &NumberedCutter::number);
    return found != scenario.numbered_cutters.end() ? &found->cutter : nullptr;
}

std::vector<MapOfTool> maps_of_tools(const Scenario& scenario, double step_mm) {
    StockWorkpiece workpiece(scenario.stock, scenario.numbered_cutters.front().cutter);
    std::map<std::uint32_t, MapWriter> writers;
    std::uint32_t in_spindle = 0;
    for (const Move& move : moves_of(scenario)) {
        const Cutter* const cutter = cutter_for(move, scenario);
        if (cutter == nullptr) {
            continue;
        }
        if (move.tool != in_spindle) {
            workpiece.change_tool(*cutter);
            in_spindle = move.tool;
        }
        writers.try_emplace(move.tool, step_mm, nobody).first->second.follow(move, workpiece);
    }
    std::vector<MapOfTool> maps;
    maps.reserve(writers.size());
    for (const auto& [number, writer] : writers) {
        maps.push_back({number, writer.map()});
    }
    return maps;
}

using Preview = std::function<std::vector<MapOfTool>(const Scenario& scenario)>;

std::vector<MapOfTool> within(const Scenario& scenario, double stock_tolerance_mm, const Preview& preview_of) {
    std::vector<MapOfTool> drawn = preview_of(scenario);
    if (!(stock_tolerance_mm > 0.0) || !scenario.has_program()) {
        return drawn;
    }
    std::vector<std::vector<PossibleCuts>> cuts;
    cuts.reserve(drawn.size());
    for (const MapOfTool& tool : drawn) {
        cuts.emplace_back(tool.map.begin(), tool.map.end());
    }
    for (const double x_sign : {-1.0, 1.0}) {
        for (const double y_sign : {-1.0, 1.0}) {
            Scenario shifted = scenario;
            shifted.stock.move_by(x_sign * stock_tolerance_mm, y_sign * stock_tolerance_mm);
            const std::vector<MapOfTool> off = preview_of(shifted);
            for (std::size_t i = 0; i < cuts.size(); ++i) {
                for (std::size_t k = 0; k < cuts[i].size(); ++k) {
                    cuts[i][k].add(off[i].map[k].cut);
                }
            }
        }
    }
    std::vector<MapOfTool> maps(drawn.size());
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        maps[i].number = drawn[i].number;
        std::ranges::transform(cuts[i], std::back_inserter(maps[i].map), &PossibleCuts::place);
    }
    return maps;
}

}  // namespace

host::PartMap preview_within(const Scenario& scenario, double stock_tolerance_mm, double step_mm) {
    const auto preview_of = [step_mm](const Scenario& one) {
        return std::vector<MapOfTool>{{0, preview(one, step_mm)}};
    };
    return within(scenario, stock_tolerance_mm, preview_of).front().map;
}

std::vector<MapOfTool> preview_of_tools(const Scenario& scenario, double stock_tolerance_mm, double step_mm) {
    return within(scenario, stock_tolerance_mm, [step_mm](const Scenario& one) { return maps_of_tools(one, step_mm); });
}

void require_tools_of(const Scenario& scenario, const std::vector<std::uint32_t>& left_standing) {
    for (const Move& move : moves_of(scenario)) {
        const bool cuts = move.kind != MoveKind::rapid && move.kind != MoveKind::dwell;
        const bool is_left_standing = std::ranges::find(left_standing, move.tool) != left_standing.end();
        if (!cuts || is_left_standing || cutter_for(move, scenario) != nullptr) {
            continue;
        }
        if (move.tool == 0) {
            throw host::InputError(
                fmt::format("{}:{}: a feed without a tool, expected an M6 before", scenario.program_file, move.line));
        }
        throw host::InputError(
            fmt::format("{}:{}: a feed of T{}, which has no file: expected T{}.toml, or --without-tool {} to leave its "
                        "cut standing",
                        scenario.program_file, move.line, move.tool, move.tool, move.tool));
    }
}

host::PartMap preview(const Scenario& scenario, double step_mm) {
    return preview(scenario, step_mm, nobody);
}

host::PartMap preview(const Scenario& scenario, double step_mm, const PreviewVisit& visit) {
    const std::unique_ptr<Workpiece> workpiece = workpiece_of(scenario);
    MapWriter writer(step_mm, visit);
    for (const Move& move : moves_of(scenario)) {
        writer.follow(move, *workpiece);
    }
    return writer.map();
}

}  // namespace millforce::sim
