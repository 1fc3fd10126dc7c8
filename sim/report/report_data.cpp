// SPDX-License-Identifier: Apache-2.0
#include "report/report_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "control/cut_state.hpp"
#include "report/decimation.hpp"
#include "report/json_writer.hpp"

namespace millforce::sim {

namespace {

constexpr double band_sd = 1.959964;  ///< two-sided 95 % of the normal distribution
constexpr char digits[] = "0123456789abcdefghijklmnopqrstuvwxyz";
static_assert(control::state_count < sizeof digits && control::limit_count < sizeof digits);

using Position = double (*)(const TracePoint&);

struct ChartColumn {
    const char* key;
    int places;
    double (*value)(const TracePoint&);
};

double out_of_rapid(const TracePoint& point, double value) {
    return point.rapid ? host::no_estimate : value;
}

/// Columns of every run. Rapid moves are left out of feed and override: their feed would flatten everything else.
constexpr ChartColumn columns_of_every_run[] = {
    {"tooth_force_N", 1, [](const TracePoint& p) { return p.true_tooth_force_N; }},
    {"feed_mm_min", 0, [](const TracePoint& p) { return out_of_rapid(p, 60.0 * p.feed_mm_s); }},
    {"override_percent", 1, [](const TracePoint& p) { return out_of_rapid(p, 100.0 * p.override_ratio); }},
};

constexpr ChartColumn columns_of_first_run[] = {
    {"peak_force_N", 1, [](const TracePoint& p) { return p.true_peak_force_N; }},
    {"estimated_peak_force_N", 1, [](const TracePoint& p) { return p.peak_force_N; }},
    {"true_radial_immersion", 3, [](const TracePoint& p) { return p.true_radial_immersion; }},
    {"radial_immersion", 3, [](const TracePoint& p) { return p.radial_immersion; }},
    {"true_axial_depth_mm", 3, [](const TracePoint& p) { return p.true_axial_depth_mm; }},
    {"axial_depth_mm", 3, [](const TracePoint& p) { return p.axial_depth_mm; }},
};

void write_values(host::JsonWriter& json, const char* key, std::span<const double> values, int places) {
    json.key(key).begin_array();
    for (const double value : values) {
        json.decimal(value, places);
    }
    json.end_array();
}

void write_columns(host::JsonWriter& json, const BucketedRun& run, std::span<const ChartColumn> columns) {
    for (const ChartColumn& column : columns) {
        write_values(json, column.key, min_max_decimated(run, column.value), column.places);
    }
}

/// Of the moving limit the lowest in each bucket, one value: what counts, and no zigzag.
void write_force_limit(host::JsonWriter& json, const BucketedRun& run) {
    write_values(json, "force_limit_N", bucket_minima(run, [](const TracePoint& p) { return p.force_limit_N; }), 1);
}

/// The 95 % band of an estimate: its lowest and highest bound in each bucket. An estimate without a standard deviation
/// has no band.
void write_band(host::JsonWriter& json, const BucketedRun& run, const char* low_key, const char* high_key,
                double TracePoint::*value, double TracePoint::*sd) {
    const auto low = [&](const TracePoint& p) { return std::max(p.*value - band_sd * (p.*sd), 0.0); };
    const auto high = [&](const TracePoint& p) { return p.*value + band_sd * (p.*sd); };
    write_values(json, low_key, bucket_minima(run, low), 3);
    write_values(json, high_key, bucket_maxima(run, high), 3);
}

void write_bands(host::JsonWriter& json, const BucketedRun& run) {
    write_band(json, run, "radial_immersion_low", "radial_immersion_high", &TracePoint::radial_immersion,
               &TracePoint::radial_immersion_sd);
    write_band(json, run, "axial_depth_low_mm", "axial_depth_high_mm", &TracePoint::axial_depth_mm,
               &TracePoint::axial_depth_sd_mm);
}

/// How important a state is: of the states in one bucket the most important is shown, so that a short hold is not lost.
constexpr int weight_of_state(std::uint8_t state) {
    constexpr int weights[control::state_count] = {0, 3, 1, 2, 4, 5};  // air, entry, in_cut, exit, hold, fault
    return state < control::state_count ? weights[state] : 0;
}

/// One hexadecimal digit per bucket for the state and one for the limit that held the override in it; '.' where the run
/// has ended.
void write_states(host::JsonWriter& json, const BucketedRun& run) {
    std::string states;
    std::string limits;
    for (std::size_t k = 0; k < run.bucket_count(); ++k) {
        const std::span<const TracePoint> points = run.points(k);
        if (points.empty()) {
            states += '.';
            limits += '.';
            continue;
        }
        const TracePoint& shown = *std::max_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
            return weight_of_state(a.state) < weight_of_state(b.state);
        });
        states += digits[shown.state % control::state_count];
        limits += digits[shown.limit % control::limit_count];
    }
    json.key("states").text(states).key("limits").text(limits);
}

