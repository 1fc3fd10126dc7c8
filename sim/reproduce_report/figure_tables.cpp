// SPDX-License-Identifier: Apache-2.0
#include "reproduce_report/figure_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace millforce::sim {

namespace {

std::string_view common_part(const Figure& figure) {
    const std::string_view name = figure.name;
    return name.substr(0, std::min(name.find_first_of(",:"), name.size()));
}

double ratio(double part, double whole) {
    if (!std::isfinite(part)) {
        return std::numeric_limits<double>::infinity();
    }
    return whole > 0.0 ? part / whole : (part > 0.0 ? std::numeric_limits<double>::infinity() : 0.0);
}

}  // namespace

std::vector<FigureTable> figure_tables(std::span<const Figure> figures) {
    std::vector<FigureTable> tables;
    std::size_t between = 0;
    const auto close = [&](std::size_t end) {
        if (between < end) {
            tables.push_back({"", figures.subspan(between, end - between)});
        }
    };
    for (std::size_t first = 0, end = 0; first < figures.size(); first = end) {
        const std::string_view common = common_part(figures[first]);
        while (end < figures.size() && common_part(figures[end]) == common) {
            ++end;
        }
        if (end - first >= long_table_rows && common != figures[first].name) {
            close(first);
            tables.push_back({std::string(common), figures.subspan(first, end - first)});
            between = end;
        }
    }
    close(figures.size());
    return tables;
}

std::string name_in_table(const Figure& figure, const FigureTable& table) {
    const std::size_t skipped = table.title.size() + 1;
    if (!table.is_long() || figure.name.size() <= skipped) {
        return figure.name;
    }
    const std::size_t start = figure.name.find_first_not_of(' ', skipped);
    return start == std::string::npos ? figure.name : figure.name.substr(start);
}

double use_of_bound(const Figure& figure) {
    switch (figure.judged) {
        case Figure::Judged::difference:
            return ratio(std::abs(figure.ours - figure.published), figure.bound);
        case Figure::Judged::relative_difference:
            return ratio(std::abs(figure.ours / figure.published - 1.0), figure.bound);
        case Figure::Judged::at_most:
            return ratio(std::max(figure.ours, 0.0), figure.bound);
        case Figure::Judged::at_least:
            return ratio(figure.bound, figure.ours);
        case Figure::Judged::within: {
            const double half_width = 0.5 * (figure.bound - figure.bound_low);
            return ratio(std::abs(figure.ours - figure.bound_low - half_width), half_width);
        }
        case Figure::Judged::shown:
            return -1.0;
    }
    return -1.0;
}

FigureCount count_figures(std::span<const Figure> figures) {
    FigureCount count;
    for (const Figure& figure : figures) {
        ++count.all;
        count.judged += figure.judged != Figure::Judged::shown ? 1U : 0U;
        count.broken += figure.holds() ? 0U : 1U;
    }
    return count;
}

std::string verdict(const FigureCount& count, std::string_view counted) {
    const std::string shown =
        count.judged == count.all ? std::string() : fmt::format(", {} shown without one", count.all - count.judged);
    const std::string broken = count.broken == 0 ? std::string() : fmt::format(", {} BROKEN", count.broken);
    return fmt::format("{} {}, {} within their bound{}{}", count.all, counted, count.judged - count.broken, broken,
                       shown);
}

std::string value_text(double value) {
    if (!std::isfinite(value)) {
        return "–";
    }
    const double size = std::abs(value);
    if (size >= 1000.0 && size < 1e7) {
        return fmt::format("{:.0f}", value);
    }
    return size < 1e-3 ? fmt::format("{:.2g}", value) : fmt::format("{:.4g}", value);
}

}  // namespace millforce::sim
