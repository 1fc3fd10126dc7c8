// SPDX-License-Identifier: Apache-2.0
#include "replay/estimate_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iostream>

namespace millforce::host {

namespace {

firmware::ToolParameters<float> shown_tool(const ToolSet& tools) {
    return tools.source() == nullptr ? tools.parameters().tool : firmware::ToolParameters<float>();
}

WideBandCells wide_band_cells(const ToolSet& tools, WideBandSource source) {
    return source == WideBandSource::none
               ? WideBandCells(false, {})
               : WideBandCells(tools.source() == nullptr && source == WideBandSource::force_sensor, shown_tool(tools));
}

}  // namespace

RowTimes::RowTimes(double interval_s) : interval_us_(std::llround(interval_s * 1e6)) {}

bool RowTimes::is_due(double time_s) {
    const std::int64_t time_us = std::llround(time_s * 1e6);
    first_us_ = samples_ == 0 ? time_us : first_us_;
    last_us_ = time_us;
    ++samples_;
    const bool due = rows_ == 0 || time_us >= next_us_;
    if (due) {
        next_us_ = time_us + interval_us_;
        ++rows_;
    }
    return due;
}

std::string RowTimes::left_out() const {
    const bool is_slow = samples_ > 1 && 2.0 * static_cast<double>(last_us_ - first_us_) >
                                             static_cast<double>(samples_ - 1) * static_cast<double>(interval_us_);
    return is_slow && rows_ < samples_
               ? fmt::format(
                     "{} of {} samples come less than the interval of {} s after a row and have none; "
                     "--interval 0 gives a row for each",
                     samples_ - rows_, samples_, static_cast<double>(interval_us_) / 1e6)
               : std::string();
}

EstimateTable::EstimateTable(const Settings& settings, const ToolSet& tools, WideBandSource wide_band)
    : settings_(settings),
      forces_(tools),
      numbers_(forces_.has_numbers()),
      roughness_(shown_tool(tools).roughness),
      wide_band_(wide_band_cells(tools, wide_band)),
      times_(settings.interval_s),
      progress_("replaying") {
    if (!settings_.output.empty()) {
        file_.emplace(settings_.output);
    }
    out() << estimate_header;
    numbers_.write_header(out());
    roughness_.write_header(out());
    wide_band_.write_header(out());
    ReasonCells::write_header(out());
    out() << '\n';
}

void EstimateTable::write(const Row& row) {
    write_estimate_row(out(), row.time_s, row.record, forces_.of(row.record, row.tool));
    numbers_.write(out(), row.tool);
    roughness_.write(out(), row.roughness);
    wide_band_.write(out(), row.wide_band);
    ReasonCells::write(out(), row.record);
    out() << '\n';
}

void EstimateTable::show_notes() const {
    wide_band_.show_what_is_missing();
    for (const std::string& note : {times_.left_out(), numbers_.note()}) {
        if (!note.empty()) {
            fmt::print(stderr, "millforce: note: {}: {}\n", settings_.log, note);
        }
    }
}

void EstimateTable::commit(std::string_view about_the_log, const WideBandCells::Estimates& made) {
    if (!file_) {
        std::cout << (settings_.may_print ? held_back_.str() : std::string());
        return;
    }
    file_->commit();
    fmt::print("{}: {} rows{}\n{}{}", settings_.output, times_.rows(), about_the_log, roughness_.summary(),
               wide_band_.summary(made));
}

}  // namespace millforce::host
