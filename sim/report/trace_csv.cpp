// SPDX-License-Identifier: Apache-2.0
#include "report/trace_csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "control/cut_state.hpp"

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

struct TraceColumn {
    const char* name;
    void (*cell)(std::string& line, const TracePoint& point);
};

template <double TracePoint::*Value>
void number(std::string& line, const TracePoint& point) {
    append(line, point.*Value);
}

template <typename Enumeration, std::uint8_t TracePoint::*Code>
void code_name(std::string& line, const TracePoint& point) {
    line += control::name(static_cast<Enumeration>(point.*Code));
}

/// In the order of the file. The column `controller` is between the two lists: it belongs to the run.
constexpr TraceColumn estimate_columns[] = {
    {"time_s", number<&TracePoint::time_s>},
    {"state", code_name<control::CutState, &TracePoint::state>},
    {"tangential_force_N", number<&TracePoint::tangential_force_N>},
    {"feed_force_N", number<&TracePoint::feed_force_N>},
    {"radial_immersion", number<&TracePoint::radial_immersion>},
    {"radial_immersion_sd", number<&TracePoint::radial_immersion_sd>},
    {"axial_depth_mm", number<&TracePoint::axial_depth_mm>},
    {"axial_depth_sd_mm", number<&TracePoint::axial_depth_sd_mm>},
    {"peak_force_N", number<&TracePoint::peak_force_N>},
    {"force_limit_N", number<&TracePoint::force_limit_N>},
    {"override", number<&TracePoint::override_ratio>},
};

constexpr TraceColumn simulation_columns[] = {
    {"path_mm", number<&TracePoint::path_mm>},
    {"x_mm", number<&TracePoint::x_mm>},
    {"y_mm", number<&TracePoint::y_mm>},
    {"z_mm", number<&TracePoint::z_mm>},
    {"feed_mm_s", number<&TracePoint::feed_mm_s>},
    {"programmed_feed_mm_s", number<&TracePoint::programmed_feed_mm_s>},
    {"rapid", [](std::string& line, const TracePoint& point) { line += point.rapid ? '1' : '0'; }},
    {"limit", code_name<control::Limit, &TracePoint::limit>},
    {"fault", code_name<control::Fault, &TracePoint::fault>},
    {"tooth_force_N", number<&TracePoint::tooth_force_N>},
    {"true_tooth_force_N", number<&TracePoint::true_tooth_force_N>},
    {"true_peak_force_N", number<&TracePoint::true_peak_force_N>},
    {"true_tangential_force_N", number<&TracePoint::true_tangential_force_N>},
    {"true_feed_force_N", number<&TracePoint::true_feed_force_N>},
    {"true_radial_immersion", number<&TracePoint::true_radial_immersion>},
    {"true_axial_depth_mm", number<&TracePoint::true_axial_depth_mm>},
};

bool stays_in_file_name(char character) {
    return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z') ||
           (character >= '0' && character <= '9') || character == '_' || character == '-';
}

}  // namespace

std::string trace_csv(const RunResult& run) {
    const std::string controller = csv_text(run.controller);
    std::string out;
    for (const TraceColumn& column : estimate_columns) {
        out += fmt::format("{},", column.name);
    }
    out += "controller";
    for (const TraceColumn& column : simulation_columns) {
        out += fmt::format(",{}", column.name);
    }
    out += '\n';
    for (const TracePoint& point : run.trace) {
        for (const TraceColumn& column : estimate_columns) {
            column.cell(out, point);
            out += ',';
        }
        out += controller;
        for (const TraceColumn& column : simulation_columns) {
            out += ',';
            column.cell(out, point);
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
