// SPDX-License-Identifier: Apache-2.0
#include "import/candump_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

constexpr double no_signal_value = std::numeric_limits<double>::quiet_NaN();

Dbc open_dbc(const ImportMap& map) {
    if (map.dbc.empty()) {
        throw InputError(fmt::format("{}: source.dbc: missing, expected the name of a DBC file to decode a candump log",
                                     map.file.empty() ? "--map" : map.file));
    }
    return Dbc::open(map.dbc);
}

}  // namespace

CandumpSource::CandumpSource(const std::string& file, const ImportMap& map, const std::vector<SourceName>& sources,
                             SourceContext& context)
    : SourceReader(sources.size()),
      lines_(file),
      interface_(map.interface),
      interface_is_given_(!map.interface.empty()),
      dbc_(open_dbc(map)),
      context_(context) {
    for (const SourceName& source : sources) {
        if (source.number > 0) {
            throw InputError(
                fmt::format("{}: source_number = {}: a candump log has no columns, expected source = "
                            "\"MESSAGE.SIGNAL\"",
                            map.file, source.number));
        }
        signals_.push_back(dbc_.find(source.name, map.file));
        by_message_[{signals_.back().id, signals_.back().extended}].push_back(signals_.size() - 1);
    }
}

candump::LogLine CandumpSource::read_line() {
    const candump::LogLine line = candump::read_line(lines_.text());
    if (line.kind == candump::LineKind::malformed && !lines_.has_no_end()) {
        throw InputError(fmt::format("{}:{}: '{}', {}", lines_.place(), line.column, printable(lines_.text()),
                                     candump::expectation(line.error)));
    }
    return line;
}

bool CandumpSource::is_of_interface(std::string_view interface) {
    if (interface_.empty()) {
        interface_ = interface;
    }
    if (interface != interface_ && !interface_is_given_) {
        lines_.fail(fmt::format("frames of {} and {}; expected source.interface in the map", printable(interface_),
                                printable(interface)));
    }
    return interface == interface_;
}

bool CandumpSource::take_frame(const hal::CanFrame& frame) {
    ++frames_;
    const auto asked = by_message_.find({frame.id, frame.extended});
    if (asked == by_message_.end() || frame.remote) {
        return false;
    }
    std::fill(values_.begin(), values_.end(), no_signal_value);
    bool has_value = false;
    for (const std::size_t k : asked->second) {
        values_[k] = signals_[k].decode(frame);
        has_value = has_value || !std::isnan(values_[k]);
    }
    used_frames_ += has_value ? 1U : 0U;
    short_frames_ += has_value ? 0U : 1U;
    return has_value;
}

bool CandumpSource::next() {
    while (lines_.next()) {
        const candump::LogLine line = read_line();
        if (line.kind == candump::LineKind::blank) {
            continue;
        }
        if (line.kind == candump::LineKind::malformed) {
            ++cut_off_;
            continue;
        }
        if (!is_of_interface(line.interface)) {
            continue;
        }
        if (line.kind != candump::LineKind::frame) {
            ++other_frames_;
            continue;
        }
        if (!context_.first_frame_us) {
            context_.first_frame_us = line.time_us;
        }
        if (take_frame(line.frame)) {
            const auto since_first_us = static_cast<std::int64_t>(line.time_us - *context_.first_frame_us);
            time_s_ = static_cast<double>(since_first_us) / 1e6;
            return true;
        }
    }
    return false;
}

std::string CandumpSource::description() const {
    return fmt::format("candump log of {}, {} frames, {} with signals asked for, in {} message{}",
                       printable(interface_), frames_, used_frames_, by_message_.size(),
                       by_message_.size() == 1 ? "" : "s");
}

std::vector<std::string> CandumpSource::names() const {
    std::vector<std::string> names;
    for (const DbcSignal& signal : dbc_.signals()) {
        names.push_back(signal.full_name());
    }
    return names;
}

std::vector<std::string> CandumpSource::notes() const {
    std::vector<std::string> notes;
    add_note(notes, short_frames_, "frame left out, too short for its signals",
             "frames left out, too short for their signals");
    add_note(notes, other_frames_, "frame of CAN FD or of an error left out", "frames of CAN FD or of errors left out");
    add_note(notes, cut_off_, "line left out: the last one, which is cut off", "lines left out");
    return notes;
}

}  // namespace millforce::host
