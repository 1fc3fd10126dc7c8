// SPDX-License-Identifier: Apache-2.0
#include "bench_control/bench_page.hpp"

#include <fmt/format.h>

#include "bench_control/bench_assets.hpp"
#include "bench_control/text_file.hpp"
#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"

namespace millforce::sim {

namespace {

std::string table_html(const BenchTable& table) {
    std::string html = "<table class=\"comparison\">\n<thead><tr>";
    for (const std::string& cell : table.head) {
        html += fmt::format("<th scope=\"col\">{}</th>", host::html_escaped(cell));
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
        html += fmt::format("<tr><th scope=\"row\">{}</th>", host::html_escaped(row.front()));
        for (std::size_t k = 1; k < row.size(); ++k) {
            html += fmt::format("<td>{}</td>", host::html_escaped(row[k]));
        }
        html += "</tr>\n";
    }
    return html + "</tbody>\n</table>\n";
}

std::string facts_html(const host::Facts& facts) {
    std::string html;
    for (const auto& [name, value] : facts) {
        html += host::fact_html(name, value);
    }
    return html;
}

}  // namespace

void write_bench_page(const std::filesystem::path& folder, const std::vector<BenchRun>& runs,
                      const host::Facts& origin) {
    const std::vector<ContenderFigures> figures = figures_of_runs(runs);
    const std::vector<PartFigures> parts = figures_of_parts(runs, figures);
    std::string plots;
    for (const BenchPlot& plot : bench_plots(figures, parts)) {
        write_text_file(folder / plot.file_name, "<!-- SPDX-License-Identifier: Apache-2.0 -->\n" + plot.svg);
        plots += "<figure>\n" + plot.svg + "</figure>\n";
    }
    const std::string table = table_html(table_of(figures));
    const std::string part_table = table_html(table_of_parts(parts, figures));
    const std::string facts = facts_html(origin);
    // Many columns: they scroll on a narrow screen, with the row's name in view.
    constexpr std::string_view own_style = R"(
.comparison { border-collapse: collapse; font-size: 15px; font-variant-numeric: tabular-nums; }
.comparison th, .comparison td { padding: 4px 0 4px 16px; text-align: right; vertical-align: bottom;
  border-bottom: 1px solid var(--line); }
.comparison td { white-space: nowrap; }
.comparison th:first-child { position: sticky; left: 0; min-width: 8em; padding-left: 0; text-align: left;
  font-weight: 500; background: var(--page); }
figure { margin: 0 0 16px; overflow-x: auto; }
svg { max-width: 100%; min-width: 600px; height: auto; }
svg text { fill: var(--muted); }
)";
    const std::string head =
        host::page_head("Feed controllers compared", {host::page_assets::report_style(), own_style});
    write_text_file(folder / "bench.html", host::filled(bench_assets::page_template(), {
                                                                                           {"head", head},
                                                                                           {"facts", facts},
                                                                                           {"table", table},
                                                                                           {"plots", plots},
                                                                                           {"part_table", part_table},
                                                                                       }));
}

}  // namespace millforce::sim
