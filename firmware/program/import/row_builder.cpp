// SPDX-License-Identifier: Apache-2.0
#include "import/row_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/csv.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

constexpr double time_tolerance_s = 1e-9;  // times are multiples of it

}  // namespace

RowBuilder::RowBuilder(const std::vector<ColumnMap>& columns, std::vector<std::size_t> value_numbers,
                       Resampling resampling, Sink sink)
    : value_numbers_(std::move(value_numbers)),
      resampling_(resampling),
      sink_(std::move(sink)),
      values_(columns.size()),
      held_(columns.size()) {
    for (const ColumnMap& column : columns) {
        chains_.emplace_back(column);
    }
}

void RowBuilder::add(double time_s, const SourceReader& source) {
    const bool is_resampled = resampling_.rate_hz > 0.0;
    if (is_resampled) {
        give_rows_before(time_s);
    }
    for (std::size_t k = 0; k < chains_.size(); ++k) {
        const double raw = source.value(value_numbers_[k]);
        if (is_resampled && std::isnan(raw)) {
            continue;
        }
        const ColumnMap& column = chains_[k].column();
        if (std::abs(raw * column.factor) > largest_number) {
            throw InputError(fmt::format("{}: {}: {} is beyond anything measured; expected at most {:g}",
                                         source.place(), column.column.name, raw, largest_number));
        }
        const double last_raw = chains_[k].last_raw();
        if (!chains_[k].add(time_s, raw)) {
            throw InputError(fmt::format("{}: {}: {} after {}, expected values that begin again at wrap = {}",
                                         source.place(), column.column.name, raw, last_raw, column.wrap));
        }
    }
    last_time_s_ = time_s;
    if (!is_resampled) {
        give_rows();
    }
}

void RowBuilder::finish() {
    for (SignalChain& chain : chains_) {
        chain.finish();
    }
    if (resampling_.rate_hz > 0.0) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        give_rows_before(std::nextafter(last_time_s_ + 2.0 * time_tolerance_s, infinity));
    } else {
        give_rows();
    }
}

/// Each record gave one sample to each column: a row is complete where all have come out.
void RowBuilder::give_rows() {
    const auto has_sample = [](const SignalChain& chain) { return chain.has_sample(); };
    while (std::all_of(chains_.begin(), chains_.end(), has_sample)) {
        const double time_s = chains_.front().front().time_s;
        for (std::size_t k = 0; k < chains_.size(); ++k) {
            values_[k] = chains_[k].take().value;
        }
        sink_(time_s, values_);
    }
}

bool RowBuilder::hold_values(double time_s) {
    bool has_value = false;
    for (std::size_t k = 0; k < chains_.size(); ++k) {
        while (chains_[k].has_sample() && chains_[k].front().time_s <= time_s + time_tolerance_s) {
            const Sample sample = chains_[k].take();
            held_[k] = std::isnan(sample.value) ? held_[k] : sample;
        }
        const bool is_fresh = time_s - held_[k].time_s <= resampling_.hold_s + time_tolerance_s;
        values_[k] = is_fresh ? held_[k].value : std::numeric_limits<double>::quiet_NaN();
        has_value = has_value || !std::isnan(values_[k]);
    }
    return has_value;
}

double RowBuilder::next_sample_s(double limit_s) const {
    double next_s = limit_s;
    for (const SignalChain& chain : chains_) {
        next_s = chain.has_sample() ? std::min(next_s, chain.front().time_s) : next_s;
    }
    return next_s;
}

void RowBuilder::give_rows_before(double limit_s) {
    for (const SignalChain& chain : chains_) {
        limit_s = std::min(limit_s, chain.waits_since_s());
    }
    const auto time_of = [&](std::uint64_t row) { return static_cast<double>(row) / resampling_.rate_hz; };
    while (time_of(next_row_) + time_tolerance_s < limit_s) {
        const double time_s = time_of(next_row_);
        ++next_row_;
        if (hold_values(time_s)) {
            sink_(time_s, values_);
            continue;
        }
        // Nothing until the next sample, however far away it is.
        const double next_s = next_sample_s(limit_s) - time_tolerance_s;
        next_row_ = std::max(next_row_, static_cast<std::uint64_t>(std::ceil(next_s * resampling_.rate_hz)));
    }
}

}  // namespace millforce::host
