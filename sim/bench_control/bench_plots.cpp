// SPDX-License-Identifier: Apache-2.0
#include "bench_control/bench_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "files/csv.hpp"
#include "report/page_template.hpp"

namespace millforce::sim {

namespace {

constexpr double plot_width = 760.0;
constexpr double plot_left = 250.0;
constexpr double plot_right = 42.0;
constexpr double plot_top = 56.0;
constexpr double row_height = 24.0;
constexpr const char* ink = "#808080";
constexpr const char* ours_colour = "#2f7fd0";
constexpr const char* rival_colour = "#c9731a";
constexpr const char* other_colour = "#3fa37c";

std::string ratio_words(double value) {
    return std::isinf(value) ? "∞" : fmt::format("{:.1f}", value);
}

std::string percent_words(double value) {
    return fmt::format("{:.0f} %", 100.0 * value);
}

std::string colour_of(const Contender& contender) {
    return contender.kind == Contender::Kind::ours ? ours_colour : rival_colour;
}

/// Rows of names on the left, a common scale above. What is beyond it stands at its end, a mark as an arrow with its
/// number.
class RowPlot {
  public:
    /// `words`: of a value, as the scale has it.
    RowPlot(std::string title, double low, double high, std::size_t rows, std::string (*words)(double))
        : title_(std::move(title)),
          low_(low),
          high_(high),
          words_(words),
          height_(plot_top + row_height * static_cast<double>(rows) + 30.0) {
        text(plot_left, 18.0, "start", title_);
    }

    [[nodiscard]] double x(double value) const {
        return plot_left +
               (plot_width - plot_left - plot_right) * (std::clamp(value, low_, high_) - low_) / (high_ - low_);
    }
    [[nodiscard]] static double y(std::size_t row) { return plot_top + row_height * (static_cast<double>(row) + 0.5); }

    void tick(double value) {
        line(x(value), plot_top - 4.0, x(value), height_ - 26.0, 0.6, ink, 0.4);
        text(x(value), plot_top - 9.0, "middle", words_(value));
    }
    void reference(double value) { line(x(value), plot_top - 4.0, x(value), height_ - 26.0, 1.6, ink, 1.0); }
    void name(std::size_t row, const std::string& words) { text(plot_left - 10.0, y(row) + 4.0, "end", words); }
    void bar(std::size_t row, double from, double to, double thickness, const std::string& colour) {
        line(x(from), y(row), std::max(x(to), x(from) + 0.5), y(row), thickness, colour, thickness > 4.0 ? 0.55 : 1.0);
    }
    void mark(std::size_t row, double value, const std::string& colour) {
        if (value > high_) {
            svg_ += fmt::format("<path d=\"M{0:.1f} {1:.1f}v10l7 -5z\" fill=\"{2}\"/>\n", x(value) - 4.0, y(row) - 5.0,
                                colour);
            text(plot_width, y(row) + 4.0, "end", words_(value));
            return;
        }
        svg_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", x(value), y(row), colour);
    }
    void note(const std::string& words) { text(plot_left, height_ - 8.0, "start", words); }
    void legend(std::size_t place, const std::string& words, const std::string& colour) {
        const double at = plot_left + 125.0 * static_cast<double>(place);
        svg_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", at, height_ - 12.0, colour);
        text(at + 8.0, height_ - 8.0, "start", words);
    }

    [[nodiscard]] std::string finished() const {
        return fmt::format(
                   "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1:.0f}\" width=\"{0}\" "
                   "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\" role=\"img\" aria-label=\"{2}\">\n",
                   plot_width, height_, host::html_escaped(title_)) +
               svg_ + "</svg>\n";
    }

  private:
    void line(double x1, double y1, double x2, double y2, double thickness, const std::string& colour, double opacity) {
        svg_ += fmt::format(
            "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{}\" "
            "stroke-opacity=\"{}\"/>\n",
            x1, y1, x2, y2, colour, thickness, opacity);
    }
    void text(double at_x, double at_y, const char* anchor, const std::string& words) {
        svg_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", at_x, at_y,
                            anchor, ink, host::html_escaped(words));
    }

