// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "import/import_map.hpp"

namespace millforce::host {

/// Reads one file, record by record, whatever its format. A record is the row of a table, the line of a sampler or one
/// frame of a bus. The memory does not depend on the length of the file. InputError "FILE:LINE: …".
class SourceReader {
  public:
    virtual ~SourceReader() = default;
    SourceReader(const SourceReader&) = delete;
    SourceReader& operator=(const SourceReader&) = delete;

    /// Advances to the next record; false at the end.
    [[nodiscard]] virtual bool next() = 0;

    /// The k-th value that was asked for; NaN: this record has none.
    [[nodiscard]] double value(std::size_t k) const { return values_[k]; }

    /// The record's time, where the format has one of its own; else NaN.
    [[nodiscard]] virtual double time_s() const { return std::numeric_limits<double>::quiet_NaN(); }

    /// The record's number, where the format has one of its own: it goes on where samples were lost.
    [[nodiscard]] virtual std::optional<double> sample_number() const { return {}; }

    /// False where a record holds some of the values only: they come at different times.
    [[nodiscard]] virtual bool has_whole_records() const { return true; }

    /// "FILE:LINE" of the record.
    [[nodiscard]] virtual std::string place() const = 0;
    [[nodiscard]] virtual double fraction_read() const = 0;

    /// What the file was taken for, e.g. "CSV, separated by ';', decimal comma".
    [[nodiscard]] virtual std::string description() const = 0;
    /// What was left out on the way: comment lines, a line that is cut off. Complete after the last record.
    [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
    /// All names that the file has. Complete after the last record.
    [[nodiscard]] virtual std::vector<std::string> names() const = 0;
    /// False for a column that may be missing, and is.
    [[nodiscard]] virtual bool has(std::size_t /*k*/) const { return true; }

  protected:
    explicit SourceReader(std::size_t count) : values_(count, std::numeric_limits<double>::quiet_NaN()) {}
    std::vector<double> values_;
};

/// What readers of several files share.
struct SourceContext {
    std::optional<std::uint64_t> first_frame_us{};  ///< time zero of the logs
};

/// The format of a file, by its first characters.
[[nodiscard]] SourceFormat detected_format(const std::string& file, const ImportMap& map);

/// Opens a file. `sources`: what is asked for, in the order of value().
[[nodiscard]] std::unique_ptr<SourceReader> open_source(const std::string& file, SourceFormat format,
                                                        const ImportMap& map, const std::vector<SourceName>& sources,
                                                        SourceContext& context);

/// "3 comment lines left out"; nothing added where the count is 0.
void add_note(std::vector<std::string>& notes, std::uint64_t count, const char* one, const char* several);

/// The place of `source` among the names, or InputError with the nearest name. `where`: file, or file and line.
[[nodiscard]] std::size_t place_among(const std::vector<std::string>& names, const SourceName& source,
                                      const std::string& where, const char* what);

}  // namespace millforce::host
