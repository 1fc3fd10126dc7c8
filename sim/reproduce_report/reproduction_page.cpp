// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report/reproduction_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "report/json_writer.hpp"
#include "report/page_template.hpp"
#include "report/report_assets.hpp"
#include "reproduce_report/figure_tables.hpp"
#include "reproduce_report/plot_data.hpp"
#include "reproduce_report/reproduction_assets.hpp"

namespace millforce::sim {

namespace {

std::string plot_id(const Reproduction& reproduction, std::size_t k) {
    return fmt::format("{}-{}", reproduction.name, k + 1);
}

/// Numbers are written with a true minus sign.
std::string cell_html(std::string_view label, std::string_view value) {
    const bool is_negative = value.starts_with('-');
    const std::string text = (is_negative ? "−" : "") + html_escaped(value.substr(is_negative ? 1 : 0));
    return fmt::format("<td class=\"{0}\" data-label=\"{0}\">{1}</td>", label, value.empty() ? "–" : text);
}

std::string row_html(const Figure& figure, const FigureTable& table) {
    const bool is_shown = figure.judged == Figure::Judged::shown;
    const char* style = is_shown ? "shown" : (figure.holds() ? "held" : "broken");
    const char* judgement = is_shown ? "–" : (figure.holds() ? "ok" : "broken");
    std::string name = html_escaped(name_in_table(figure, table));
    if (!figure.unit.empty()) {
        name += fmt::format(" <span class=\"unit\">in {}</span>", html_escaped(figure.unit));
    }
    return fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th>{}{}{}{}<td class=\"judgement\">{}</td></tr>\n",
                       style, name, cell_html("paper", value_text(figure.published)),
                       cell_html("ours", value_text(figure.ours)), cell_html("difference", figure.difference()),
                       cell_html("bound", figure.bound_text()), judgement);
}

std::string table_html(const FigureTable& table) {
    std::string rows;
    for (const Figure& figure : table.figures) {
        rows += row_html(figure, table);
    }
    std::string html =
        "<table class=\"reproduced\">\n<thead><tr><th scope=\"col\">Figure</th><th scope=\"col\">Paper</th>"
        "<th scope=\"col\">Ours</th><th scope=\"col\">Difference</th><th scope=\"col\">Bound</th>"
        "<th scope=\"col\"></th></tr></thead>\n<tbody>\n" +
        rows + "</tbody>\n</table>\n";
    if (!table.is_long()) {
        return html;
    }
    const FigureCount count = count_figures(table.figures);
    return fmt::format("<details{}><summary><strong>{}</strong>: {}</summary>\n{}</details>\n",
                       count.broken > 0 ? " open" : "", html_escaped(table.title), verdict(count), html);
}

std::string plots_html(const Reproduction& reproduction) {
    std::string html;
    for (std::size_t k = 0; k < reproduction.plots.size(); ++k) {
        const Plot& plot = reproduction.plots[k];
        html += fmt::format(
            "<figure class=\"drawing\">\n<h4>{}</h4>\n<div id=\"{}\"></div>\n<figcaption>{}</figcaption>\n</figure>\n",
            html_escaped(plot.title), html_escaped(plot_id(reproduction, k)), html_escaped(plot.caption));
    }
    return html.empty() ? html : "<h3>Plots</h3>\n<div class=\"drawings\">\n" + html + "</div>\n";
}

std::string deviations_html(const Reproduction& reproduction) {
    std::string html;
    for (const std::string& deviation : reproduction.deviations) {
        html += fmt::format("<li>{}</li>\n", html_escaped(deviation));
    }
    return html.empty()
               ? html
               : "<h3>Where this differs from print, and why</h3>\n<ul class=\"deviations\">\n" + html + "</ul>\n";
}

std::string verdict_html(const Reproduction& reproduction) {
    return fmt::format("<p class=\"verdict {}\">{}</p>\n", reproduction.holds() ? "held" : "broken",
                       verdict(count_figures(reproduction.figures)));
}

std::string section_html(const Reproduction& reproduction) {
    const std::string name = html_escaped(reproduction.name);
    std::string html = fmt::format(
        "<section id=\"paper-{}\" class=\"reproduction\">\n<h2>{}</h2>\n<p class=\"description\">{}</p>\n{}", name,
        html_escaped(reproduction.title), html_escaped(reproduction.summary), verdict_html(reproduction));
    html += "<h3>Figures</h3>\n";
    for (const FigureTable& table : figure_tables(reproduction.figures)) {
        html += table_html(table);
    }
    return html + plots_html(reproduction) + deviations_html(reproduction) + "</section>\n";
}

std::string contents_html(std::span<const Reproduction> reproductions) {
    std::string html;
    for (const Reproduction& reproduction : reproductions) {
        html += fmt::format("<li class=\"{}\"><a href=\"#paper-{}\">{}</a><span>{}</span></li>\n",
                            reproduction.holds() ? "held" : "broken", html_escaped(reproduction.name),
                            html_escaped(reproduction.title), verdict(count_figures(reproduction.figures)));
    }
    return html;
}

std::string plots_json(std::span<const Reproduction> reproductions) {
    JsonWriter json;
    json.begin_object();
    for (const Reproduction& reproduction : reproductions) {
        for (std::size_t k = 0; k < reproduction.plots.size(); ++k) {
            json.key(plot_id(reproduction, k));
            write_plot(json, reproduction.plots[k]);
        }
    }
    json.end_object();
    return json.str();
}

}  // namespace

std::string reproduction_page(std::span<const Reproduction> reproductions) {
    const std::string contents = contents_html(reproductions);
    const std::string data = plots_json(reproductions);
    std::string sections;
    for (const Reproduction& reproduction : reproductions) {
        sections += section_html(reproduction);
    }
    return filled(reproduction_assets::page_template(),
                  {
                      {"contents", contents},
                      {"sections", sections},
                      {"data", data},
                      {"report_style", report_assets::report_style()},
                      {"page_style", reproduction_assets::page_style()},
                      {"charts_script", report_assets::charts_script()},
                      {"page_script", reproduction_assets::page_script()},
                      {"dygraphs_script", without_source_map(report_assets::dygraphs_script())},
                      {"dygraphs_style", without_source_map(report_assets::dygraphs_style())},
                  });
}

}  // namespace millforce::sim
