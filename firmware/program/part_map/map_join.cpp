// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_join.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimation/cutting/cutting_law.hpp"

namespace millforce::host {

namespace {

constexpr double step_mm = 0.5;
/// Around a change of the cut the two are not compared: each may have it elsewhere.
constexpr double margin_mm = 1.5;
constexpr double geometry_relative_sd = 0.05;
constexpr double significance = 3.0;
constexpr double shortest_contradiction_mm = 2.0;

struct Block {
    std::size_t line;
    double begin_mm;
    double end_mm;
};

std::vector<Block> blocks_of(const PartMap& map) {
    std::vector<Block> blocks;
    for (const MapPlace& place : map) {
        if (blocks.empty() || blocks.back().line != place.line || blocks.back().end_mm != place.block_end_mm) {
            blocks.push_back({place.line, place.path_mm, place.block_end_mm});
        }
    }
    return blocks;
}

/// The run's places on geometry's path, in their order.
PartMap on_path_of(const PartMap& geometry, const PartMap& run) {
    constexpr double unseen_mm = 5.0;  // of a block's begin, before the CNC first reported it
    constexpr double slack_mm = 1.0;
    const std::vector<Block> blocks = blocks_of(geometry);
    PartMap moved;
    auto block = blocks.begin();
    std::optional<double> shift_mm;
    double end_mm = -1.0;
    for (const MapPlace& place : run) {
        if (place.block_end_mm != end_mm) {
            end_mm = place.block_end_mm;
            const double length_mm = place.block_end_mm - place.path_mm;
            const auto match = std::find_if(block, blocks.end(), [&](const Block& b) {
                const double longer_mm = b.end_mm - b.begin_mm - length_mm;
                return b.line == place.line && longer_mm > -slack_mm && longer_mm < unseen_mm;
            });
            shift_mm = match != blocks.end() ? std::optional(match->end_mm - end_mm) : std::nullopt;
            block = match != blocks.end() ? match : block;
        }
        MapPlace here = place;
        here.path_mm += shift_mm.value_or(0.0);
        here.known = shift_mm ? here.known : Known::nothing;
        if (moved.empty() || here.path_mm > moved.back().path_mm) {
            moved.push_back(here);
        }
    }
    return moved;
}

/// The place that holds at `path_mm`.
const MapPlace* at(const PartMap& map, double path_mm) {
    const auto after = std::ranges::upper_bound(map, path_mm, {}, &MapPlace::path_mm);
    return after == map.begin() || after == map.end() ? nullptr : &*(after - 1);
}

/// F_at for each mm of depth would do as well: both are taken at the same feed.
double force_N(const MapPlace& place, const firmware::ToolParameters<float>& tool) {
    const float feed_per_tooth_mm = std::max(tool.control.entry_feed_per_tooth_mm, 0.01F);
    double sum_N = 0.0;
    for (const EngagedArc& arc : place.cut) {
        const estimation::CutConditions<float> cut{
            feed_per_tooth_mm,
            static_cast<float>(arc.axial_depth_mm),
            {static_cast<float>(arc.entry_rad), static_cast<float>(arc.exit_rad)},
            static_cast<float>(tool.teeth)};
        sum_N += static_cast<double>(estimation::average_forces(tool.law, cut).tangential_N);
    }
    return sum_N;
}

/// What both say of one piece of the path.
struct Pair {
    double path_mm = 0.0;
    std::size_t line = 0;
    const MapPlace* seen = nullptr;
    double log_ratio = 0.0;  ///< of the run's force over geometry's, where both know a cut
    double relative_sd = 0.0;
    bool is_cut = false;
    const char* contradiction = nullptr;
};

bool is_uniform_around(const PartMap& map, double path_mm) {
    const MapPlace* const here = at(map, path_mm);
    const int steps = static_cast<int>(2.0 * margin_mm / step_mm);
    for (int k = 0; k <= steps; ++k) {
        const MapPlace* const place = at(map, path_mm - margin_mm + step_mm * k);
        constexpr double alike = 0.1;
        if (place == nullptr || place->cut.size() != here->cut.size() ||
            std::abs(immersion_of(*place) - immersion_of(*here)) > alike) {
            return false;
        }
    }
    return true;
}

std::optional<Pair> pair_at(const PartMap& geometry, const PartMap& run, double path_mm,
                            const firmware::ToolParameters<float>& tool) {
    const MapPlace* const mapped = at(geometry, path_mm);
    const MapPlace* const seen = at(run, path_mm);
    if (mapped == nullptr || seen == nullptr || seen->known == Known::nothing || mapped->rapid ||
        !is_uniform_around(geometry, path_mm)) {
        return std::nullopt;
    }
    Pair pair{.path_mm = path_mm, .line = mapped->line, .seen = seen};
    if (mapped->cut.empty() != seen->cut.empty()) {
        pair.contradiction =
            mapped->cut.empty() ? "geometry has air, the run a cut" : "geometry has a cut, the run air";
        return pair;
    }
    if (mapped->cut.empty() || seen->known != Known::cut) {
        return pair;
    }
    pair.is_cut = true;
    pair.log_ratio = std::log(force_N(*seen, tool) / force_N(*mapped, tool));
    pair.relative_sd = std::max(seen->axial_depth_sd_mm / seen->cut.front().axial_depth_mm, 0.02);
    const double immersion = immersion_of(*seen);
    const double immersion_sd = seen->arc_sd_rad * std::sqrt(std::max(immersion * (2.0 - immersion), 0.01));
    constexpr double law_sd = 0.05;  // of the immersion, by the law's r_1
    if (std::abs(immersion - immersion_of(*mapped)) > significance * std::hypot(immersion_sd, law_sd)) {
        pair.contradiction = "the arcs differ";
    }
    return pair;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Over the cuts that agree in their arcs. Their median: a pass that is deeper than the others does not shift it.
void measure_hardness(const std::vector<Pair>& pairs, JoinedMap& result) {
    std::vector<double> logs;
    for (const Pair& pair : pairs) {
        if (pair.is_cut && pair.contradiction == nullptr) {
            logs.push_back(pair.log_ratio);
        }
    }
    result.compared_mm = step_mm * static_cast<double>(logs.size());
    if (logs.empty()) {
        return;
    }
    const double middle = median(logs);
    std::vector<double> off;
    off.reserve(logs.size());
    for (const double value : logs) {
        off.push_back(std::abs(value - middle));
    }
    constexpr double sd_per_median_deviation = 1.4826;  // of normal values
    result.hardness = std::exp(middle);
    result.hardness_sd = result.hardness * std::max(sd_per_median_deviation * median(off), 0.01);
}

std::vector<double> contacts_of(const PartMap& map) {
    std::vector<double> contacts;
    for (std::size_t k = 1; k < map.size(); ++k) {
        if (is_air(map[k - 1]) && !map[k].cut.empty()) {
            contacts.push_back(map[k].path_mm);
        }
    }
    return contacts;
}

struct Contact {
    double geometry_mm;
    double offset_mm;
};

std::vector<Contact> common_contacts(const PartMap& geometry, const PartMap& run) {
    constexpr double farthest_mm = 3.0;
    std::vector<Contact> common;
    const std::vector<double> seen = contacts_of(run);
    for (const double mapped_mm : contacts_of(geometry)) {
        const auto nearest =
            std::ranges::min_element(seen, {}, [mapped_mm](double seen_mm) { return std::abs(seen_mm - mapped_mm); });
        if (nearest != seen.end() && std::abs(*nearest - mapped_mm) <= farthest_mm) {
            common.push_back({mapped_mm, *nearest - mapped_mm});
        }
    }
    return common;
}

void measure_offset(const std::vector<Contact>& contacts, JoinedMap& result) {
    result.contacts = static_cast<int>(contacts.size());
    double sum_mm = 0.0;
    double sum_mm2 = 0.0;
    for (const Contact& contact : contacts) {
        sum_mm += contact.offset_mm;
        sum_mm2 += contact.offset_mm * contact.offset_mm;
    }
    const double count = std::max(static_cast<double>(contacts.size()), 1.0);
    result.offset_mm = sum_mm / count;
    result.offset_sd_mm = std::sqrt(std::max(sum_mm2 / count - result.offset_mm * result.offset_mm, 0.0));
}

/// The cuts of a block lie along its path as its contact was found: another block may go another way.
void shift_blocks(const PartMap& geometry, const std::vector<Contact>& contacts, PartMap& map) {
    constexpr double least_mm = 0.75;  // a piece of the run's map, and what a contact takes to be felt
    constexpr double contact_sd_mm = 0.5;
    for (const Contact& contact : contacts) {
        const MapPlace* const of_contact = at(geometry, contact.geometry_mm);
        const double shift_mm = std::abs(contact.offset_mm) > least_mm ? contact.offset_mm : 0.0;
        for (MapPlace& place : map) {
            if (place.block_end_mm != of_contact->block_end_mm || place.line != of_contact->line) {
                continue;
            }
            place.position_sd_mm = contact_sd_mm;
            const MapPlace* const source = at(geometry, place.path_mm - shift_mm);
            if (shift_mm != 0.0 && source != nullptr && source->block_end_mm == place.block_end_mm) {
                place.cut = source->cut;
            }
        }
    }
}

void note(Contradiction next, std::vector<Contradiction>& found) {
    const bool goes_on = !found.empty() && found.back().what == next.what && found.back().line == next.line &&
                         next.begin_mm - found.back().end_mm <= step_mm;
    if (goes_on) {
        found.back().end_mm = next.end_mm;
    } else {
        found.push_back(std::move(next));
    }
}

}  // namespace

JoinedMap joined(const PartMap& geometry, const PartMap& run, const firmware::ToolParameters<float>& tool) {
    JoinedMap result;
    result.map = geometry;
    if (geometry.empty() || run.empty()) {
        return result;
    }
    const PartMap seen = on_path_of(geometry, run);
    const std::vector<Contact> contacts = common_contacts(geometry, seen);
    measure_offset(contacts, result);
    shift_blocks(geometry, contacts, result.map);
    std::vector<Pair> pairs;
    const auto steps = static_cast<std::size_t>(std::ceil(geometry.back().path_mm / step_mm));
    for (std::size_t k = 0; k < steps; ++k) {
        if (const auto pair = pair_at(result.map, seen, step_mm * static_cast<double>(k), tool)) {
            pairs.push_back(*pair);
        }
    }
    measure_hardness(pairs, result);
    for (Pair& pair : pairs) {
        const double off = pair.log_ratio - std::log(result.hardness);
        if (pair.is_cut && std::abs(off) > significance * std::hypot(pair.relative_sd, geometry_relative_sd)) {
            pair.contradiction =
                off > 0.0 ? "the force is higher than by geometry" : "the force is lower than by geometry";
        }
        if (pair.contradiction != nullptr) {
            note({pair.path_mm, pair.path_mm + step_mm, pair.line, pair.contradiction}, result.contradictions);
        }
    }
    std::erase_if(result.contradictions,
                  [](const Contradiction& c) { return c.end_mm - c.begin_mm < shortest_contradiction_mm; });
    for (MapPlace& place : result.map) {
        if (result.compared_mm > 0.0) {
            place.hardness = result.hardness;
            place.hardness_sd = result.hardness_sd;
        }
        const auto next = std::ranges::lower_bound(pairs, place.path_mm, {}, &Pair::path_mm);
        if (next != pairs.end() && next->is_cut && next->path_mm - place.path_mm < step_mm) {
            const double variance = next->relative_sd * next->relative_sd;
            const double of_geometry = geometry_relative_sd * geometry_relative_sd;
            const double weight = of_geometry / (of_geometry + variance);
            for (EngagedArc& arc : place.cut) {
                arc.axial_depth_mm *= std::exp(weight * (next->log_ratio - std::log(result.hardness)));
                place.axial_depth_sd_mm = arc.axial_depth_mm * std::sqrt(weight * variance);
            }
        }
    }
    for (const Contradiction& contradiction : result.contradictions) {
        for (MapPlace& place : result.map) {
            if (place.path_mm >= contradiction.begin_mm && place.path_mm < contradiction.end_mm) {
                place.is_contested = true;
                place.known = Known::nothing;
            }
        }
    }
    return result;
}

}  // namespace millforce::host
