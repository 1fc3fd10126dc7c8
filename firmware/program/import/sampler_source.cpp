// SPDX-License-Identifier: Apache-2.0
#include "import/sampler_source.hpp"

#include <fmt/format.h>

#include "files/input_error.hpp"
#include "files/printable.hpp"

namespace millforce::host {

SamplerSource::SamplerSource(const std::string& file, const ImportMap& map, const std::vector<SourceName>& sources)
    : SourceReader(sources.size()), lines_(file), pins_(map.names) {
    if (pins_.empty()) {
        throw InputError(
            fmt::format("{}: source.names: missing, expected the names of the sampler's pins in their order",
                        map.file.empty() ? "--map" : map.file));
    }
    for (const SourceName& source : sources) {
        columns_.push_back(place_among(pins_, source, fmt::format("{}: source.names", map.file), "pin"));
    }
}

double SamplerSource::number(std::size_t cell) {
    const CellNumber number = numbers_.read(cells_[cell]);
    if (!number.problem.empty() || numbers_.decimal_mark() == ',') {
        lines_.fail(
            fmt::format("cell {}: '{}', expected a number as halsampler prints it", cell + 1, printable(cells_[cell])));
    }
    return number.value;
}

void SamplerSource::read_sample() {
    if (!split_cells(lines_.text(), any_space, cells_)) {
        lines_.fail("a quote; expected numbers as halsampler prints them");
    }
    const bool is_numbered = cells_.size() == pins_.size() + 1;
    if (!has_samples_) {
        is_numbered_ = is_numbered;
        has_samples_ = true;
    }
    if (cells_.size() != pins_.size() + (is_numbered_ ? 1U : 0U)) {
        lines_.fail(fmt::format("{} cells; expected {}, one for each of source.names{}", cells_.size(), pins_.size(),
                                is_numbered_ ? ", after the sample's number" : ", or the sample's number before them"));
    }
    if (is_numbered_) {
        sample_number_ = number(0);
    }
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        values_[k] = number(columns_[k] + (is_numbered_ ? 1U : 0U));
    }
}

bool SamplerSource::next() {
    bool is_after_loss = false;
    while (lines_.next()) {
        const std::string_view text = without_spaces(lines_.text());
        if (lines_.has_no_end() && !text.empty()) {
            ++cut_off_;  // each line that halsampler prints has its end
            return false;
        }
        if (text == "overrun") {
            is_after_loss = has_samples_;
            overruns_ += has_samples_ ? 1U : 0U;
            continue;
        }
        if (text.empty() || text.starts_with('#')) {
            continue;
        }
        read_sample();
        if (is_after_loss && !is_numbered_) {
            lines_.fail(
                "samples were lost before this line (\"overrun\"), and how many is not known; expected a file of "
                "'halsampler -t'");
        }
        return true;
    }
    return false;
}

std::optional<double> SamplerSource::sample_number() const {
    return is_numbered_ ? std::optional<double>(sample_number_) : std::nullopt;
}

std::string SamplerSource::description() const {
    return fmt::format("halsampler, {} pins, {}", pins_.size(),
                       is_numbered_ ? "samples numbered" : "samples not numbered");
}

std::vector<std::string> SamplerSource::notes() const {
    std::vector<std::string> notes;
    add_note(notes, overruns_, "overrun of the sampler: samples are lost", "overruns of the sampler: samples are lost");
    add_note(notes, cut_off_, "line left out: the last one, which is cut off", "lines left out");
    return notes;
}

}  // namespace millforce::host
