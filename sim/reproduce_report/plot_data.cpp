// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report/plot_data.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::sim {

namespace {

using Style = Plot::Series::Style;

constexpr const char* style_name(Style style) {
    switch (style) {
        case Style::line:
            return "line";
        case Style::points:
            return "points";
        case Style::band_low:
            return "band_low";
        case Style::band_high:
            return "band_high";
    }
    return "line";
}

/// Places of the smallest and the largest finite value of points first … end − 1; `end` if there is none.
struct GroupExtremes {
    std::size_t lowest;
    std::size_t highest;
};

GroupExtremes extremes_of(const std::vector<double>& values, std::size_t first, std::size_t end) {
    GroupExtremes found{end, end};
    for (std::size_t k = first; k < end; ++k) {
        if (std::isfinite(values[k])) {
            found.lowest = found.lowest == end || values[k] < values[found.lowest] ? k : found.lowest;
            found.highest = found.highest == end || values[k] > values[found.highest] ? k : found.highest;
        }
    }
    return found;
}

void write_numbers(host::JsonWriter& json, const char* key, const std::vector<double>& values) {
    constexpr int digits = 5;
    json.key(key).begin_array();
    for (const double value : values) {
        json.number(value, digits);
    }
    json.end_array();
}

}  // namespace

Plot::Series decimated(const Plot::Series& series) {
    const std::size_t count = std::min(series.x.size(), series.y.size());
    if (count <= plot_point_count) {
        return series;
    }
    Plot::Series kept{series.name, series.style, {}, {}};
    const auto keep = [&](std::size_t k) {
        kept.x.push_back(series.x[k]);
        kept.y.push_back(series.y[k]);
    };
    constexpr std::size_t groups = plot_point_count / 2;
    for (std::size_t group = 0; group < groups; ++group) {
        const std::size_t first = group * count / groups;
        const std::size_t end = (group + 1) * count / groups;
        const auto [lowest, highest] = extremes_of(series.y, first, end);
        if (lowest == end) {
            keep(first);
        } else if (series.style == Style::band_low || lowest == highest) {
            keep(lowest);
        } else if (series.style == Style::band_high) {
            keep(highest);
        } else {
            keep(std::min(lowest, highest));
            keep(std::max(lowest, highest));
        }
    }
    return kept;
}

void write_plot(host::JsonWriter& json, const Plot& plot) {
    json.begin_object();
    json.key("title").text(plot.title);
    json.key("x_label").text(plot.x_label).key("y_label").text(plot.y_label);
    json.key("series").begin_array();
    for (const Plot::Series& series : plot.series) {
        const Plot::Series drawn = decimated(series);
        json.begin_object().key("name").text(drawn.name).key("style").text(style_name(drawn.style));
        write_numbers(json, "x", drawn.x);
        write_numbers(json, "y", drawn.y);
        json.end_object();
    }
    json.end_array().end_object();
}

}  // namespace millforce::sim