    std::string title_;
    double low_;
    double high_;
    std::string (*words_)(double);
    double height_;
    std::string svg_;
};

/// Thin: 5 to 95 %; thick: the middle half; a dot: the median.
void spread(RowPlot& plot, std::size_t row, const std::vector<double>& values, const std::string& colour) {
    if (values.empty()) {
        return;
    }
    plot.bar(row, quantile(values, 0.05), quantile(values, 0.95), 2.0, colour);
    plot.bar(row, quantile(values, 0.25), quantile(values, 0.75), 10.0, colour);
    plot.mark(row, quantile(values, 0.5), colour);
}

std::vector<ContenderFigures> without_bound(const std::vector<ContenderFigures>& contenders) {
    std::vector<ContenderFigures> rest;
    std::ranges::copy_if(contenders, std::back_inserter(rest), [](const ContenderFigures& figures) {
        return figures.contender->kind != Contender::Kind::bound;
    });
    return rest;
}

constexpr const char* spread_note = "dot: median; thick: middle half of the runs; thin: 5 to 95 %";

BenchPlot time_plot(const std::vector<ContenderFigures>& contenders) {
    RowPlot plot("Time over the clairvoyant bound", 1.0, 4.0, contenders.size(), ratio_words);
    for (const double value : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0}) {
        plot.tick(value);
    }
    for (std::size_t row = 0; row < contenders.size(); ++row) {
        plot.name(row, std::string(contenders[row].contender->title));
        spread(plot, row, contenders[row].times_over_bound, colour_of(*contenders[row].contender));
    }
    plot.note(spread_note);
    return {"time_over_bound.svg", "Time over the clairvoyant bound", plot.finished()};
}

BenchPlot peak_plot(const std::vector<ContenderFigures>& contenders) {
    RowPlot plot("Largest force on a tooth, % of its limit", 0.3, 1.6, contenders.size(), percent_words);
    for (const double value : {0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6}) {
        plot.tick(value);
    }
    plot.reference(1.0);
    for (std::size_t row = 0; row < contenders.size(); ++row) {
        plot.name(row, std::string(contenders[row].contender->title));
        spread(plot, row, contenders[row].peaks, colour_of(*contenders[row].contender));
    }
    plot.note(spread_note);
    return {"peak_force.svg", "Largest force on a tooth", plot.finished()};
}

/// NaN where none was milled.
double fastest_rival(const PartFigures& part, const std::vector<ContenderFigures>& contenders) {
    double fastest = host::no_estimate;
    for (std::size_t k = 0; k < contenders.size(); ++k) {
        const Contender& contender = *contenders[k].contender;
        if (contender.kind == Contender::Kind::rival && contender.name != "constant" &&
            !(part.times_over_bound[k] >= fastest)) {
            fastest = part.times_over_bound[k];
        }
    }
    return fastest;
}

double time_of(std::string_view name, const PartFigures& part, const std::vector<ContenderFigures>& contenders) {
    for (std::size_t k = 0; k < contenders.size(); ++k) {
        if (contenders[k].contender->name == name) {
            return part.times_over_bound[k];
        }
    }
    return host::no_estimate;
}

BenchPlot part_plot(const std::vector<ContenderFigures>& contenders, const std::vector<PartFigures>& parts) {
    RowPlot plot("Median time over the bound, by part", 1.0, 4.0, parts.size(), ratio_words);
    for (const double value : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0}) {
        plot.tick(value);
    }
    const auto mark = [&](std::size_t row, double value, const char* colour) {
        if (!std::isnan(value)) {
            plot.mark(row, value, colour);
        }
    };
    for (std::size_t row = 0; row < parts.size(); ++row) {
        plot.name(row, parts[row].part);
        mark(row, time_of("constant_safe", parts[row], contenders), ink);
        mark(row, fastest_rival(parts[row], contenders), rival_colour);
        mark(row, time_of("ours", parts[row], contenders), other_colour);
        mark(row, time_of("ours_map", parts[row], contenders), ours_colour);
    }
    plot.legend(0, "with a map", ours_colour);
    plot.legend(1, "without a map", other_colour);
    plot.legend(2, "fastest rival", rival_colour);
    plot.legend(3, "safe constant", ink);
    return {"time_by_part.svg", "Median time over the bound, by part", plot.finished()};
}

}  // namespace

std::vector<BenchPlot> bench_plots(const std::vector<ContenderFigures>& contenders,
                                   const std::vector<PartFigures>& parts) {
    const std::vector<ContenderFigures> shown = without_bound(contenders);
    return {time_plot(shown), peak_plot(shown), part_plot(contenders, parts)};
}

}  // namespace millforce::sim
