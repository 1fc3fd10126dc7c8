// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_learner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "estimation/cutting/cutting_law.hpp"

namespace millforce::host {

namespace {

/// The distance to go may grow by that much within a block, where a corner is blended.
constexpr double blending_mm = 0.5;
/// Between two estimates: a longer way was not seen.
constexpr double longest_gap_mm = 10.0;

std::size_t bin_at(double path_mm) {
    return static_cast<std::size_t>(std::max(path_mm, 0.0) / MapLearner::bin_mm);
}

/// R_r = 1 − cos θ. The larger of both sides: near a slot, and near nothing, the arc's end answers to R_r by a root.
double arc_sd_rad(double immersion, double immersion_sd) {
    const auto angle = [](double radial) { return std::acos(1.0 - std::clamp(radial, 0.0, 2.0)); };
    const double middle = angle(immersion);
    return std::max(angle(immersion + immersion_sd) - middle, middle - angle(immersion - immersion_sd));
}

bool is_seen_cut(const MapPlace& place) {
    return place.known == Known::cut && !place.cut.empty();
}

double depth_mm(const MapPlace& place) {
    return place.cut.front().axial_depth_mm;
}

MapPlace at_most(MapPlace place) {
    place.known = place.known == Known::cut ? Known::at_most : place.known;
    place.least_share = 0.0;
    return place;
}

/// The cuts on both sides of a row of pieces without an engagement.
struct Neighbours {
    const MapPlace* cut = nullptr;  // of the larger section
    bool is_same_block = true;      // the row and that cut: the path does not turn between them
};

Neighbours neighbours_of(const std::vector<MapPlace>& places, std::size_t k, std::size_t reach) {
    Neighbours found;
    const auto section = [](const MapPlace& place) { return immersion_of(place) * depth_mm(place); };
    const auto look = [&](std::size_t at) {
        found.is_same_block = found.is_same_block && (is_air(places[at]) || places[at].line == places[k].line);
        if (is_seen_cut(places[at]) && (found.cut == nullptr || section(*found.cut) < section(places[at]))) {
            found.cut = &places[at];
        }
        return is_air(places[at]) || is_seen_cut(places[at]);
    };
    for (std::size_t at = k; at < std::min(places.size(), k + reach) && !look(at); ++at) {
    }
    for (std::size_t at = k; at + reach > k && !look(at) && at > 0; --at) {
    }
    return found;
}

/// The deepest cut of the same block that was seen within `reach` pieces of the cut in piece k.
const MapPlace& deepest_around(const std::vector<MapPlace>& places, std::size_t k, std::size_t reach) {
    const MapPlace* deepest = &places[k];
    const std::size_t end = std::min(places.size(), k + reach + 1);
    for (std::size_t at = k > reach ? k - reach : 0; at < end; ++at) {
        const bool is_deeper =
            is_seen_cut(places[at]) && places[at].line == places[k].line && depth_mm(places[at]) > depth_mm(*deepest);
        deepest = is_deeper ? &places[at] : deepest;
    }
    return *deepest;
}

/// Estimates differ from one piece of the path to the next by their noise; a cut that stays the same is one place.
class Smoother {
  public:
    explicit Smoother(PartMap& map) : map_(map) {}

    void add(const MapPlace& place) {
        if (!map_.empty() && may_join(map_.back(), place)) {
            join(map_.back(), place);
            return;
        }
        joined_ = 1;
        map_.push_back(place);
    }

  private:
    [[nodiscard]] static bool may_join(const MapPlace& a, const MapPlace& b) {
        constexpr double alike_immersion = 0.05;
        constexpr double alike_depth = 0.04;
        if (a.block_end_mm != b.block_end_mm || a.known != b.known || a.cut.size() != b.cut.size()) {
            return false;
        }
        if (a.cut.empty()) {
            return true;
        }
        const bool is_same_side = (a.cut.front().entry_rad > 0.0) == (b.cut.front().entry_rad > 0.0);
        return is_same_side && std::abs(immersion_of(a) - immersion_of(b)) <= alike_immersion &&
               std::abs(depth_mm(a) - depth_mm(b)) <= alike_depth * depth_mm(a);
    }

