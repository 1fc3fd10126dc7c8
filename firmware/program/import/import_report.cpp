// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "files/printable.hpp"
#include "import/import_recording.hpp"
#include "import/plausibility.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

std::string figure(double value) {
    return std::isnan(value) ? "–" : fmt::format("{:.5g}", value);
}

std::string unit_text(const ColumnMap& column) {
    if (column.column.quantity == Quantity::state) {
        return column.equals ? fmt::format("1 where it is {:g}", *column.equals)
                             : fmt::format("1 above {:g}", column.threshold);
    }
    std::string text = column.unit;
    switch (column.derived_from) {
        case Derivation::none:
            break;
        case Derivation::position:
            text += fmt::format(", slope over {:g} s", column.smoothing_s);
            break;
        case Derivation::speed:
            text += ", integrated";
            break;
        case Derivation::index:
            text = fmt::format("pulse above {:g}", column.threshold);
            break;
    }
    return text + (column.wrap > 0.0 ? fmt::format(", wraps at {:g}", column.wrap) : "");
}

void write_times(std::string& out, const ImportedRecording& recording) {
    const StepStatistics& steps = recording.steps;
    fmt::format_to(std::back_inserter(out), "{} rows, {:.6g} s", steps.rows(), steps.duration_s());
    if (steps.rows() > 1) {
        fmt::format_to(std::back_inserter(out), ", {:.5g} Hz", steps.rate_hz());
    }
    if (recording.resampling.rate_hz > 0.0) {
        fmt::format_to(std::back_inserter(out), " (resampled, values held for at most {:g} s)",
                       recording.resampling.hold_s);
    } else if (steps.rows() > 2) {
        // Below 0.001 % is rounding.
        const double unevenness_percent = std::round(1e5 * steps.unevenness()) / 1e3;
        fmt::format_to(std::back_inserter(out), "; steps vary by {:.2g} % (rms)", unevenness_percent);
    }
    if (steps.gaps() > 0) {
        fmt::format_to(std::back_inserter(out), "; {} gap{}, the longest {:.4g} s at {:.6g} s", steps.gaps(),
                       steps.gaps() == 1 ? "" : "s", steps.longest_gap_s(), steps.longest_gap_at_s());
    } else {
        out += "; no gaps";
    }
    out += '\n';
}

void write_columns(std::string& out, const ImportedRecording& recording) {
    std::size_t name_width = 17;
    std::size_t source_width = 6;
    std::size_t unit_width = 4;
    for (const ColumnMap& column : recording.columns) {
        name_width = std::max(name_width, column.column.name.size());
        source_width = std::max(source_width, column.source.shown().size());
        unit_width = std::max(unit_width, unit_text(column).size());
    }
    const auto line = [&](std::string_view name, std::string_view source, std::string_view unit, std::string_view low,
                          std::string_view mean, std::string_view high, std::string_view missing) {
        fmt::format_to(std::back_inserter(out), "{:<{}}  {:<{}}  {:<{}}  {:>10}  {:>10}  {:>10}  {:>7}\n", name,
                       name_width, source, source_width, unit, unit_width, low, mean, high, missing);
    };
    line("column", "source", "unit", "minimum", "mean", "maximum", "missing");
    for (std::size_t k = 0; k < recording.columns.size(); ++k) {
        const ColumnStatistics& statistics = recording.statistics[k];
        line(recording.columns[k].column.name, recording.columns[k].source.shown(), unit_text(recording.columns[k]),
             figure(statistics.minimum()), figure(statistics.mean()), figure(statistics.maximum()),
             fmt::format("{}", statistics.missing()));
    }
    for (std::size_t k = 0; k < recording.columns.size(); ++k) {
        fmt::format_to(std::back_inserter(out), "{:<{}}  {}\n", recording.columns[k].column.name, name_width,
                       recording.statistics[k].sparkline());
    }
}

void write_what_is_not_there(std::string& out, const ImportedRecording& recording) {
    std::vector<std::string> missing;
    for (const RecordingColumn& column : recording_columns()) {
        const bool is_wanted = column.quantity == Quantity::angle || column.quantity == Quantity::current ||
                               column.quantity == Quantity::velocity;
        const bool is_there = std::any_of(recording.columns.begin(), recording.columns.end(),
                                          [&](const ColumnMap& one) { return one.column.name == column.name; });
        if (is_wanted && !is_there) {
            missing.emplace_back(column.name);
        }
    }
    if (!missing.empty()) {
        fmt::format_to(std::back_inserter(out), "not there: {}\n", name_list(missing));
    }
    if (!recording.unused_names.empty()) {
        fmt::format_to(std::back_inserter(out), "not used of the source: {}\n", name_list(recording.unused_names));
    }
}

void write_doubts(std::string& out, const ImportedRecording& recording) {
    std::vector<std::string> doubts = doubts_about_times(recording.steps);
    for (std::size_t k = 0; k < recording.columns.size(); ++k) {
        const auto more = doubts_about(recording.columns[k], recording.statistics[k], recording.steps.duration_s());
        doubts.insert(doubts.end(), more.begin(), more.end());
    }
    for (const std::string& doubt : doubts) {
        fmt::format_to(std::back_inserter(out), "implausible: {}\n", doubt);
    }
}

}  // namespace

std::string import_report(const ImportedRecording& recording) {
    std::string out;
    for (const ImportedFile& file : recording.files) {
        fmt::format_to(std::back_inserter(out), "{}: {}\n", file.file, file.description);
        for (const std::string& note : file.notes) {
            fmt::format_to(std::back_inserter(out), "  {}\n", note);
        }
    }
    write_times(out, recording);
    write_columns(out, recording);
    write_what_is_not_there(out, recording);
    write_doubts(out, recording);
    return out;
}

}  // namespace millforce::host
