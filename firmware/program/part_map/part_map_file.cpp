// SPDX-License-Identifier: Apache-2.0
#include "part_map/part_map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/text_lines.hpp"
#include "firmware/crc32.hpp"

namespace millforce::host {

namespace {

constexpr std::string_view format_line = "millforce part map 1";
constexpr std::string_view format_line_of_runs = "millforce part map 2";
constexpr double rad_per_deg = std::numbers::pi / 180.0;
constexpr double rad_s_per_rpm = std::numbers::pi / 30.0;

constexpr std::size_t columns_of_geometry = 9;
constexpr std::size_t columns_of_runs = 16;  // and least_share, which older maps do not have
constexpr std::array<std::string_view, 17> column_names{
    "path_mm",   "block_end_mm", "line",           "rapid",     "feed_mm_min", "spindle_rpm",
    "entry_deg", "exit_deg",     "axial_depth_mm", "known",     "arc_sd_deg",  "axial_depth_sd_mm",
    "hardness",  "hardness_sd",  "position_sd_mm", "contested", "least_share"};

std::uint32_t checksum(std::string_view text) {
    return firmware::crc32(0, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::string text_of(const std::filesystem::path& program_file) {
    std::ifstream in = open_to_read(program_file.string());
    std::ostringstream bytes;
    bytes << in.rdbuf();
    std::string text = bytes.str();
    std::erase(text, '\r');
    return text;
}

/// "KIND NAME crc32 HEX"; the name may hold spaces.
struct OriginLine {
    std::string name;
    std::uint32_t crc32 = 0;
};

OriginLine origin_line(const CsvReader& csv, std::string_view kind) {
    for (const std::string& comment : csv.comments()) {
        const std::size_t mark = comment.rfind(" crc32 ");
        if (!comment.starts_with(std::string(kind) + ' ') || mark == std::string::npos) {
            continue;
        }
        OriginLine line;
        if (mark > kind.size()) {
            line.name = comment.substr(kind.size() + 1, mark - kind.size() - 1);
        }
        const char* const begin = comment.data() + mark + std::string_view(" crc32 ").size();
        const char* const end = comment.data() + comment.size();
        const auto read = std::from_chars(begin, end, line.crc32, 16);
        if (read.ec == std::errc{} && read.ptr == end) {
            return line;
        }
    }
    throw InputError(fmt::format("{}: no line '# {} NAME crc32 HEX'; expected a part map of 'millforce preview'",
                                 csv.file_name(), kind));
}

bool is_same(const MapPlace& a, const MapPlace& b) {
    return a.block_end_mm == b.block_end_mm && a.line == b.line && a.rapid == b.rapid &&
           a.programmed_feed_mm_s == b.programmed_feed_mm_s && a.spindle_speed_rad_s == b.spindle_speed_rad_s &&
           a.cut == b.cut && a.known == b.known && a.arc_sd_rad == b.arc_sd_rad &&
           a.axial_depth_sd_mm == b.axial_depth_sd_mm && a.hardness == b.hardness && a.hardness_sd == b.hardness_sd &&
           a.position_sd_mm == b.position_sd_mm && a.is_contested == b.is_contested && a.least_share == b.least_share;
}

/// Nothing in it comes from a run.
bool is_of_geometry(const MapPlace& place) {
    return place.known == Known::cut && place.arc_sd_rad == 0.0 && place.axial_depth_sd_mm == 0.0 &&
           place.hardness == 1.0 && place.hardness_sd == 0.0 && place.position_sd_mm == 0.0 && !place.is_contested;
}

/// As many digits as a map means: 1 µm, 0.001°, 0.001 /min.
double rounded(double value) {
    return std::round(value * 1000.0) / 1000.0;
}

/// In the digits of the file.
struct ArcCells {
    double entry_deg;
    double exit_deg;
    double axial_depth_mm;
};

/// Without those that are nothing in these digits: no reader takes them.
std::vector<ArcCells> cells_of(const std::vector<EngagedArc>& cut) {
    std::vector<ArcCells> cells;
    for (const EngagedArc& arc : cut) {
        const ArcCells next{rounded(arc.entry_rad / rad_per_deg), rounded(arc.exit_rad / rad_per_deg),
                            rounded(arc.axial_depth_mm)};
        if (next.exit_deg > next.entry_deg && next.axial_depth_mm > 0.0) {
            cells.push_back(next);
        }
    }
    return cells;
}

void write_place(CsvWriter& csv, const MapPlace& place, std::size_t columns) {
    std::array<double, column_names.size()> row{rounded(place.path_mm),
                                                rounded(place.block_end_mm),
                                                static_cast<double>(place.line),
                                                place.rapid ? 1.0 : 0.0,
                                                rounded(place.programmed_feed_mm_s * 60.0),
                                                rounded(place.spindle_speed_rad_s / rad_s_per_rpm),
                                                no_estimate,
                                                no_estimate,
                                                no_estimate,
                                                static_cast<double>(place.known),
                                                rounded(place.arc_sd_rad / rad_per_deg),
                                                rounded(place.axial_depth_sd_mm),
                                                rounded(place.hardness),
                                                rounded(place.hardness_sd),
                                                rounded(place.position_sd_mm),
                                                place.is_contested ? 1.0 : 0.0,
                                                place.known == Known::at_most ? rounded(place.least_share) : 1.0};
    const std::span<const double> written = std::span<const double>(row).first(columns);
    const std::vector<ArcCells> arcs = cells_of(place.cut);
    if (arcs.empty()) {
        csv.row(written);
    }
    for (const ArcCells& arc : arcs) {
        row[6] = arc.entry_deg;
        row[7] = arc.exit_deg;
        row[8] = arc.axial_depth_mm;
        csv.row(written);
    }
}

class MapReader {
  public:
    explicit MapReader(const std::filesystem::path& file) : csv_(file) {
        const std::string format = csv_.comments().empty() ? "" : csv_.comments().front();
        has_doubt_ = format == format_line_of_runs;
        if (!has_doubt_ && format != format_line) {
            throw InputError(
                fmt::format("{}:1: expected '# {}' or '# {}', a part map of 'millforce preview' or --learn",
                            csv_.file_name(), format_line, format_line_of_runs));
        }
        for (std::size_t k = 0; k < (has_doubt_ ? columns_of_runs : columns_of_geometry); ++k) {
            columns_[k] = csv_.require(column_names[k]);
        }
        least_share_ = csv_.find(column_names[columns_of_runs]);
    }

    PartMapFile read() {
        PartMapFile result;
        const OriginLine program = origin_line(csv_, "program");
        const OriginLine tool = origin_line(csv_, "tool");
        result.origin = {program.name, program.crc32, tool.name, tool.crc32};
        while (csv_.next_row()) {
            add_row(result.map);
        }
        if (result.map.empty() || !result.map.back().cut.empty()) {
            throw InputError(csv_.file_name() + ": the last row is not the program's end, in air; is the file whole?");
        }
        return result;
    }

  private:
    /// As exact as a map is: what is read can be written and read again.
    [[nodiscard]] double number(std::size_t column, double low, double high) const {
        return rounded(csv_.required_number(columns_[column], low, high));
    }

    void add_row(PartMap& map) {
        constexpr double longest_mm = 1e6;
        MapPlace place;
        place.path_mm = number(0, 0.0, longest_mm);
        place.block_end_mm = number(1, place.path_mm, longest_mm);
        place.line = static_cast<std::size_t>(csv_.required_number(columns_[2], 0.0, 1e9));
        place.rapid = csv_.required_number(columns_[3], 0.0, 1.0) != 0.0;
        place.programmed_feed_mm_s = number(4, 0.0, 1e6) / 60.0;
        place.spindle_speed_rad_s = number(5, 0.0, 1e6) * rad_s_per_rpm;
        if (has_doubt_) {
            read_doubt(place);
        }
        const std::optional<EngagedArc> arc = arc_of_row();
        if (arc && !(place.programmed_feed_mm_s > 0.0)) {
            csv_.fail(columns_[4], "no feed in a cut; expected the programmed one");
        }
        if (!map.empty() && place.path_mm == map.back().path_mm) {
            add_further_arc(map.back(), arc);
            return;
        }
        if (!map.empty() && place.path_mm < map.back().path_mm) {
            csv_.fail(columns_[0], "the path goes back; expected rows in the order of the path");
        }
        if (arc) {
            place.cut.push_back(*arc);
        }
        map.push_back(std::move(place));
    }

    void read_doubt(MapPlace& place) const {
        const auto known = static_cast<int>(csv_.required_number(columns_[9], 0.0, 2.0));
        place.known = static_cast<Known>(known);
        place.arc_sd_rad = number(10, 0.0, 180.0) * rad_per_deg;
        place.axial_depth_sd_mm = number(11, 0.0, 500.0);
        place.hardness = number(12, least_hardness, largest_hardness);
        place.hardness_sd = number(13, 0.0, 10.0);
        place.position_sd_mm = number(14, 0.0, 1000.0);
        place.is_contested = csv_.required_number(columns_[15], 0.0, 1.0) != 0.0;
        if (least_share_ && place.known == Known::at_most) {
            place.least_share = rounded(csv_.required_number(*least_share_, 0.0, 1.0));
        }
    }

    std::optional<EngagedArc> arc_of_row() {
        if (std::isnan(csv_.number(columns_[6]))) {
            return std::nullopt;
        }
        EngagedArc arc;
        const double entry_deg = number(6, 0.0, 180.0);
        const double exit_deg = number(7, 0.0, 180.0);
        if (!(exit_deg > entry_deg)) {
            csv_.fail(columns_[7], "expected an arc that ends behind its entry");
        }
        arc.entry_rad = entry_deg * rad_per_deg;
        arc.exit_rad = exit_deg * rad_per_deg;
        arc.axial_depth_mm = number(8, 0.001, 500.0);
        return arc;
    }

    void add_further_arc(MapPlace& place, const std::optional<EngagedArc>& arc) {
        if (!arc || place.cut.empty() || arc->entry_rad < place.cut.back().exit_rad) {
            csv_.fail(columns_[6], "a second row for this place; expected a further arc, behind the last one's exit");
        }
        place.cut.push_back(*arc);
    }

    CsvReader csv_;
    bool has_doubt_ = false;
    std::optional<CsvColumn> least_share_;
    std::array<CsvColumn, column_names.size()> columns_{};
};

}  // namespace

MapOrigin origin_of(const std::filesystem::path& program_file, const std::string& tool_name,
                    const firmware::ToolParameters<float>& tool) {
    MapOrigin origin;
    if (!program_file.empty()) {
        origin.program = program_file.filename().string();
        origin.program_crc32 = checksum(text_of(program_file));
    }
    origin.tool = tool_name;
    origin.tool_crc32 = checksum(
        fmt::format("{} {:.6g} {:.6g} {:.6g}", tool.teeth, tool.diameter_mm, tool.helix_deg, tool.flute_length_mm));
    return origin;
}

void write_part_map(const std::filesystem::path& file, const PartMapFile& map) {
    AtomicFile target(file);
    const MapOrigin& origin = map.origin;
    const bool has_doubt = !std::ranges::all_of(map.map, is_of_geometry);
    const std::size_t columns = has_doubt ? column_names.size() : columns_of_geometry;
    target.stream() << fmt::format("# {}\n# program {} crc32 {:08x}\n# tool {} crc32 {:08x}\n",
                                   has_doubt ? format_line_of_runs : format_line, origin.program, origin.program_crc32,
                                   origin.tool, origin.tool_crc32);
    CsvWriter csv(target.stream(), std::span(column_names).first(columns));
    const MapPlace* last = nullptr;
    for (auto place = map.map.begin(); place != map.map.end(); ++place) {
        const auto next = std::next(place);
        const bool is_end = next == map.map.end();
        const bool has_length = is_end || rounded(next->path_mm) > rounded(place->path_mm);
        if (is_end || (has_length && (last == nullptr || !is_same(*last, *place)))) {
            write_place(csv, *place, columns);
            last = &*place;
        }
    }
    target.commit();
}

PartMapFile read_part_map(const std::filesystem::path& file) {
    return MapReader(file).read();
}

void require_same_origin(const std::filesystem::path& file, const MapOrigin& of_map, const MapOrigin& of_part) {
    const auto refuse = [&](std::string_view kind, const std::string& was, const std::string& is) {
        throw InputError(
            fmt::format("{}: made for another {} ('{}'; this is '{}'); make it again with "
                        "'millforce preview'",
                        file.string(), kind, was, is));
    };
    if (of_map.program_crc32 != of_part.program_crc32) {
        refuse("program", of_map.program, of_part.program);
    }
    if (of_map.tool_crc32 != of_part.tool_crc32) {
        refuse("tool", of_map.tool, of_part.tool);
    }
}

}  // namespace millforce::host
