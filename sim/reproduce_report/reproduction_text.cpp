// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report/reproduction_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "reproduce_report/figure_tables.hpp"

namespace millforce::sim {

namespace {

constexpr std::size_t name_width = 44;
constexpr std::size_t page_width = 99;
constexpr std::string_view row_form = "{:<44} {:>9} {:>9} {:<4} {:>10} {:>11} {:>6}";  // 99 columns

/// Columns on a terminal: code points, which is right for all letters and signs that the names use.
std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

/// Lines of at most `width` columns; those after the first are indented by two more columns.
std::vector<std::string> wrapped(std::string_view text, std::size_t width, std::size_t indent) {
    std::vector<std::string> lines{std::string(indent, ' ')};
    bool line_is_empty = true;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, end);
        if (!line_is_empty && width_of(lines.back()) + 1 + width_of(word) > width) {
            lines.emplace_back(indent + 2, ' ');
            line_is_empty = true;
        }
        lines.back() += line_is_empty ? "" : " ";
        lines.back() += word;
        line_is_empty = false;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

template <typename... Cells>
std::string row_text(const Cells&... cells) {
    const std::string text = fmt::format(row_form, cells...);
    return text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
}

std::string paragraph(std::string_view text, std::size_t indent) {
    return fmt::format("{}\n", fmt::join(wrapped(text, page_width, indent), "\n"));
}

std::string figure_text(const Figure& figure, const std::string& name, std::size_t indent) {
    const bool is_shown = figure.judged == Figure::Judged::shown;
    constexpr std::size_t unit_width = 4;
    const bool is_long_unit = width_of(figure.unit) > unit_width;
    const std::vector<std::string> lines =
        wrapped(is_long_unit ? fmt::format("{} in {}", name, figure.unit) : name, name_width, indent);
    std::string text = row_text(lines.front(), std::isfinite(figure.published) ? value_text(figure.published) : "",
                                value_text(figure.ours), is_long_unit ? "" : figure.unit, figure.difference(),
                                figure.bound_text(), is_shown ? "" : (figure.holds() ? "ok" : "BROKEN"));
    for (std::size_t k = 1; k < lines.size(); ++k) {
        text += lines[k] + '\n';
    }
    return figure.reason.empty() ? text : text + paragraph("reason: " + figure.reason, indent + 2);
}

std::string short_table_text(const FigureTable& table) {
    const auto nearest =
        std::max_element(table.figures.begin(), table.figures.end(),
                         [](const Figure& a, const Figure& b) { return use_of_bound(a) < use_of_bound(b); });
    const FigureCount count = count_figures(table.figures);
    std::string text;
    if (count.broken == 0) {
        text += fmt::format("{}: {}; the nearest to its bound:\n", table.title, verdict(count));
        return text + figure_text(*nearest, name_in_table(*nearest, table), 2);
    }
    text += fmt::format("{}: {}:\n", table.title, verdict(count));
    for (const Figure& figure : table.figures) {
        text += figure.holds() ? "" : figure_text(figure, name_in_table(figure, table), 2);
    }
    return text;
}

std::string figures_text(std::span<const Figure> figures, bool every_row) {
    std::string text;
    for (const FigureTable& table : figure_tables(figures)) {
        if (table.is_long() && !every_row) {
            text += short_table_text(table);
            continue;
        }
        for (const Figure& figure : table.figures) {
            text += figure_text(figure, figure.name, 0);
        }
    }
    return text;
}

std::string source_text(const PaperSource& source) {
    const std::string doi = source.doi.empty() ? "" : " doi:" + source.doi;
    return source.citation.empty() ? "" : paragraph(source.citation + doi, 2);
}

std::string not_reproduced_text(const std::vector<NotReproduced>& list) {
    std::string text = list.empty() ? "" : "\nnot reproduced\n";
    for (const NotReproduced& one : list) {
        text += paragraph(one.what + ": " + one.why, 2);
    }
    return text;
}

}  // namespace

std::string reproduction_text(const Reproduction& reproduction, bool every_row) {
    std::string text =
        paragraph(reproduction.name + ": " + reproduction.title, 0) + source_text(reproduction.source) + '\n';
    text += row_text("figure", "paper", "ours", "", "difference", "bound", "");
    text += figures_text(reproduction.figures, every_row);
    if (!reproduction.checks.empty()) {
        text += '\n' + row_text("checks of our own", "", "ours", "", "", "bound", "");
        text += figures_text(reproduction.checks, every_row);
    }
    text += not_reproduced_text(reproduction.not_reproduced);
    text += fmt::format("\n{}: {}\n", reproduction.name, verdict(count_figures(reproduction.figures)));
    if (!reproduction.checks.empty()) {
        text += fmt::format("{}: {}\n", reproduction.name,
                            verdict(count_figures(reproduction.checks), "checks of our own"));
    }
    return text;
}

}  // namespace millforce::sim
