// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <vector>

#include "report/decimation.hpp"
#include "synthetic_run.hpp"

// Last: its macro for new does not stand <functional>.
#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

double time_of(const TracePoint& point) {
    return point.time_s;
}
double force_of(const TracePoint& point) {
    return point.true_tooth_force_N;
}
double immersion_of(const TracePoint& point) {
    return point.radial_immersion;
}

std::vector<TracePoint> trace_of(const std::vector<double>& forces_N) {
    std::vector<TracePoint> trace;
    for (const double force_N : forces_N) {
        TracePoint point;
        point.time_s = 0.1 * static_cast<double>(trace.size() + 1);
        point.true_tooth_force_N = force_N;
        trace.push_back(point);
    }
    return trace;
}

}  // namespace

TEST_GROUP(Decimation){};

TEST(Decimation, OfEveryBucketTheExtremesRemainInTheirOrder) {
    const std::vector<TracePoint> trace = trace_of({3, 9, 1, 4, 5, 2, 8, 7});
    const BucketedRun run({.length = 0.85, .bucket_count = 2}, trace, time_of);
    const std::vector<double> kept = min_max_decimated(run, force_of);
    CHECK(kept == (std::vector<double>{9, 1, 2, 8}));
    CHECK(bucket_minima(run, force_of) == (std::vector<double>{1, 2}));
    CHECK(bucket_maxima(run, force_of) == (std::vector<double>{9, 8}));
}

TEST(Decimation, EveryLocalMaximumOfTheForceIsKept) {
    const RunResult run = synthetic::pocket_run("millforce");
    const BucketAxis axis{.length = run.trace.back().time_s, .bucket_count = 97};
    const BucketedRun bucketed(axis, run.trace, time_of);
    const std::vector<double> kept = min_max_decimated(bucketed, force_of);
    LONGS_EQUAL(2 * 97, kept.size());
    for (const TracePoint& point : run.trace) {
        const std::size_t bucket = axis.bucket(point.time_s);
        CHECK(std::max(kept[2 * bucket], kept[2 * bucket + 1]) >= point.true_tooth_force_N);
        CHECK(std::min(kept[2 * bucket], kept[2 * bucket + 1]) <= point.true_tooth_force_N);
    }
    DOUBLES_EQUAL(run.figures.peak_tooth_force_N, *std::max_element(kept.begin(), kept.end()), 0.0);
}

TEST(Decimation, ASinglePeakAmongAHundredThousandPointsIsKept) {
    std::vector<double> forces_N(100000, 100.0);
    forces_N[54321] = 431.0;
    const std::vector<TracePoint> trace = trace_of(forces_N);
    const BucketedRun run({.length = trace.back().time_s, .bucket_count = 1250}, trace, time_of);
    const std::vector<double> kept = min_max_decimated(run, force_of);
    LONGS_EQUAL(1, std::count(kept.begin(), kept.end(), 431.0));
}

TEST(Decimation, WithoutAnEstimateThereIsNoValue) {
    std::vector<TracePoint> trace = trace_of({1, 2, 3, 4, 5, 6});
    trace[0].radial_immersion = 0.5;  // the rest stays NaN
    const BucketedRun run({.length = 0.6, .bucket_count = 2}, trace, time_of);
    const std::vector<double> kept = min_max_decimated(run, immersion_of);
    DOUBLES_EQUAL(0.5, kept[0], 0.0);
    DOUBLES_EQUAL(0.5, kept[1], 0.0);
    CHECK(std::isnan(kept[2]) && std::isnan(kept[3]));
    CHECK(std::isnan(bucket_minima(run, immersion_of)[1]) && std::isnan(bucket_maxima(run, immersion_of)[1]));
}

TEST(Decimation, AnIntervalLongerThanABucketFillsTheBucketsThatItSpans) {
    std::vector<TracePoint> trace = trace_of({10, 20});
    trace[0].time_s = 1.0;
    trace[1].time_s = 5.0;
    const BucketedRun run({.length = 8.0, .bucket_count = 8}, trace, time_of);
    const std::vector<double> kept = bucket_maxima(run, force_of);
    DOUBLES_EQUAL(10.0, kept[0], 0.0);
    for (const std::size_t spanned : {2U, 3U, 4U, 5U}) {
        DOUBLES_EQUAL(20.0, kept[spanned], 0.0);
    }
    CHECK(std::isnan(kept[6]) && std::isnan(kept[7]));  // the run has ended
}

TEST(Decimation, AnEmptyTraceAndAnAxisWithoutLengthAreNoTrouble) {
    const BucketedRun empty({.length = 0.0, .bucket_count = 3}, {}, time_of);
    for (const double value : min_max_decimated(empty, force_of)) {
        CHECK(std::isnan(value));
    }
    const std::vector<TracePoint> trace = trace_of({7});
    const BucketedRun single({.length = 0.0, .bucket_count = 3}, trace, time_of);
    DOUBLES_EQUAL(7.0, min_max_decimated(single, force_of)[0], 0.0);
}