    void join(MapPlace& a, const MapPlace& b) {
        joined_ += 1;
        const double share = 1.0 / joined_;
        const auto mix = [share](double& value, double with) { value += share * (with - value); };
        for (std::size_t k = 0; k < a.cut.size(); ++k) {
            mix(a.cut[k].entry_rad, b.cut[k].entry_rad);
            mix(a.cut[k].exit_rad, b.cut[k].exit_rad);
            mix(a.cut[k].axial_depth_mm, b.cut[k].axial_depth_mm);
        }
        mix(a.arc_sd_rad, b.arc_sd_rad);
        mix(a.axial_depth_sd_mm, b.axial_depth_sd_mm);
    }

    PartMap& map_;
    double joined_ = 0.0;
};

}  // namespace

MapLearner::MapLearner(const firmware::Parameters<float>& parameters)
    : MapLearner(parameters.machine, {{0, parameters.tool}}) {
    set_tool(0);
}

MapLearner::MapLearner(const firmware::MachineParameters<float>& machine,
                       const std::vector<firmware::NumberedTool>& tools)
    : machine_(machine), tools_(tools), tool_(tools.size()) {
    for (Run* const run : {&run_, &longest_}) {
        run->blocks.reserve(most_blocks);
        run->bins.resize(bin_at(longest_mm));
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

// ---- Along the path
// --------------------------------------------------------------------------------------------------

void MapLearner::take(const firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) {
    const std::optional<double> path_mm = tool_ < tools_.size() ? follow(program) : std::nullopt;
    if (!path_mm) {
        last_middle_mm_.reset();
        return;
    }
    const estimation::CutEstimate<float>& e = tick.estimate();
    Block& block = run_.blocks.back();
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
    const bool is_there = middle_mm < longest_mm - bin_mm;
    if (!(travel_mm > 0.0) || travel_mm > longest_gap_mm || !is_there) {
        return;
    }
    const std::size_t last = bin_at(middle_mm);
    for (std::size_t k = std::min(bin_at(last_mm) + 1, last); k <= last; ++k) {
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
    Block& block = run_.blocks.back();
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
        Block block;
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
    const Block& first = run_.blocks.front();
    const double length_mm = first.end_mm - first.begin_mm;
    return program.line == first.line &&
           std::abs(static_cast<double>(program.distance_to_go_mm) - length_mm) <= blending_mm;
}

void MapLearner::begin_run() {
    if (run_.path_mm >= longest_.path_mm) {
        std::swap(run_, longest_);
    }
    std::fill_n(run_.bins.begin(), run_.used, Bin{});
    run_.blocks.clear();
    run_.used = 0;
    run_.path_mm = 0.0;
    last_middle_mm_.reset();
}

void MapLearner::add(Bin& bin, const firmware::ForceControlTick<float>& tick) const {
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

void MapLearner::add_air(Bin& bin, float hidden_N, float feed_mm_s) {
    constexpr float slowest_mm_s = 0.01F;
    const float hidden_N_s_per_mm = hidden_N / std::max(feed_mm_s, slowest_mm_s);
    const bool is_first = bin.air == 0;
    bin.hidden_N_s_per_mm = is_first ? hidden_N_s_per_mm : std::min(bin.hidden_N_s_per_mm, hidden_N_s_per_mm);
    ++bin.air;
}

// ---- What was seen
// ---------------------------------------------------------------------------------------------------

/// What a run has seen, by the law of one of its tools.
class MapLearner::SeenRun {
  public:
    SeenRun(const Run& run, std::size_t tool, const firmware::Parameters<float>& parameters, double stock_tolerance_mm)
        : run_(run), tool_(tool), parameters_(parameters), next_blank_off_(bin_at(2.0 * stock_tolerance_mm)) {}

    [[nodiscard]] PartMap map() const;

  private:
    [[nodiscard]] std::vector<MapPlace> seen() const;
    [[nodiscard]] MapPlace seen_in(const Bin& bin) const;
    [[nodiscard]] bool is_surely_air(const Bin& bin, const Block& block) const;
    [[nodiscard]] bool carries(const std::vector<EngagedArc>& cut, const Bin& bin) const;
    [[nodiscard]] std::size_t reach() const { return bin_at(2.0 * static_cast<double>(parameters_.tool.diameter_mm)); }
    void bound_by(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const;
    void doubt_depth(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const;
    [[nodiscard]] std::vector<MapPlace> doubted_beside_cuts(const std::vector<MapPlace>& places) const;
    void set_at_most(const MapPlace& cut, bool arc_is_known, const Bin& bin, MapPlace& place) const;
    [[nodiscard]] double end_of(std::size_t block) const;

    const Run& run_;
    std::size_t tool_;
    const firmware::Parameters<float>& parameters_;
    std::size_t next_blank_off_;  // pieces by which another blank may lie elsewhere
};

PartMap MapLearner::map(std::uint32_t number) const {
    const std::size_t tool = place_of(number);
    if (tool == tools_.size()) {
        return {};
    }
    const firmware::Parameters<float> parameters{machine_, tools_[tool].parameters};
    return SeenRun(run_.path_mm >= longest_.path_mm ? run_ : longest_, tool, parameters, stock_tolerance_mm_).map();
}

MapPlace MapLearner::SeenRun::seen_in(const Bin& bin) const {
    constexpr int by_noise = 4;  // of so many estimates in air one may seem to be in contact
    MapPlace seen;
    if (bin.air > by_noise * bin.contact) {
        return seen;
    }
    if (bin.cut == 0 || 2 * bin.cut < bin.contact) {
        seen.known = bin.contact > 0 ? Known::at_most : Known::nothing;
        return seen;
    }
    const auto count = static_cast<float>(bin.cut);
    const bool is_centred = parameters_.tool.side == estimation::CutSide::centred;
    const estimation::CutSide up_or_down = 2 * bin.up > bin.cut ? estimation::CutSide::up : estimation::CutSide::down;
    const float immersion = bin.immersion / count;
    const auto angles = estimation::engagement_angles(is_centred ? estimation::CutSide::centred : up_or_down, immersion,
                                                      firmware::estimator_settings(parameters_).centre_offset_in_radii);
    seen.cut = {{static_cast<double>(angles.entry_rad), static_cast<double>(angles.exit_rad),
                 static_cast<double>(bin.depth_mm / count)}};
    seen.arc_sd_rad =
        arc_sd_rad(static_cast<double>(immersion), static_cast<double>(std::sqrt(bin.immersion_variance / count)));
    seen.axial_depth_sd_mm = static_cast<double>(std::sqrt(bin.depth_variance_mm2 / count));
    return seen;
}

/// Of each bin; what is at most a neighbour's cut bears that cut.
std::vector<MapPlace> MapLearner::SeenRun::seen() const {
    std::vector<MapPlace> seen(run_.used);
    std::transform(run_.bins.begin(), run_.bins.begin() + static_cast<std::ptrdiff_t>(run_.used), seen.begin(),
                   [this](const Bin& bin) { return seen_in(bin); });
    for (const Block& block : run_.blocks) {
        for (std::size_t k = bin_at(block.begin_mm); k < std::min(bin_at(block.end_mm) + 1, seen.size()); ++k) {
            seen[k].line = block.line;
            if (is_air(seen[k]) && !is_surely_air(run_.bins[k], block)) {
                seen[k].known = Known::nothing;
            }
        }
    }
    std::vector<MapPlace> completed = seen;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        if (seen[k].known == Known::at_most) {
            bound_by(seen, k, completed[k]);
        } else if (is_seen_cut(seen[k])) {
            doubt_depth(seen, k, completed[k]);
        }
    }
    return doubted_beside_cuts(completed);
}

/// What was hidden is a force at the feed of that time, and grows with it.
bool MapLearner::SeenRun::is_surely_air(const Bin& bin, const Block& block) const {
    constexpr float tooth_per_tangential = 4.0F;  // of a narrow cut, its runout included
    const float air_mm_s = block.feed_mm_s * parameters_.machine.cnc.override_max;
    return block.rapid ||
           tooth_per_tangential * bin.hidden_N_s_per_mm * air_mm_s < parameters_.tool.tooth_force_limit_N;
}

/// F_at of the cut is not below that which was measured there, but for the noise.
bool MapLearner::SeenRun::carries(const std::vector<EngagedArc>& cut, const Bin& bin) const {
    constexpr float noise = 1.1F;
    float tangential_N = 0.0F;
    for (const EngagedArc& arc : cut) {
        const estimation::EngagementAngles<float> angles{static_cast<float>(arc.entry_rad),
                                                         static_cast<float>(arc.exit_rad)};
        tangential_N += estimation::average_forces(parameters_.tool.law,
                                                   estimation::CutConditions<float>{
                                                       bin.feed_per_tooth_mm, static_cast<float>(arc.axial_depth_mm),
                                                       angles, static_cast<float>(parameters_.tool.teeth)})
                            .tangential_N;
    }
    return bin.highest_N <= noise * tangential_N;
}

/// Where the tool goes straight on, the arc of an entry or exit is a part of its neighbour's; elsewhere only the depth
/// is known.
void MapLearner::SeenRun::bound_by(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const {
    const Neighbours neighbours = neighbours_of(seen, k, reach());
    place.known = Known::nothing;
    if (neighbours.cut != nullptr) {
        set_at_most(*neighbours.cut, neighbours.is_same_block, run_.bins[k], place);
    }
}

/// Over a hole, or along a slot, a tooth cuts deep on both sides of a gap: its means are those of a wide and shallow
/// cut.
void MapLearner::SeenRun::doubt_depth(const std::vector<MapPlace>& seen, std::size_t k, MapPlace& place) const {
    constexpr double much_shallower = 0.6;
    const MapPlace& deepest = deepest_around(seen, k, reach());
    if (depth_mm(seen[k]) < much_shallower * depth_mm(deepest)) {
        set_at_most(deepest, true, run_.bins[k], place);
    }
}

/// Where this blank had air, the next one may have stock.
std::vector<MapPlace> MapLearner::SeenRun::doubted_beside_cuts(const std::vector<MapPlace>& places) const {
    std::vector<MapPlace> doubted = places;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::size_t begin = k > next_blank_off_ ? k - next_blank_off_ : 0;
        const std::size_t end = std::min(places.size(), k + next_blank_off_ + 1);
        for (std::size_t at = begin; at < end && is_air(doubted[k]); ++at) {
            doubted[k] = is_air(places[at]) ? doubted[k] : at_most(places[at]);
        }
    }
    return doubted;
}

void MapLearner::SeenRun::set_at_most(const MapPlace& cut, bool arc_is_known, const Bin& bin, MapPlace& place) const {
    place = cut;
    place.known = Known::at_most;
    if (!arc_is_known || !carries(place.cut, bin)) {
        place.cut = {{0.0, std::numbers::pi, depth_mm(cut)}};
        place.known = carries(place.cut, bin) ? Known::at_most : Known::nothing;
    }
}

/// How far the run was in a block. A CNC may go on with the next one before it has told the end of this one.
double MapLearner::SeenRun::end_of(std::size_t block) const {
    const bool is_last = block + 1 == run_.blocks.size();
    const double next_mm = is_last ? run_.path_mm : run_.blocks[block + 1].begin_mm;
    return std::min({run_.blocks[block].end_mm, run_.path_mm, next_mm});
}

PartMap MapLearner::SeenRun::map() const {
    const std::vector<MapPlace> seen = this->seen();
    PartMap map;
    Smoother smoother(map);
    double by_others_mm = 0.0;
    double end_mm = 0.0;
    for (std::size_t i = 0; i < run_.blocks.size(); ++i) {
        const Block& block = run_.blocks[i];
        if (block.tool != tool_) {
            by_others_mm += std::max(end_of(i) - block.begin_mm, 0.0);
            continue;
        }
        double path_mm = block.begin_mm;
        while (path_mm < end_of(i)) {
            const std::size_t k = bin_at(path_mm);
            MapPlace place;
            place.known = Known::nothing;
            if (k < seen.size() && block.feed_mm_s > 0.0F && block.spindle_speed_rad_s > 0.0F) {
                place = seen[k];
            }
            place.path_mm = path_mm - by_others_mm;
            place.block_end_mm = block.end_mm - by_others_mm;
            place.line = block.line;
            place.rapid = block.rapid;
            place.programmed_feed_mm_s = static_cast<double>(block.feed_mm_s);
            place.spindle_speed_rad_s = static_cast<double>(block.spindle_speed_rad_s);
            smoother.add(place);
            path_mm = std::min(bin_mm * static_cast<double>(k + 1), block.end_mm);
        }
        end_mm = (i + 1 == run_.blocks.size() ? run_.path_mm : end_of(i)) - by_others_mm;
    }
    if (!map.empty()) {
        MapPlace end = map.back();
        end.path_mm = end_mm;
        end.cut.clear();
        end.known = Known::cut;
        end.arc_sd_rad = 0.0;
        end.axial_depth_sd_mm = 0.0;
        map.push_back(end);
    }
    return map;
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
