// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report/reproduction_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "report/json_writer.hpp"
#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"
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
    const std::string text = (is_negative ? "−" : "") + host::html_escaped(value.substr(is_negative ? 1 : 0));
    return fmt::format("<td class=\"{0}\" data-label=\"{0}\">{1}</td>", label, value.empty() ? "–" : text);
}

/// What the rows of a table are: a check of our own has no paper's value, and no difference from one.
enum class Rows : unsigned char { published, own };

std::string row_html(const Figure& figure, const FigureTable& table, Rows rows) {
    const bool is_shown = figure.judged == Figure::Judged::shown;
    const char* style = is_shown ? "shown" : (figure.holds() ? "held" : "broken");
    const char* judgement = is_shown ? "–" : (figure.holds() ? "ok" : "broken");
    std::string name = host::html_escaped(name_in_table(figure, table));
    name += fmt::format(" <span class=\"unit\">{}</span>",
                        figure.unit.empty() ? "(no unit)" : "in " + host::html_escaped(figure.unit));
    if (!figure.reason.empty()) {
        name += fmt::format("<span class=\"reason\">{}</span>", host::html_escaped(figure.reason));
    }
    const bool is_published = rows == Rows::published;
    return fmt::format("<tr class=\"{}\"><th scope=\"row\">{}</th>{}{}{}{}<td class=\"judgement\">{}</td></tr>\n",
                       style, name, is_published ? cell_html("paper", value_text(figure.published)) : "",
                       cell_html("ours", value_text(figure.ours)),
                       is_published ? cell_html("difference", figure.difference()) : "",
                       cell_html("bound", figure.bound_text()), judgement);
}

std::string head_html(Rows rows) {
    return rows == Rows::published
               ? "<th scope=\"col\">Figure</th><th scope=\"col\">Paper</th><th scope=\"col\">Ours</th>"
                 "<th scope=\"col\">Difference</th><th scope=\"col\">Bound</th>"
               : "<th scope=\"col\">Check</th><th scope=\"col\">Ours</th><th scope=\"col\">Bound</th>";
}

std::string table_html(const FigureTable& table, Rows rows) {
    std::string body;
    for (const Figure& figure : table.figures) {
        body += row_html(figure, table, rows);
    }
    std::string html = "<table class=\"reproduced\">\n<thead><tr>" + head_html(rows) +
                       "<th scope=\"col\"></th></tr></thead>\n<tbody>\n" + body + "</tbody>\n</table>\n";
    if (!table.is_long()) {
        return html;
    }
    const FigureCount count = count_figures(table.figures);
    return fmt::format("<details{}><summary><strong>{}</strong>: {}</summary>\n{}</details>\n",
                       count.broken > 0 ? " open" : "", host::html_escaped(table.title), verdict(count), html);
}

std::string plots_html(const Reproduction& reproduction) {
    std::string html;
    for (std::size_t k = 0; k < reproduction.plots.size(); ++k) {
        const Plot& plot = reproduction.plots[k];
        html += fmt::format(
            "<figure class=\"drawing\">\n<h4>{}</h4>\n<div id=\"{}\"></div>\n<figcaption>{}</figcaption>\n</figure>\n",
            host::html_escaped(plot.title), host::html_escaped(plot_id(reproduction, k)),
            host::html_escaped(plot.caption));
    }
    return html.empty() ? html : "<h3>Plots</h3>\n<div class=\"drawings\">\n" + html + "</div>\n";
}

std::string deviations_html(const Reproduction& reproduction) {
    std::string html;
    for (const std::string& deviation : reproduction.deviations) {
        html += fmt::format("<li>{}</li>\n", host::html_escaped(deviation));
    }
    return html.empty()
               ? html
               : "<h3>Where this differs from print, and why</h3>\n<ul class=\"deviations\">\n" + html + "</ul>\n";
}

std::string not_reproduced_html(const Reproduction& reproduction) {
    std::string html;
    for (const NotReproduced& one : reproduction.not_reproduced) {
        html += fmt::format("<li><strong>{}</strong>: {}</li>\n", host::html_escaped(one.what),
                            host::html_escaped(one.why));
    }
    return html.empty() ? html : "<h3>Not reproduced, and why</h3>\n<ul class=\"deviations\">\n" + html + "</ul>\n";
}

std::string tables_html(std::string_view heading, std::span<const Figure> figures, Rows rows) {
    std::string html = figures.empty() ? "" : fmt::format("<h3>{}</h3>\n", heading);
    for (const FigureTable& table : figure_tables(figures)) {
        html += table_html(table, rows);
    }
    return html;
}

std::string whole_verdict(const Reproduction& reproduction) {
    const std::string figures = verdict(count_figures(reproduction.figures));
    return reproduction.checks.empty()
               ? figures
               : figures + "; " + verdict(count_figures(reproduction.checks), "checks of our own");
}

std::string verdict_html(const Reproduction& reproduction) {
    return fmt::format("<p class=\"verdict {}\">{}</p>\n", reproduction.holds() ? "held" : "broken",
                       whole_verdict(reproduction));
}

/// The link is for a reader to follow: the page itself loads nothing.
std::string source_html(const PaperSource& source) {
    if (source.citation.empty()) {
        return {};
    }
    const std::string doi = host::html_escaped(source.doi);
    return fmt::format(
        "<p class=\"source\">{} {}</p>\n", host::html_escaped(source.citation),
        doi.empty() ? "No DOI is known here." : fmt::format("<a href=\"https://doi.org/{0}\">doi:{0}</a>", doi));
}

std::string section_html(const Reproduction& reproduction) {
    const std::string name = host::html_escaped(reproduction.name);
    std::string html = fmt::format(
        "<section id=\"paper-{}\" class=\"reproduction\">\n<h2>{}</h2>\n{}<p class=\"description\">{}</p>\n{}", name,
        host::html_escaped(reproduction.title), source_html(reproduction.source),
        host::html_escaped(reproduction.summary), verdict_html(reproduction));
    html += tables_html("Figures", reproduction.figures, Rows::published);
    html += plots_html(reproduction);
    html += tables_html("Checks of our own", reproduction.checks, Rows::own);
    return html + deviations_html(reproduction) + not_reproduced_html(reproduction) + "</section>\n";
}

std::string contents_html(std::span<const Reproduction> reproductions) {
    std::string html;
    for (const Reproduction& reproduction : reproductions) {
        html += fmt::format("<li class=\"{}\"><a href=\"#paper-{}\">{}</a><span>{}</span></li>\n",
                            reproduction.holds() ? "held" : "broken", host::html_escaped(reproduction.name),
                            host::html_escaped(reproduction.title), whole_verdict(reproduction));
    }
    return html;
}

std::string plots_json(std::span<const Reproduction> reproductions) {
    host::JsonWriter json;
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
    const std::string head = host::page_head("Published figures, reproduced",
                                             {host::without_source_map(host::page_assets::dygraphs_style()),
                                              host::page_assets::report_style(), reproduction_assets::page_style()});
    const std::string contents = contents_html(reproductions);
    const std::string data = plots_json(reproductions);
    std::string sections;
    for (const Reproduction& reproduction : reproductions) {
        sections += section_html(reproduction);
    }
    return host::filled(reproduction_assets::page_template(),
                        {
                            {"head", head},
                            {"contents", contents},
                            {"sections", sections},
                            {"data", data},
                            {"charts_script", host::page_assets::charts_script()},
                            {"page_script", reproduction_assets::page_script()},
                            {"dygraphs_script", host::without_source_map(host::page_assets::dygraphs_script())},
                        });
}

}  // namespace millforce::sim
