// SPDX-License-Identifier: Apache-2.0
#include "report/json_writer.hpp"
#include "report/summary.hpp"

namespace millforce::sim {

namespace {

constexpr struct {
    const char* key;
    double RunFigures::*value;
} figure_keys[] = {
    {"time_s", &RunFigures::time_s},
    {"cutting_time_s", &RunFigures::cutting_time_s},
    {"path_mm", &RunFigures::path_mm},
    {"peak_tooth_force_N", &RunFigures::peak_tooth_force_N},
    {"peak_over_limit", &RunFigures::peak_over_limit},
    {"time_over_limit_s", &RunFigures::time_over_limit_s},
    {"longest_over_limit_s", &RunFigures::longest_over_limit_s},
    {"reaction_time_s", &RunFigures::reaction_time_s},
    {"late_over_limit_s", &RunFigures::late_over_limit_s},
    {"mean_override", &RunFigures::mean_override},
    {"mean_force_use", &RunFigures::mean_force_use},
    {"immersion_rms", &RunFigures::immersion_rms},
    {"immersion_coverage", &RunFigures::immersion_coverage},
    {"depth_rms_mm", &RunFigures::depth_rms_mm},
    {"depth_coverage", &RunFigures::depth_coverage},
    {"estimate_share", &RunFigures::estimate_share},
    {"real_time_factor", &RunFigures::real_time_factor},
};

void write_summary_scenario(host::JsonWriter& json, const ScenarioInfo& info) {
    json.begin_object();
    json.key("name").text(info.name).key("title").text(info.title).key("description").text(info.description);
    json.key("tool").text(info.tool).key("material").text(info.material);
    json.key("seed").unsigned_integer(info.seed);
    json.key("tooth_force_limit_N").number(info.tooth_force_limit_N);
    json.key("cutter_diameter_mm").number(info.cutter_diameter_mm);
    json.key("spindle_speed_rad_s").number(info.spindle_speed_rad_s);
    json.key("constant_feed_mm_s").number(info.constant_feed_mm_s);
    json.key("hardest_material").number(info.hardest_material);
    json.key("hindsight_feed_mm_s").number(info.hindsight_feed_mm_s);
    json.key("stock");
    if (info.has_top_view) {
        json.begin_object();
        json.key("min_x_mm").number(info.stock_min_x_mm).key("min_y_mm").number(info.stock_min_y_mm);
        json.key("max_x_mm").number(info.stock_max_x_mm).key("max_y_mm").number(info.stock_max_y_mm);
        json.end_object();
    } else {
        json.null();
    }
    json.end_object();
}

void write_run(host::JsonWriter& json, const RunResult& run, std::span<const RunResult> runs) {
    json.begin_object();
    json.key("controller").text(run.controller);
    json.key("finished").boolean(run.figures.finished);
    json.key("fault").text(run.figures.fault);
    json.key("time_saved_percent").number(time_saved_percent(run, runs).value_or(host::no_estimate));
    json.key("time_saved_in_hindsight_percent")
        .number(time_saved_percent(run, runs, constant_feed_in_hindsight).value_or(host::no_estimate));
    json.key("teeth_broken").integer(run.figures.teeth_broken);
    for (const auto& [key, value] : figure_keys) {
        json.key(key).number(run.figures.*value);
    }
    json.end_object();
}

}  // namespace

std::string summary_json(const ScenarioInfo& info, std::span<const RunResult> runs) {
    host::JsonWriter json(host::JsonWriter::Style::indented);
    json.begin_object().key("scenario");
    write_summary_scenario(json, info);
    json.key("runs").begin_array();
    for (const RunResult& run : runs) {
        write_run(json, run, runs);
    }
    json.end_array().end_object();
    return json.str() + '\n';
}

}  // namespace millforce::sim
