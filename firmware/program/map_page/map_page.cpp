// SPDX-License-Identifier: Apache-2.0
#include "map_page/map_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "files/number_table.hpp"
#include "map_page/map_page_assets.hpp"
#include "report/json_writer.hpp"
#include "report/page_assets.hpp"
#include "report/page_origin.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"

namespace millforce::host {

namespace {

constexpr std::size_t most_buckets = 800;

/// What the strip at the foot of a chart shows; the digits of `known` in the page's data.
enum class Shown : std::uint8_t { air, cut, at_most, nothing, contested };
constexpr std::array<const char*, 5> shown_names{"air", "cut", "enters or leaves", "not known",
                                                 "geometry and run disagree"};

Shown shown(const MapPlace& place) {
    if (place.is_contested) {
        return Shown::contested;
    }
    if (place.known == Known::nothing) {
        return Shown::nothing;
    }
    if (place.cut.empty()) {
        return Shown::air;
    }
    return place.known == Known::at_most ? Shown::at_most : Shown::cut;
}

/// The largest within a piece of the path.
struct Bucket {
    double immersion = no_estimate;
    double depth_mm = no_estimate;
    double depth_sd_mm = 0.0;
    double immersion_sd = 0.0;
    double tooth_force_N = no_estimate;
    Shown known = Shown::air;

    void include(const MapPlace& place, double force_N) {
        known = std::max(known, shown(place));
        if (place.known == Known::nothing) {
            return;
        }
        const double width = immersion_of(place);
        double deepest_mm = 0.0;
        for (const EngagedArc& arc : place.cut) {
            deepest_mm = std::max(deepest_mm, arc.axial_depth_mm);
        }
        if (!(immersion >= width)) {
            immersion = width;
            immersion_sd = place.arc_sd_rad * std::sqrt(std::max(width * (2.0 - width), 0.0));
        }
        if (!(depth_mm >= deepest_mm)) {
            depth_mm = deepest_mm;
            depth_sd_mm = place.axial_depth_sd_mm;
        }
        tooth_force_N = tooth_force_N >= force_N ? tooth_force_N : force_N;
    }
};

/// Cuts that are alike are worked out once.
class Forces {
  public:
    explicit Forces(const firmware::ToolParameters<float>& tool) : tool_(tool) {}
    double at(const MapPlace& place) {
        if (last_ == nullptr || !is_same_cut(*last_, place)) {
            last_ = &place;
            force_N_ = tooth_force_N(place, tool_);
        }
        return force_N_;
    }

