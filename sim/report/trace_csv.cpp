// SPDX-License-Identifier: Apache-2.0
#include "report/trace_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "control/cut_state.hpp"
#include "estimation/cutting/cut_geometry.hpp"

namespace millforce::sim {

namespace {

constexpr int significant_digits = 8;

void append(std::string& line, double value) {
    if (std::isfinite(value)) {
        fmt::format_to(std::back_inserter(line), "{:.{}g}", value + 0.0, significant_digits);
    }
}

/// A cell of text, in quotes where a comma, quote or line break in it would be taken for structure (RFC 4180).
std::string csv_text(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
        return std::string(text);
    }
    std::string out = "\"";
    for (const char character : text) {
        out += character;
        if (character == '"') {
            out += '"';
        }
    }
    return out += '"';
}

template <double TracePoint::*Value>
constexpr TraceColumn number(const char* name) {
    return {name, [](const TracePoint& point) { return point.*Value; }, nullptr};
}

template <typename Enumeration, std::uint8_t TracePoint::*Code>
constexpr TraceColumn code_name(const char* name) {
    return {name, nullptr,
            [](const TracePoint& point) { return control::name(static_cast<Enumeration>(point.*Code)); }};
}

/// In the order of the file. The column `controller` is between the two lists: it belongs to the run.
constexpr TraceColumn estimates[] = {
    number<&TracePoint::time_s>("time_s"),
    code_name<control::CutState, &TracePoint::state>("state"),
    number<&TracePoint::tangential_force_N>("tangential_force_N"),
    number<&TracePoint::feed_force_N>("feed_force_N"),
    number<&TracePoint::radial_immersion>("radial_immersion"),
    number<&TracePoint::radial_immersion_sd>("radial_immersion_sd"),
    number<&TracePoint::axial_depth_mm>("axial_depth_mm"),
    number<&TracePoint::axial_depth_sd_mm>("axial_depth_sd_mm"),
    number<&TracePoint::peak_force_N>("peak_force_N"),
    number<&TracePoint::force_limit_N>("force_limit_N"),
    number<&TracePoint::override_ratio>("override"),
};

constexpr TraceColumn simulation[] = {
    number<&TracePoint::path_mm>("path_mm"),
    number<&TracePoint::x_mm>("x_mm"),
    number<&TracePoint::y_mm>("y_mm"),
    number<&TracePoint::z_mm>("z_mm"),
    number<&TracePoint::feed_mm_s>("feed_mm_s"),
    number<&TracePoint::programmed_feed_mm_s>("programmed_feed_mm_s"),
    {"rapid", [](const TracePoint& point) { return point.rapid ? 1.0 : 0.0; }, nullptr},
    code_name<control::Limit, &TracePoint::limit>("limit"),
    code_name<control::Fault, &TracePoint::fault>("fault"),
    number<&TracePoint::tooth_force_N>("tooth_force_N"),
    number<&TracePoint::true_tooth_force_N>("true_tooth_force_N"),
    number<&TracePoint::true_peak_force_N>("true_peak_force_N"),
    number<&TracePoint::true_tangential_force_N>("true_tangential_force_N"),
    number<&TracePoint::true_feed_force_N>("true_feed_force_N"),
    number<&TracePoint::true_radial_immersion>("true_radial_immersion"),
    number<&TracePoint::true_axial_depth_mm>("true_axial_depth_mm"),
    number<&TracePoint::runout_um>("runout_um"),
    {"cut_side", nullptr,
     [](const TracePoint& point) {
         return std::isnan(point.law_misfit) ? "" : name(static_cast<estimation::CutSide>(point.side));
     }},
    number<&TracePoint::law_misfit>("law_misfit"),
};

void append_cell(std::string& line, const TraceColumn& column, const TracePoint& point) {
    if (column.number != nullptr) {
        append(line, column.number(point));
    } else {
        line += column.text(point);
    }
}

bool stays_in_file_name(char character) {
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
           (character >= '0' && character <= '9') || character == '_' || character == '-';
}

}  // namespace

std::span<const TraceColumn> estimate_columns() {
    return estimates;
}

std::span<const TraceColumn> simulation_columns() {
    return simulation;
}

std::string trace_csv(const RunResult& run) {
    const std::string controller = csv_text(run.controller);
    std::string out;
    for (const TraceColumn& column : estimates) {
        out += fmt::format("{},", column.name);
    }
    out += "controller";
    for (const TraceColumn& column : simulation) {
        out += fmt::format(",{}", column.name);
    }
    out += '\n';
    for (const TracePoint& point : run.trace) {
        for (const TraceColumn& column : estimates) {
            append_cell(out, column, point);
            out += ',';
        }
        out += controller;
        for (const TraceColumn& column : simulation) {
            out += ',';
            append_cell(out, column, point);
        }
        out += '\n';
    }
    return out;
}

std::string trace_file_name(const RunResult& run, std::span<const RunResult> runs) {
    if (!runs.empty() && &run == &runs.front()) {
        return "trace.csv";
    }
    std::string name = "trace_";
    for (const char character : run.controller) {
        name += stays_in_file_name(character) ? character : '_';
    }
    return name + ".csv";
}

}  // namespace millforce::sim
