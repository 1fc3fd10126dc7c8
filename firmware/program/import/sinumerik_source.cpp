// SPDX-License-Identifier: Apache-2.0
#include "import/sinumerik_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/input_error.hpp"
#include "files/printable.hpp"

namespace millforce::host {

namespace {

constexpr std::size_t most_signals = 1000;
constexpr double longest_left_out_s = 1.0;
constexpr double first_value_of_nan_bits = 9.2e18;

std::string text_of(const std::string* attribute) {
    return attribute != nullptr ? std::string(without_spaces(*attribute)) : std::string();
}

}  // namespace

SinumerikSource::SinumerikSource(const std::string& file, const std::vector<SourceName>& sources)
    : SourceReader(sources.size()), tags_(file) {
    read_signals();
    find_sources(sources);
}

double SinumerikSource::attribute_number(const std::string& name, bool is_required) {
    const std::string* text = tags_.attribute(name);
    if (text == nullptr && !is_required) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const CellNumber number = numbers_.read(text != nullptr ? *text : std::string());
    const bool is_fine =
        number.problem.empty() && numbers_.decimal_mark() != ',' && (!is_required || std::isfinite(number.value));
    if (!is_fine) {
        tags_.fail(fmt::format("{} = '{}' in the tag <{}>, expected a number", name, printable(text_of(text)),
                               printable(tags_.name())));
    }
    return number.value;
}

void SinumerikSource::take_signal() {
    if (signals_.size() == most_signals) {
        tags_.fail("more than 1000 signals; expected a trace of SINUMERIK Operate");
    }
    signals_.push_back(
        {text_of(tags_.attribute("id")), text_of(tags_.attribute("name")), text_of(tags_.attribute("description"))});
    if (signals_.back().id.empty()) {
        tags_.fail("a <dataSignal> without id");
    }
    const double interval_s = attribute_number("interval", false);
    if (interval_s > 0.0) {
        interval_s_ = interval_s_ > 0.0 ? std::min(interval_s_, interval_s) : interval_s;
    }
}

/// Up to the first record, whose tag is then the current one.
void SinumerikSource::read_signals() {
    bool is_in_frame = false;
    while (tags_.next()) {
        if (tags_.name() == "dataFrame") {
            is_in_frame = true;
        } else if (is_in_frame && tags_.name() == "dataSignal") {
            take_signal();
        } else if (is_in_frame && tags_.name() == "rec") {
            has_record_ = true;
            record_s_ = attribute_number("time", true);
            return;
        }
    }
    tags_.fail(fmt::format("no {}; expected a trace that SINUMERIK Operate has saved",
                           is_in_frame ? "<rec> in the <dataFrame>" : "<dataFrame>"));
}

void SinumerikSource::find_sources(const std::vector<SourceName>& sources) {
    for (const SourceName& source : sources) {
        std::vector<std::string> same_description;
        std::string id;
        for (const Signal& signal : signals_) {
            id = source.number == 0 && (signal.name == source.name || signal.id == source.name) ? signal.id : id;
            if (signal.description == source.name) {
                same_description.push_back(signal.id);
            }
        }
        if (id.empty() && source.number == 0 && same_description.size() == 1) {
            id = same_description.front();
        }
        ids_.push_back(!id.empty() ? id : signals_[place_among(names(), source, tags_.place(), "signal")].id);
    }
}

void SinumerikSource::plan_left_out_records(double record_s) {
    const double steps = interval_s_ > 0.0 ? (record_s - time_s_) / interval_s_ : 0.0;
    const double whole = std::round(steps);
    const bool fits = whole >= 2.0 && std::abs(steps - whole) < 0.1 && whole * interval_s_ <= longest_left_out_s;
    left_out_ = fits ? static_cast<std::uint64_t>(whole) - 1 : 0;
}

bool SinumerikSource::read_record() {
    while (tags_.next()) {
        if (tags_.name() == "dataFrame" || tags_.name() == "dataSignal") {
            tags_.fail("a second <dataFrame>; expected a file with one recording");
        }
        if (tags_.name() == "rec") {
            record_s_ = attribute_number("time", true);
            plan_left_out_records(record_s_);
            return true;
        }
    }
    return false;
}

void SinumerikSource::take_record() {
    time_s_ = record_s_;
    has_record_ = false;
    for (std::size_t k = 0; k < ids_.size(); ++k) {
        if (tags_.attribute(ids_[k]) == nullptr) {
            continue;
        }
        const double value = attribute_number(ids_[k], false);
        values_[k] = std::abs(value) < first_value_of_nan_bits ? value : std::numeric_limits<double>::quiet_NaN();
    }
}

bool SinumerikSource::next() {
    if (!has_record_) {
        has_record_ = read_record();
    }
    if (!has_record_) {
        return false;
    }
    if (left_out_ > 0) {
        --left_out_;
        ++put_in_;
        time_s_ += interval_s_;
        return true;
    }
    take_record();
    return true;
}

std::string SinumerikSource::description() const {
    return fmt::format("SINUMERIK trace, {} signals", signals_.size());
}

std::vector<std::string> SinumerikSource::names() const {
    std::vector<std::string> names;
    for (const Signal& signal : signals_) {
        names.push_back(signal.name);
    }
    return names;
}

std::vector<std::string> SinumerikSource::notes() const {
    std::vector<std::string> notes;
    add_note(notes, put_in_, "record put in, where no signal had changed",
             "records put in, where no signal had changed");
    add_note(notes, tags_.is_cut_off() ? 1 : 0, "record left out: the last one, which is cut off", "");
    return notes;
}

}  // namespace millforce::host
