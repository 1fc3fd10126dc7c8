// SPDX-License-Identifier: Apache-2.0
#include "control/cut_state.hpp"
#include "report/json_writer.hpp"
#include "run_report/run_page.hpp"
#include "run_report/run_words.hpp"

namespace millforce::host {

namespace {

constexpr char digits[] = "0123456789abcdefghijklmnopqrstuvwxyz";
static_assert(control::state_count < sizeof digits && control::limit_count < sizeof digits);

/// Both ends of each bin's range.
void write_ranges(JsonWriter& json, const char* key, const RunHistory& history, ValueRange RunBin::*range, int places,
                  double unit = 1.0) {
    json.key(key).begin_array();
    for (const RunBin& bin : history.bins()) {
        json.decimal(unit * static_cast<double>((bin.*range).low), places);
        json.decimal(unit * static_cast<double>((bin.*range).high), places);
    }
    json.end_array();
}

void write_ends(JsonWriter& json, const char* key, const RunHistory& history, ValueRange RunBin::*range,
                float ValueRange::*end) {
    json.key(key).begin_array();
    for (const RunBin& bin : history.bins()) {
        json.decimal(static_cast<double>(bin.*range.*end), 3);
    }
    json.end_array();
}

void write_band(JsonWriter& json, const char* low_key, const char* high_key, const RunHistory& history,
                ValueRange RunBin::*range) {
    write_ends(json, low_key, history, range, &ValueRange::low);
    write_ends(json, high_key, history, range, &ValueRange::high);
}

/// One hexadecimal digit for each bin, '.' where there was no tick.
void write_strips(JsonWriter& json, const RunHistory& history) {
    std::string states;
    std::string limits;
    for (const RunBin& bin : history.bins()) {
        states += bin.is_empty ? '.' : digits[bin.state % control::state_count];
        limits += bin.is_empty ? '.' : digits[static_cast<unsigned>(bin.limit()) % control::limit_count];
    }
    json.key("states").text(states).key("limits").text(limits);
}

void write_names(JsonWriter& json) {
    json.key("state_names").begin_array();
    for (unsigned k = 0; k < control::state_count; ++k) {
        json.text(control::name(static_cast<control::CutState>(k)));
    }
    json.end_array().key("limit_labels").begin_array();
    for (unsigned k = 0; k < control::limit_count; ++k) {
        json.text(words_of(static_cast<control::Limit>(k)).label);
    }
    json.end_array();
}

void write_events(JsonWriter& json, const RunHistory& history) {
    json.key("events").begin_array();
    for (const RunEvent& event : history.events()) {
        json.begin_object();
        json.key("time_s").decimal(event.time_s, 3).key("fault").boolean(event.is_fault).key("text").text(event.text);
        json.end_object();
    }
    json.end_array();
}

}  // namespace

std::string run_page_json(const RunHistory& history) {
    JsonWriter json;
    json.begin_object();
    json.key("length").number(history.bin_width_s() * static_cast<double>(history.bins().size()), 9);
    json.key("buckets").unsigned_integer(history.bins().size());
    write_ranges(json, "tooth_force_N", history, &RunBin::tooth_force_N, 1);
    write_ranges(json, "tooth_force_bound_N", history, &RunBin::tooth_force_bound_N, 1);
    write_ends(json, "tooth_force_limit_N", history, &RunBin::tooth_force_limit_N, &ValueRange::low);
    write_ranges(json, "override_percent", history, &RunBin::override_ratio, 1, 100.0);
    write_ranges(json, "radial_immersion", history, &RunBin::radial_immersion, 3);
    write_band(json, "radial_immersion_low", "radial_immersion_high", history, &RunBin::radial_immersion_band);
    write_ranges(json, "axial_depth_mm", history, &RunBin::axial_depth_mm, 3);
    write_band(json, "axial_depth_low_mm", "axial_depth_high_mm", history, &RunBin::axial_depth_band_mm);
    write_strips(json, history);
    write_names(json);
    write_events(json, history);
    json.end_object();
    return json.str();
}

}  // namespace millforce::host
