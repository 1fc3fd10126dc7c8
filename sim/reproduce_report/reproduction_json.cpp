// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report/reproduction_json.hpp"

#include <algorithm>

#include "report/json_writer.hpp"

namespace millforce::sim {

namespace {

constexpr int figure_digits = 9;

constexpr const char* judged_name(Figure::Judged judged) {
    switch (judged) {
        case Figure::Judged::difference:
            return "difference";
        case Figure::Judged::relative_difference:
            return "relative_difference";
        case Figure::Judged::at_most:
            return "at_most";
        case Figure::Judged::at_least:
            return "at_least";
        case Figure::Judged::within:
            return "within";
        case Figure::Judged::shown:
            return "shown";
    }
    return "shown";
}

void write_figure(host::JsonWriter& json, const Figure& figure) {
    using Judged = Figure::Judged;
    json.begin_object();
    json.key("name").text(figure.name).key("unit").text(figure.unit);
    json.key("published").number(figure.published, figure_digits).key("ours").number(figure.ours, figure_digits);
    json.key("judged").text(judged_name(figure.judged));
    if (figure.judged != Judged::shown) {
        json.key("bound").number(figure.bound, figure_digits);
    }
    if (figure.judged == Judged::within) {
        json.key("bound_low").number(figure.bound_low, figure_digits);
    }
    json.key("holds").boolean(figure.holds());
    if (!figure.reason.empty()) {
        json.key("reason").text(figure.reason);
    }
    json.end_object();
}

void write_figures(host::JsonWriter& json, const char* key, const std::vector<Figure>& figures) {
    json.key(key).begin_array();
    for (const Figure& figure : figures) {
        write_figure(json, figure);
    }
    json.end_array();
}

void write_reproduction(host::JsonWriter& json, const Reproduction& reproduction) {
    json.begin_object();
    json.key("name").text(reproduction.name).key("title").text(reproduction.title);
    json.key("source").text(reproduction.source.citation).key("doi").text(reproduction.source.doi);
    json.key("holds").boolean(reproduction.holds());
    write_figures(json, "figures", reproduction.figures);
    write_figures(json, "checks", reproduction.checks);
    json.key("deviations").begin_array();
    for (const std::string& deviation : reproduction.deviations) {
        json.text(deviation);
    }
    json.end_array();
    json.key("not_reproduced").begin_array();
    for (const NotReproduced& one : reproduction.not_reproduced) {
        json.begin_object().key("what").text(one.what).key("why").text(one.why).end_object();
    }
    json.end_array().end_object();
}

}  // namespace

std::string reproduction_json(std::span<const Reproduction> reproductions) {
    host::JsonWriter json(host::JsonWriter::Style::indented);
    json.begin_object();
    json.key("holds").boolean(
        std::all_of(reproductions.begin(), reproductions.end(), [](const Reproduction& r) { return r.holds(); }));
    json.key("papers").begin_array();
    for (const Reproduction& reproduction : reproductions) {
        write_reproduction(json, reproduction);
    }
    json.end_array().end_object();
    return json.str() + '\n';
}

}  // namespace millforce::sim
