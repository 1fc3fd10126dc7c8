// SPDX-License-Identifier: Apache-2.0
#include "import/source_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "candump/log_line.hpp"
#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/printable.hpp"
#include "files/text_lines.hpp"
#include "import/candump_source.hpp"
#include "import/sampler_source.hpp"
#include "import/sinumerik_source.hpp"
#include "import/table_source.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

/// The first line that is not empty and no comment is one of candump.
bool begins_with_frame(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const candump::LineKind kind = candump::read_line(line).kind;
        if (kind != candump::LineKind::blank) {
            return kind != candump::LineKind::malformed;
        }
    }
    return false;
}

}  // namespace

SourceFormat detected_format(const std::string& file, const ImportMap& map) {
    constexpr std::streamsize look_bytes = 4096;
    std::ifstream in = open_to_read(file);
    std::string text(look_bytes, '\0');
    in.read(text.data(), look_bytes);
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (text.starts_with("\xEF\xBB\xBF")) {
        text.erase(0, 3);
    }
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && text[first] == '<') {
        return SourceFormat::sinumerik;
    }
    if (begins_with_frame(text)) {
        return SourceFormat::candump;
    }
    return map.names.empty() ? SourceFormat::csv : SourceFormat::halsampler;
}

std::unique_ptr<SourceReader> open_source(const std::string& file, SourceFormat format, const ImportMap& map,
                                          const std::vector<SourceName>& sources, SourceContext& context) {
    switch (format) {
        case SourceFormat::detected:
            return open_source(file, detected_format(file, map), map, sources, context);
        case SourceFormat::csv:
            return std::make_unique<TableSource>(file, sources, TableNames::whole);
        case SourceFormat::odrive:
            return std::make_unique<TableSource>(file, sources, TableNames::end_of_path);
        case SourceFormat::sinumerik:
            return std::make_unique<SinumerikSource>(file, sources);
        case SourceFormat::halsampler:
            return std::make_unique<SamplerSource>(file, map, sources);
        case SourceFormat::candump:
            return std::make_unique<CandumpSource>(file, map, sources, context);
    }
    throw InputError(fmt::format("{}: expected a known format", file));
}

void add_note(std::vector<std::string>& notes, std::uint64_t count, const char* one, const char* several) {
    if (count > 0) {
        notes.push_back(count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, several));
    }
}

std::size_t place_among(const std::vector<std::string>& names, const SourceName& source, const std::string& where,
                        const char* what) {
    if (source.number > 0) {
        if (source.number > names.size()) {
            throw InputError(
                fmt::format("{}: source_number = {}; there are {} {}s", where, source.number, names.size(), what));
        }
        return source.number - 1;
    }
    const auto found = std::find(names.begin(), names.end(), source.name);
    if (found == names.end()) {
        const std::string nearest = nearest_name(source.name, names);
        throw InputError(fmt::format("{}: no {} '{}'; {}", where, what, printable(source.name),
                                     nearest.empty() ? fmt::format("there are {}", name_list(names))
                                                     : fmt::format("the nearest is '{}'", printable(nearest))));
    }
    if (std::find(found + 1, names.end(), source.name) != names.end()) {
        throw InputError(fmt::format("{}: {} '{}' is there twice; expected once, or source_number", where, what,
                                     printable(source.name)));
    }
    return static_cast<std::size_t>(found - names.begin());
}

}  // namespace millforce::host