void write_chart_axis(host::JsonWriter& json, std::span<const RunResult> runs, Position position) {
    BucketAxis axis;
    std::size_t longest_trace = 1;
    for (const RunResult& run : runs) {
        axis.length = run.trace.empty() ? axis.length : std::max(axis.length, position(run.trace.back()));
        longest_trace = std::max(longest_trace, run.trace.size());
    }
    axis.length = axis.length > 0.0 ? axis.length : 1.0;  // an empty run still has an axis
    axis.bucket_count = std::min(chart_bucket_count, longest_trace);
    json.begin_object();
    json.key("length").decimal(axis.length, 3);
    json.key("buckets").unsigned_integer(axis.bucket_count);
    json.key("runs").begin_array();
    for (const RunResult& run : runs) {
        const BucketedRun bucketed(axis, run.trace, position);
        json.begin_object();
        write_columns(json, bucketed, columns_of_every_run);
        if (&run == &runs.front()) {
            write_columns(json, bucketed, columns_of_first_run);
            write_force_limit(json, bucketed);
            write_bands(json, bucketed);
            write_states(json, bucketed);
        }
        json.end_object();
    }
    json.end_array().end_object();
}

/// A column of integers, each the difference to the one before: short numbers for a smooth path.
class DifferenceColumn {
  public:
    DifferenceColumn(const char* key, double unit) : key_(key), unit_(unit) {}

    void append(double value) {
        const double scaled = std::isfinite(value) ? std::clamp(value / unit_, -1e12, 1e12) : 0.0;
        const std::int64_t rounded = std::llround(scaled);
        differences_.push_back(rounded - last_);
        last_ = rounded;
    }

    void write(host::JsonWriter& json) const {
        json.key(key_).begin_array();
        for (const std::int64_t difference : differences_) {
            json.integer(difference);
        }
        json.end_array();
    }

  private:
    const char* key_;
    double unit_;
    std::int64_t last_ = 0;
    std::vector<std::int64_t> differences_;
};

/// The largest tooth force of a group of points as a share of the limit in ‰; −1 for a rapid move
/// without force: one with force must be seen.
double force_share(std::span<const TracePoint> group, double tooth_force_limit_N) {
    double largest_N = 0.0;
    bool all_rapid = true;
    for (const TracePoint& point : group) {
        largest_N = std::max(largest_N, point.true_tooth_force_N);
        all_rapid = all_rapid && point.rapid;
    }
    return all_rapid && !(largest_N > 0.0) ? -1.0 : std::ceil(1000.0 * largest_N / std::max(tooth_force_limit_N, 1e-9));
}

void write_path(host::JsonWriter& json, const ScenarioInfo& info, std::span<const TracePoint> trace) {
    DifferenceColumn time("t", 1e-3);
    DifferenceColumn path("s", 1e-2);
    DifferenceColumn x("x", 1e-2);
    DifferenceColumn y("y", 1e-2);
    DifferenceColumn z("z", 1e-2);
    DifferenceColumn share("share", 1.0);
    const std::size_t group_size = trace.size() / top_view_point_count + 1;
    for (std::size_t first = 0; first < trace.size(); first += group_size) {
        const auto group = trace.subspan(first, std::min(group_size, trace.size() - first));
        const TracePoint& end = group.back();
        time.append(end.time_s);
        path.append(end.path_mm);
        x.append(end.x_mm);
        y.append(end.y_mm);
        z.append(end.z_mm);
        share.append(force_share(group, info.tooth_force_limit_N));
    }
    json.key("path").begin_object();
    for (const DifferenceColumn* column : {&time, &path, &x, &y, &z, &share}) {
        column->write(json);
    }
    json.end_object();
}

void write_report_scenario(host::JsonWriter& json, const ScenarioInfo& info) {
    json.begin_object();
    json.key("name").text(info.name);
    json.key("tooth_force_limit_N").number(info.tooth_force_limit_N);
    json.key("cutter_diameter_mm").number(info.cutter_diameter_mm);
    json.key("stock_mm");
    if (info.has_top_view) {
        json.begin_array();
        for (const double edge_mm :
             {info.stock_min_x_mm, info.stock_min_y_mm, info.stock_max_x_mm, info.stock_max_y_mm}) {
            json.decimal(edge_mm, 3);
        }
        json.end_array();
    } else {
        json.null();
    }
    json.end_object();
}

template <typename Enumeration>
void write_names(host::JsonWriter& json, const char* key, unsigned count) {
    json.key(key).begin_array();
    for (unsigned k = 0; k < count; ++k) {
        json.text(control::name(static_cast<Enumeration>(k)));
    }
    json.end_array();
}

}  // namespace

std::string report_data_json(const ScenarioInfo& info, std::span<const RunResult> runs) {
    host::JsonWriter json;
    json.begin_object().key("scenario");
    write_report_scenario(json, info);
    write_names<control::CutState>(json, "state_names", control::state_count);
    write_names<control::Limit>(json, "limit_names", control::limit_count);
    json.key("runs").begin_array();
    for (const RunResult& run : runs) {
        json.begin_object().key("name").text(run.controller);
        if (info.has_top_view) {
            write_path(json, info, run.trace);
        }
        json.end_object();
    }
    json.end_array();
    json.key("charts").begin_object();
    json.key("time");
    write_chart_axis(json, runs, [](const TracePoint& point) { return point.time_s; });
    json.key("path");
    write_chart_axis(json, runs, [](const TracePoint& point) { return point.path_mm; });
    json.end_object().end_object();
    return json.str();
}

}  // namespace millforce::sim