  private:
    const firmware::ToolParameters<float>& tool_;
    const MapPlace* last_ = nullptr;
    double force_N_ = 0.0;
};

std::vector<Bucket> buckets_of(const PartMap& map, const firmware::ToolParameters<float>& tool) {
    const double length_mm = map.back().path_mm;
    std::vector<Bucket> buckets(length_mm > 0.0 ? most_buckets : 0);
    Forces forces(tool);
    for (std::size_t k = 0; k + 1 < map.size(); ++k) {
        const auto bucket_at = [&](double path_mm) {
            return static_cast<std::size_t>(path_mm / length_mm * static_cast<double>(most_buckets));
        };
        const std::size_t end = std::min(bucket_at(map[k + 1].path_mm) + 1, buckets.size());
        for (std::size_t i = bucket_at(map[k].path_mm); i < end; ++i) {
            buckets[i].include(map[k], forces.at(map[k]));
        }
    }
    return buckets;
}

/// Lengths of the path by what is known of it.
std::array<double, shown_names.size()> lengths_of(const PartMap& map) {
    std::array<double, shown_names.size()> lengths{};
    for (std::size_t k = 0; k + 1 < map.size(); ++k) {
        lengths[static_cast<std::size_t>(shown(map[k]))] += map[k + 1].path_mm - map[k].path_mm;
    }
    return lengths;
}

std::string json_of(const PartMap& map, const firmware::ToolParameters<float>& tool) {
    const std::vector<Bucket> buckets = buckets_of(map, tool);
    JsonWriter json;
    const auto column = [&](const char* name, const auto& value, int places) {
        json.key(name).begin_array();
        for (const Bucket& bucket : buckets) {
            json.decimal(value(bucket), places);
        }
        json.end_array();
    };
    constexpr double sds = 1.96;
    json.begin_object();
    json.key("length").number(map.back().path_mm);
    json.key("buckets").unsigned_integer(buckets.size());
    json.key("tooth_force_limit_N").number(static_cast<double>(tool.tooth_force_limit_N));
    column(
        "immersion", [](const Bucket& b) { return b.immersion; }, 3);
    column(
        "immersion_low", [](const Bucket& b) { return std::max(b.immersion - sds * b.immersion_sd, 0.0); }, 3);
    column(
        "immersion_high", [](const Bucket& b) { return std::min(b.immersion + sds * b.immersion_sd, 2.0); }, 3);
    column(
        "depth_mm", [](const Bucket& b) { return b.depth_mm; }, 2);
    column(
        "depth_low_mm", [](const Bucket& b) { return std::max(b.depth_mm - sds * b.depth_sd_mm, 0.0); }, 2);
    column(
        "depth_high_mm", [](const Bucket& b) { return b.depth_mm + sds * b.depth_sd_mm; }, 2);
    column(
        "tooth_force_N", [](const Bucket& b) { return b.tooth_force_N; }, 0);
    std::string known;
    for (const Bucket& bucket : buckets) {
        known += static_cast<char>('0' + static_cast<int>(bucket.known));
    }
    json.key("known").text(known);
    json.key("known_names").begin_array();
    for (const char* name : shown_names) {
        json.text(name);
    }
    json.end_array().end_object();
    return json.str();
}

/// A row for each stretch of which the map says nothing, with its line in the program.
std::string gaps_html(const PartMap& map) {
    std::string rows;
    for (std::size_t k = 0; k + 1 < map.size();) {
        const Shown here = shown(map[k]);
        std::size_t end = k + 1;
        while (end + 1 < map.size() && shown(map[end]) == here && map[end].line == map[k].line) {
            ++end;
        }
        if (here == Shown::nothing || here == Shown::contested) {
            rows +=
                fmt::format("<tr><td>{}</td><td class=\"number\">{:.1f} – {:.1f} mm</td><td>{}</td></tr>\n",
                            map[k].line, map[k].path_mm, map[end].path_mm, shown_names[static_cast<std::size_t>(here)]);
        }
        k = end;
    }
    if (rows.empty()) {
        return "<p>None: the map knows each place of the path.</p>\n";
    }
    return "<div "
           "class=\"table-scroll\"><table><thead><tr><th>Line</th><th>Path</th><th>Why</th></tr></thead><tbody>\n" +
           rows + "</tbody></table></div>\n";
}

std::string stats_html(const PartMap& map, const firmware::ToolParameters<float>& tool) {
    const auto lengths = lengths_of(map);
    const double known_mm = lengths[0] + lengths[1] + lengths[2];
    const double length_mm = std::max(map.back().path_mm, 1e-9);
    double highest_N = 0.0;
    Forces forces(tool);
    for (const MapPlace& place : map) {
        highest_N = std::max(highest_N, forces.at(place));
    }
    return stat_html("hero", fmt::format("{:.0f} %", 100.0 * known_mm / length_mm), "of the path is known") +
           stat_html("", fmt::format("{:.0f} mm", length_mm), "of path") +
           stat_html("", fmt::format("{:.0f} mm", lengths[1] + lengths[2]), "of it in the cut") +
           stat_html(highest_N > static_cast<double>(tool.tooth_force_limit_N) ? "over" : "",
                     fmt::format("{:.0f} N", highest_N), "largest tooth force at the programmed feed");
}

std::string facts_html(const PartMapFile& map, const firmware::ToolParameters<float>& tool) {
    const auto with_crc = [](const std::string& name, std::uint32_t crc32) {
        return fmt::format("{} (CRC-32 {:08x})", name, crc32);
    };
    const MapPlace& first = map.map.front();
    std::string out = fact_html("Part program", with_crc(map.origin.program, map.origin.program_crc32));
    out += fact_html("Tool", with_crc(map.origin.tool, map.origin.tool_crc32));
    out += fact_html("Limit of a tooth", fmt::format("{:.0f} N", tool.tooth_force_limit_N));
    out += fact_html("Hardness", first.hardness_sd > 0.0 ? fmt::format("{:.2f} ± {:.2f} of the tool's file",
                                                                       first.hardness, first.hardness_sd)
                                                         : "");
    for (const auto& [name, value] : facts_of_this_process()) {
        out += fact_html(name, value);
    }
    return out + fact_html("Written", date_and_time());
}

}  // namespace

std::string map_page_html(const PartMapFile& map, const std::string& title,
                          const firmware::ToolParameters<float>& tool) {
    const std::string escaped = html_escaped(title);
    const std::string stats = stats_html(map.map, tool);
    const std::string gaps = gaps_html(map.map);
    const std::string facts = facts_html(map, tool);
    const std::string data = json_of(map.map, tool);
    const std::string head =
        page_head(escaped, {without_source_map(page_assets::dygraphs_style()), page_assets::report_style()});
    return filled(map_page_assets::map_template(),
                  {
                      {"head", head},
                      {"title", escaped},
                      {"stats", stats},
                      {"gaps", gaps},
                      {"facts", facts},
                      {"data", data},
                      {"charts_script", page_assets::charts_script()},
                      {"map_script", map_page_assets::map_script()},
                      {"dygraphs_script", without_source_map(page_assets::dygraphs_script())},
                  });
}

}  // namespace millforce::host
