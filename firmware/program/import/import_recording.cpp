// SPDX-License-Identifier: Apache-2.0
#include "import/import_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "files/atomic_file.hpp"
#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/progress.hpp"
#include "import/sinumerik_source.hpp"
#include "import/source_reader.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

constexpr double longest_time_s = 1e9;
constexpr std::size_t most_unused_names = 100;

/// The time of each record, from 0 on.
class RecordTime {
  public:
    RecordTime(const ImportMap& map, std::size_t value_number)
        : column_(map.time), rate_hz_(map.sample_rate_hz), map_file_(map.file), value_number_(value_number) {
        if (column_) {
            chain_.emplace(*column_);
        }
    }

    /// A format with its own time needs nothing in the map, and the others do.
    void check(const SourceReader& source, const std::string& file) const {
        const bool has_own = !std::isnan(source.time_s());
        if (has_own && (column_ || rate_hz_ > 0.0)) {
            throw InputError(
                fmt::format("{}: time_s: {} has a time of its own, expected no [time_s]", map_file_, file));
        }
        if (!has_own && !column_ && rate_hz_ == 0.0) {
            throw InputError(
                fmt::format("{}: time_s: missing, expected [time_s] with source, or with rate_hz to count "
                            "the samples",
                            map_file_));
        }
    }

    /// Throws where it does not grow; with `may_be_equal`, where it falls.
    double next(const SourceReader& source, bool may_be_equal) {
        const double raw_s = raw_time_s(source);
        if (!(std::abs(raw_s) < 1e18)) {
            throw InputError(fmt::format("{}: time_s: no time in this record, expected a number", source.place()));
        }
        first_s_ = first_s_ ? first_s_ : raw_s;
        const double time_s = std::round((raw_s - *first_s_) * 1e9) / 1e9;
        const bool grows = time_s > last_s_ || (may_be_equal && time_s == last_s_);
        if (!grows && records_ > 0) {
            throw InputError(fmt::format("{}: time_s: {} s after {} s, expected a time that grows", source.place(),
                                         time_s, last_s_));
        }
        if (time_s > longest_time_s) {
            throw InputError(
                fmt::format("{}: time_s: {} s after the first record, expected at most 1e9 s", source.place(), time_s));
        }
        last_s_ = time_s;
        ++records_;
        return time_s;
    }

  private:
    double raw_time_s(const SourceReader& source) {
        if (rate_hz_ > 0.0) {
            return source.sample_number().value_or(static_cast<double>(records_)) / rate_hz_;
        }
        if (!chain_) {
            return source.time_s();
        }
        const double raw = source.value(value_number_);
        if (!chain_->add(0.0, raw)) {
            throw InputError(fmt::format("{}: time_s: {} after {}, expected values that begin again at wrap = {}",
                                         source.place(), raw, chain_->last_raw(), column_->wrap));
        }
        return chain_->take().value;
    }

    std::optional<ColumnMap> column_;
    std::optional<SignalChain> chain_;
    double rate_hz_;
    std::string map_file_;
    std::size_t value_number_;
    std::optional<double> first_s_;
    double last_s_ = 0.0;
    std::uint64_t records_ = 0;
};

/// The output file, and the statistics of what goes into it.
class RecordingRows {
  public:
    RecordingRows(ImportedRecording& recording, const std::string& output) : recording_(recording) {
        recording_.statistics.resize(recording_.columns.size());
        if (output.empty()) {
            return;
        }
        std::vector<std::string_view> names{"time_s"};
        for (const ColumnMap& column : recording_.columns) {
            names.push_back(column.column.name);
        }
        file_.emplace(output);
        writer_.emplace(file_->stream(), names);
    }

    void add(double time_s, std::span<const double> values) {
        recording_.steps.add(time_s);
        for (std::size_t k = 0; k < values.size(); ++k) {
            recording_.statistics[k].add(time_s, values[k]);
        }
        if (writer_) {
            row_.assign(1, time_s);
            row_.insert(row_.end(), values.begin(), values.end());
            writer_->row(row_);
        }
    }

    void finish() {
        recording_.steps.finish();
        if (file_) {
            file_->commit();
        }
    }

  private:
    ImportedRecording& recording_;
    std::optional<AtomicFile> file_;
    std::optional<CsvWriter> writer_;
    std::vector<double> row_;
};

