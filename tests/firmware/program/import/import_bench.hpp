// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/input_error.hpp"
#include "import/import_recording.hpp"
#include "program/csv_rows.hpp"
#include "temporary_folder.hpp"

namespace millforce::test {

inline const std::string example_folder = MILLFORCE_SOURCE_DIR "/firmware/program/import/examples/";

/// A folder in which texts are imported.
class ImportBench : public TemporaryFolder {
  public:
    /// Imports the text with the map.
    host::ImportedRecording import(std::string_view text, std::string_view map, host::Resampling resampling = {}) {
        return import_parts({text}, map, resampling);
    }
    host::ImportedRecording import_parts(const std::vector<std::string_view>& texts, std::string_view map,
                                         host::Resampling resampling = {}) {
        host::ImportSettings settings;
        for (std::size_t k = 0; k < texts.size(); ++k) {
            settings.files.push_back(write("source" + std::to_string(k), texts[k]).string());
        }
        settings.map = map.empty() ? "" : write("map.toml", map).string();
        settings.output = path("out.csv").string();
        settings.resampling = resampling;
        return host::import_recording(settings);
    }
    /// The message where it is refused, without the folder; else empty.
    std::string error(std::string_view text, std::string_view map, host::Resampling resampling = {}) {
        std::string message = message_of<host::InputError>([&] { import(text, map, resampling); });
        const std::string folder = path("").string();
        for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
            message.erase(at, folder.size());
        }
        return message;
    }
    std::vector<CsvRow> rows() const { return csv_rows(read("out.csv")); }
    /// One column of the recording, as text; "" is an empty cell.
    std::vector<std::string> column(const std::string& name) const {
        std::vector<std::string> cells;
        for (const CsvRow& row : rows()) {
            cells.push_back(row.at(name));
        }
        return cells;
    }
};

/// `text` with its first `from` replaced by `to`.
inline std::string with_text(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

/// Cells as one text: "1 2  4".
inline std::string joined(const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        text += (k > 0 ? " " : "") + (cells[k].empty() ? "-" : cells[k]);
    }
    return text;
}

}  // namespace millforce::test
