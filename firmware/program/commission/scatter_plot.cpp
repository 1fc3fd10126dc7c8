// SPDX-License-Identifier: Apache-2.0
#include "commission/scatter_plot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/page_template.hpp"

namespace millforce::host {

namespace {

constexpr double width = 520.0;
constexpr double height = 300.0;
constexpr double left = 60.0;
constexpr double bottom = 45.0;
constexpr double top = 30.0;

/// Values from `low` to `high` on `length` pixels.
struct Scale {
    double low = 0.0;
    double high = 0.0;
    double start = 0.0;
    double length = 0.0;

    void include(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    [[nodiscard]] double at(double value) const { return start + length * (value - low) / std::max(high - low, 1e-12); }
};

}  // namespace

std::string plot_html(const ScatterPlot& plot) {
    Scale x{0.0, 0.0, left, width - left - 20.0};
    Scale y{0.0, 0.0, height - bottom, -(height - bottom - top)};  // both with 0
    for (const auto* series : {&plot.points, &plot.line}) {
        for (const auto& [px, py] : *series) {
            x.include(px);
            y.include(py);
        }
    }
    std::string text = fmt::format(
        "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" aria-label=\"{2}\">\n"
        "<text x=\"{3}\" y=\"18\" fill=\"currentColor\">{2}</text>\n",
        width, height, html_escaped(plot.title), left);
    text +=
        fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}M{:.1f} {:.1f}V{:.1f}\" stroke=\"currentColor\" fill=\"none\"/>\n",
                    x.at(x.low), y.at(0.0), x.at(x.high), x.at(0.0), y.at(y.low), y.at(y.high));
    const auto label = [&](double px, double py, const char* anchor, const std::string& words) {
        text += fmt::format(
            "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"12\" fill=\"currentColor\">{}</text>\n", px,
            py, anchor, html_escaped(words));
    };
    label(x.at(x.high), height - 8.0, "end", plot.x_label);
    label(x.at(x.low), height - bottom + 16.0, "start", fmt::format("{:.4g}", x.low));
    label(x.at(x.high), height - bottom + 16.0, "end", fmt::format("{:.4g}", x.high));
    label(left - 6.0, y.at(y.low), "end", fmt::format("{:.3g}", y.low));
    label(left - 6.0, y.at(y.high) + 10.0, "end", fmt::format("{:.3g}", y.high));
    label(width - 20.0, 18.0, "end", plot.y_label);
    if (plot.line.size() > 1) {
        std::string points;
        for (const auto& [px, py] : plot.line) {
            points += fmt::format("{:.1f},{:.1f} ", x.at(px), y.at(py));
        }
        text += fmt::format("<polyline points=\"{}\" stroke=\"var(--compared)\" fill=\"none\"/>\n", points);
    }
    for (const auto& [px, py] : plot.points) {
        text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"var(--controlled)\"/>\n", x.at(px),
                            y.at(py));
    }
    return text + "</svg>\n";
}

}  // namespace millforce::host