/// One import, from the map to the last row.
class Import {
  public:
    explicit Import(const ImportSettings& settings)
        : settings_(settings), map_(settings.map.empty() ? map_by_names() : read_import_map(settings.map)) {
        for (const ColumnMap& column : map_.columns) {
            sources_.push_back(column.source);
        }
        if (map_.time) {
            sources_.push_back(map_.time->source);
        }
        recording_.resampling = settings.resampling;
    }

    ImportedRecording run() {
        Progress progress("importing");
        RecordTime time(map_, map_.columns.size());
        for (std::size_t k = 0; k < settings_.files.size(); ++k) {
            refuse_to_overwrite(settings_.files[k]);
            const auto source = open(settings_.files[k]);
            if (!rows_) {
                begin_rows(*source, settings_.files[k]);
            }
            bool is_first = true;
            while (source->next()) {
                if (is_first) {
                    time.check(*source, settings_.files[k]);
                    is_first = false;
                }
                builder_->add(time.next(*source, settings_.resampling.rate_hz > 0.0), *source);
                progress.update((static_cast<double>(k) + source->fraction_read()) /
                                static_cast<double>(settings_.files.size()));
            }
            recording_.files.push_back({settings_.files[k], source->description(), source->notes()});
            note_unused_names(source->names());
        }
        builder_->finish();
        if (recording_.steps.rows() == 0) {
            throw InputError(fmt::format("{}: no rows, expected a recording", settings_.files.front()));
        }
        rows_->finish();
        return std::move(recording_);
    }

  private:
    void refuse_to_overwrite(const std::string& file) const {
        std::error_code ignored;
        if (!settings_.output.empty() && std::filesystem::equivalent(file, settings_.output, ignored)) {
            throw InputError(fmt::format("--output: {} is the file to import, expected another one", file));
        }
    }

    [[nodiscard]] std::unique_ptr<SourceReader> open(const std::string& file) {
        SourceFormat format = settings_.format != SourceFormat::detected ? settings_.format : map_.format;
        format = format == SourceFormat::detected ? detected_format(file, map_) : format;
        if (settings_.map.empty() && format != SourceFormat::csv && format != SourceFormat::odrive) {
            throw InputError(
                fmt::format("{}: its signals have names of their own; expected --map{}", file,
                            format == SourceFormat::sinumerik
                                ? fmt::format("; there are {}", name_list(SinumerikSource(file, {}).names()))
                                : ""));
        }
        return open_source(file, format, map_, sources_, context_);
    }

    void begin_rows(const SourceReader& source, const std::string& file) {
        if (!source.has_whole_records() && settings_.resampling.rate_hz == 0.0) {
            throw InputError(
                fmt::format("{}: the signals are in several messages, at different times; expected --rate HZ", file));
        }
        std::vector<std::size_t> value_numbers;
        for (std::size_t k = 0; k < map_.columns.size(); ++k) {
            if (source.has(k)) {
                recording_.columns.push_back(map_.columns[k]);
                value_numbers.push_back(k);
            }
        }
        if (recording_.columns.empty()) {
            throw InputError(fmt::format("{}: no column of a recording but time_s; expected --map", file));
        }
        rows_.emplace(recording_, settings_.output);
        builder_.emplace(recording_.columns, value_numbers, settings_.resampling,
                         [this](double time_s, std::span<const double> values) { rows_->add(time_s, values); });
    }

    void note_unused_names(const std::vector<std::string>& names) {
        for (const std::string& name : names) {
            const bool is_used = std::any_of(sources_.begin(), sources_.end(), [&](const SourceName& source) {
                return !source.name.empty() && (name == source.name || name.ends_with("." + source.name));
            });
            const bool is_new = std::find(recording_.unused_names.begin(), recording_.unused_names.end(), name) ==
                                recording_.unused_names.end();
            if (recording_.unused_names.size() > most_unused_names) {
                return;
            }
            if (!is_used && is_new && !name.empty()) {
                recording_.unused_names.push_back(name);
            }
        }
    }

    const ImportSettings& settings_;
    ImportMap map_;
    std::vector<SourceName> sources_;
    SourceContext context_;
    ImportedRecording recording_;
    std::optional<RecordingRows> rows_;
    std::optional<RowBuilder> builder_;
};

}  // namespace

ImportedRecording import_recording(const ImportSettings& settings) {
    return Import(settings).run();
}

}  // namespace millforce::host
