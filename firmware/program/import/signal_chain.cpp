// SPDX-License-Identifier: Apache-2.0
#include "import/signal_chain.hpp"

#include <cmath>
#include <limits>

namespace millforce::host {

namespace {

std::unique_ptr<SampleDerivation> derivation_of(const ColumnMap& column) {
    switch (column.derived_from) {
        case Derivation::none:
            return nullptr;
        case Derivation::position:
            return std::make_unique<PositionSlope>(column.smoothing_s);
        case Derivation::speed:
            return std::make_unique<SpeedIntegral>();
        case Derivation::index:
            return std::make_unique<IndexAngle>(column.threshold);
    }
    return nullptr;
}

double state_of(const ColumnMap& column, double raw) {
    const bool is_set = column.equals ? raw == *column.equals : raw > column.threshold;
    return std::isnan(raw) ? raw : is_set ? 1.0 : 0.0;
}

}  // namespace

SignalChain::SignalChain(const ColumnMap& column)
    : column_(column), unwrap_(column.wrap), derivation_(derivation_of(column)) {}

bool SignalChain::add(double time_s, double raw) {
    if (column_.wrap > 0.0 && !unwrap_.follow(raw)) {
        return false;
    }
    if (column_.column.quantity == Quantity::state) {
        raw = state_of(column_, raw);
    }
    const std::size_t before = out_.size();
    // A pulse is compared with the threshold in its own unit.
    const double factor = column_.derived_from == Derivation::index ? 1.0 : column_.factor;
    if (derivation_) {
        derivation_->add({time_s, factor * raw}, out_);
    } else {
        out_.push_back({time_s, factor * raw});
    }
    finish_samples(before);
    return true;
}

void SignalChain::finish() {
    const std::size_t before = out_.size();
    if (derivation_) {
        derivation_->finish(out_);
    }
    finish_samples(before);
}

void SignalChain::finish_samples(std::size_t from) {
    const double factor = column_.derived_from == Derivation::index ? column_.factor : 1.0;
    for (std::size_t k = from; k < out_.size(); ++k) {
        const double value = factor * out_[k].value + column_.offset;
        out_[k].value = std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
    }
}

Sample SignalChain::take() {
    const Sample sample = out_.front();
    out_.pop_front();
    return sample;
}

double SignalChain::waits_since_s() const {
    return derivation_ ? derivation_->waits_since_s() : std::numeric_limits<double>::infinity();
}

}  // namespace millforce::host
