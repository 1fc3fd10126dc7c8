// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "report/run_result.hpp"

/// Fewer points for a chart without losing a peak. The axis (time or path) is cut into equal buckets, the same for all
/// runs, and of each bucket the smallest and the largest value are kept, in the order in which they occurred.
/// A point that is skipped could be the one that broke the tooth; so none is skipped.

namespace millforce::sim {

/// Equal buckets from 0 to `length` of a time in s or a path in mm.
struct BucketAxis {
    double length = 0.0;
    std::size_t bucket_count = 0;

    /// Bucket of a position; what lies outside belongs to the first or last.
    std::size_t bucket(double position) const;
};

/// The samples of one run in the buckets of an axis: bucket k holds samples first[k] … first[k + 1] − 1.
/// A trace point stands for the interval that ends at its position, so an empty bucket between two points shows the
/// later one; buckets after the last point hold nothing.
class BucketedRun {
  public:
    /// `position` is called for every point and must not decrease along the trace.
    BucketedRun(const BucketAxis& axis, std::span<const TracePoint> trace,
                const std::function<double(const TracePoint&)>& position);

    std::size_t bucket_count() const { return first_.size() - 1; }

    /// The points that bucket k shows: its own, or the one point of the interval that spans it, or none.
    std::span<const TracePoint> points(std::size_t k) const;

  private:
    std::span<const TracePoint> trace_;
    std::vector<std::size_t> first_;
};

using TraceValue = std::function<double(const TracePoint&)>;

/// Two values per bucket: minimum and maximum of the finite ones, in the order of their occurrence; NaN if there is
/// none. The series' maximum and minimum are therefore among the results, exactly.
std::vector<double> min_max_decimated(const BucketedRun& run, const TraceValue& value);

/// One value per bucket: the smallest or the largest finite one, NaN if there is none.
std::vector<double> bucket_minima(const BucketedRun& run, const TraceValue& value);
std::vector<double> bucket_maxima(const BucketedRun& run, const TraceValue& value);

}  // namespace millforce::sim
