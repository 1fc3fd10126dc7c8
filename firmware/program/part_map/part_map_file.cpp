// SPDX-License-Identifier: Apache-2.0
#include "part_map/part_map_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
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
constexpr double rad_per_deg = std::numbers::pi / 180.0;
constexpr double rad_s_per_rpm = std::numbers::pi / 30.0;

constexpr std::array<std::string_view, 9> column_names{"path_mm",   "block_end_mm", "line",
                                                       "rapid",     "feed_mm_min",  "spindle_rpm",
                                                       "entry_deg", "exit_deg",     "axial_depth_mm"};

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
           a.cut == b.cut;
}

/// As many digits as a map means: 1 µm, 0.001°, 0.001 /min.
double rounded(double value) {
    return std::round(value * 1000.0) / 1000.0;
}

void write_place(CsvWriter& csv, const MapPlace& place) {
    std::array<double, column_names.size()> row{rounded(place.path_mm),
                                                rounded(place.block_end_mm),
                                                static_cast<double>(place.line),
                                                place.rapid ? 1.0 : 0.0,
                                                rounded(place.programmed_feed_mm_s * 60.0),
                                                rounded(place.spindle_speed_rad_s / rad_s_per_rpm),
                                                no_estimate,
                                                no_estimate,
                                                no_estimate};
    if (place.cut.empty()) {
        csv.row(row);
    }
    for (const EngagedArc& arc : place.cut) {
        row[6] = rounded(arc.entry_rad / rad_per_deg);
        row[7] = rounded(arc.exit_rad / rad_per_deg);
        row[8] = rounded(arc.axial_depth_mm);
        csv.row(row);
    }
}

class MapReader {
  public:
    explicit MapReader(const std::filesystem::path& file) : csv_(file) {
        if (csv_.comments().empty() || csv_.comments().front() != format_line) {
            throw InputError(
                fmt::format("{}:1: expected '# {}', a part map of 'millforce preview'", csv_.file_name(), format_line));
        }
        for (std::size_t k = 0; k < column_names.size(); ++k) {
            columns_[k] = csv_.require(column_names[k]);
        }
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
    target.stream() << fmt::format("# {}\n# program {} crc32 {:08x}\n# tool {} crc32 {:08x}\n", format_line,
                                   origin.program, origin.program_crc32, origin.tool, origin.tool_crc32);
    CsvWriter csv(target.stream(), column_names);
    const MapPlace* last = nullptr;
    for (const MapPlace& place : map.map) {
        if (last == nullptr || !is_same(*last, place) || &place == &map.map.back()) {
            write_place(csv, place);
            last = &place;
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
