// SPDX-License-Identifier: Apache-2.0
#include "report/decimation.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::sim {

namespace {

/// The extremes of the finite values of a bucket; nullptr if there is none.
struct Extremes {
    const TracePoint* lowest = nullptr;
    const TracePoint* highest = nullptr;
    double low = host::no_estimate;
    double high = host::no_estimate;
};

Extremes extremes(std::span<const TracePoint> points, const TraceValue& value) {
    Extremes found;
    for (const TracePoint& point : points) {
        const double current = value(point);
        if (!std::isfinite(current)) {
            continue;
        }
        if (found.lowest == nullptr || current < found.low) {
            found.lowest = &point;
            found.low = current;
        }
        if (found.highest == nullptr || current > found.high) {
            found.highest = &point;
            found.high = current;
        }
    }
    return found;
}

}  // namespace

std::size_t BucketAxis::bucket(double position) const {
    if (!(position > 0.0) || !(length > 0.0)) {
        return 0;
    }
    const double last = static_cast<double>(bucket_count - 1);
    return static_cast<std::size_t>(std::min(last, position / length * static_cast<double>(bucket_count)));
}

BucketedRun::BucketedRun(const BucketAxis& axis, std::span<const TracePoint> trace,
                         const std::function<double(const TracePoint&)>& position)
    : trace_(trace), first_(axis.bucket_count + 1, trace.size()) {
    std::size_t next_bucket = 0;
    for (std::size_t sample = 0; sample < trace.size(); ++sample) {
        for (const std::size_t bucket = axis.bucket(position(trace[sample])); next_bucket <= bucket; ++next_bucket) {
            first_[next_bucket] = sample;
        }
    }
}

std::span<const TracePoint> BucketedRun::points(std::size_t k) const {
    const std::size_t own_count = first_[k + 1] - first_[k];
    return first_[k] < trace_.size() ? trace_.subspan(first_[k], std::max<std::size_t>(own_count, 1))
                                     : std::span<const TracePoint>{};
}

std::vector<double> min_max_decimated(const BucketedRun& run, const TraceValue& value) {
    std::vector<double> kept;
    kept.reserve(2 * run.bucket_count());
    for (std::size_t k = 0; k < run.bucket_count(); ++k) {
        const Extremes found = extremes(run.points(k), value);
        const bool rising = found.lowest <= found.highest;
        kept.push_back(rising ? found.low : found.high);
        kept.push_back(rising ? found.high : found.low);
    }
    return kept;
}

std::vector<double> bucket_minima(const BucketedRun& run, const TraceValue& value) {
    std::vector<double> kept;
    for (std::size_t k = 0; k < run.bucket_count(); ++k) {
        kept.push_back(extremes(run.points(k), value).low);
    }
    return kept;
}

std::vector<double> bucket_maxima(const BucketedRun& run, const TraceValue& value) {
    std::vector<double> kept;
    for (std::size_t k = 0; k < run.bucket_count(); ++k) {
        kept.push_back(extremes(run.points(k), value).high);
    }
    return kept;
}

}  // namespace millforce::sim
