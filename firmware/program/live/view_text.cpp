// SPDX-License-Identifier: Apache-2.0
#include "live/view_text.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>

#include "control/cut_state.hpp"
#include "estimation/engagement/side_choice.hpp"
#include "files/printable.hpp"

namespace millforce::host {

namespace {

constexpr std::size_t most_events = 100;
constexpr std::size_t label_columns = 11;
constexpr std::size_t value_columns = 27;
constexpr double stale_after_s = 1.0;

constexpr std::array<const char*, control::state_count> state_words{
    "in air: no contact",   "entering the cut",       "in the cut", "leaving the cut, or a gap in it",
    "no estimate, or held", "fault: held until reset"};

std::string in_words(std::string_view name) {
    std::string text(name);
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
}

/// A terminal may count the columns of other letters differently.
std::string in_ascii(std::string_view text) {
    std::string result = without_controls(text);
    std::replace_if(
        result.begin(), result.end(), [](char letter) { return static_cast<unsigned char>(letter) >= 0x80; }, '?');
    return result;
}

/// Marks that a line is drawn with.
struct Marks {
    const char* full;
    const char* uncertain;
    const char* empty;
    const char* threshold;
    const char* plus_minus;
};
constexpr Marks unicode_marks{"█", "▒", "·", "│", "±"};
constexpr Marks ascii_marks{"#", "=", ".", "|", "+-"};

/// A line that counts its columns.
class Line {
  public:
    explicit Line(std::size_t columns) : columns_(columns) {}

    void put(std::string_view ascii) {
        const std::size_t count = std::min(ascii.size(), columns_ - used_);
        text_.append(ascii.substr(0, count));
        used_ += count;
    }
    /// One character of several bytes, or several of ASCII.
    void mark(const char* mark) {
        const bool is_ascii = static_cast<unsigned char>(mark[0]) < 0x80;
        if (is_ascii) {
            put(mark);
        } else if (used_ < columns_) {
            text_ += mark;
            ++used_;
        }
    }
    void fill_to(std::size_t column) {
        while (used_ < std::min(column, columns_)) {
            put(" ");
        }
    }
    [[nodiscard]] std::size_t left() const { return columns_ - used_; }
    [[nodiscard]] std::string text() const { return text_; }

  private:
    std::size_t columns_;
    std::size_t used_ = 0;
    std::string text_{};
};

/// Shares of the bar's length.
struct Bar {
    float low = 0.0F;
    float high = 0.0F;
    float threshold = -1.0F;  ///< < 0: none
};

void draw_bar(Line& line, const Bar& bar, const Marks& marks) {
    const std::size_t cells = line.left();
    const bool has_threshold = bar.threshold >= 0.0F && cells > 0;
    const std::size_t threshold =
        has_threshold ? std::min(static_cast<std::size_t>(bar.threshold * static_cast<float>(cells)), cells - 1) : 0;
    for (std::size_t k = 0; k < cells; ++k) {
        const float middle = (static_cast<float>(k) + 0.5F) / static_cast<float>(cells);
        const bool is_threshold = has_threshold && k == threshold;
        const char* fill = middle < bar.low ? marks.full : middle < bar.high ? marks.uncertain : marks.empty;
        line.mark(is_threshold ? marks.threshold : fill);
    }
}

class View {
  public:
    View(const ViewState& state, const ViewSize& size)
        : state_(state), size_(size), marks_(size.has_unicode ? unicode_marks : ascii_marks) {}

    std::vector<std::string> lines() {
        add_head();
        if (state_.newest) {
            add_state();
            add_load();
            add_override();
            add_estimates();
            add_program();
            add_conditions();
        }
        add_events();
        lines_.resize(std::min(lines_.size(), size_.rows));
        return std::move(lines_);
    }

  private:
    [[nodiscard]] Line line() const { return Line(size_.columns); }
    void add(const Line& line) { lines_.push_back(line.text()); }
    void add_text(std::string_view text) {
        Line text_line = line();
        text_line.put(text);
        add(text_line);
    }
    [[nodiscard]] Line labelled(std::string_view label) const {
        Line labelled_line = line();
        labelled_line.put(label);
        labelled_line.fill_to(label_columns);
        return labelled_line;
    }
    void end_value(Line& line) const { line.fill_to(label_columns + value_columns); }
    void add_labelled(std::string_view label, std::string_view text) {
        Line text_line = labelled(label);
        text_line.put(text);
        add(text_line);
    }

    void add_head() {
        const std::string age = !state_.newest                 ? "waiting for samples"
                                : state_.age_s > stale_after_s ? fmt::format("no tick for {:.0f} s", state_.age_s)
                                                               : "";
        const std::string clock = state_.newest ? fmt::format("{:.1f} s", state_.newest->time_s) : std::string();
        add_text(fmt::format("millforce  {}  {}  {}", in_ascii(printable(state_.title)), clock, age));
        add_text("");
    }
    void add_state() {
        const hal::FeedOverride& out = tick().feed_override;
        std::string text = state_words[out.state % control::state_count];
        if (out.fault != 0) {
            text += fmt::format(" ({})", in_words(control::name(static_cast<control::Fault>(out.fault))));
        }
        add_labelled("state", text);
        add_labelled("limit", in_words(control::name(static_cast<control::Limit>(tick().limit))));
    }
    void add_load() {
        const firmware::ShownForces& shown = state_.newest->shown;
        Line load = labelled("load");
        if (!std::isfinite(shown.peak_N) || !std::isfinite(shown.limit_N) || !(shown.limit_N > 0.0F)) {
            load.put("no estimate");
        } else {
            constexpr float end_of_bar = 1.25F;
            const float share = shown.peak_N / shown.limit_N;
            load.put(fmt::format("{:.0f} N of {:.0f} N, {:.0f} %", shown.peak_N, shown.limit_N, 100.0F * share));
            end_value(load);
            draw_bar(load, {share / end_of_bar, share / end_of_bar, 1.0F / end_of_bar}, marks_);
        }
        add(load);
    }
    void add_override() {
        const float ratio = tick().feed_override.ratio;
        const float end_of_bar = ratio > 1.0F ? 2.0F : 1.0F;
        Line text = labelled("override");
        text.put(fmt::format("{:.0f} %{}", 100.0F * ratio, state_.newest->sample.is_held ? ", HOLD" : ""));
        end_value(text);
        draw_bar(text, {ratio / end_of_bar, ratio / end_of_bar}, marks_);
        add(text);
    }
    void add_estimates() {
        add_estimate("immersion", tick().radial_immersion, tick().radial_immersion_sd, {2, ""}, 2.0F);
        add_estimate("depth", tick().axial_depth_mm, tick().axial_depth_sd_mm, {1, " mm"}, depth_scale_mm());
    }
    struct Shown {
        int digits;
        const char* unit;
    };
    void add_estimate(const char* label, float value, float sd, const Shown& shown, float end_of_bar) {
        Line text = labelled(label);
        if (!std::isfinite(value)) {
            text.put("no estimate");
        } else {
            const float half = std::isfinite(sd) ? estimation::deviations_of_95_percent<float> * sd : 0.0F;
            text.put(fmt::format("{:.{}f} ", value, shown.digits));
            text.mark(marks_.plus_minus);
            text.put(fmt::format(" {:.{}f}{} (95 %)", half, shown.digits, shown.unit));
            end_value(text);
            draw_bar(text, {(value - half) / end_of_bar, (value + half) / end_of_bar}, marks_);
        }
        add(text);
    }
    [[nodiscard]] float depth_scale_mm() const {
        for (const float scale_mm : {1.0F, 2.0F, 5.0F, 10.0F, 20.0F, 50.0F, 100.0F}) {
            if (state_.deepest_mm <= scale_mm) {
                return scale_mm;
            }
        }
        return 200.0F;
    }
    void add_program() {
        const hal::ProgramStatus& program = state_.newest->sample.program;
        std::string text = program.programmed_feed_mm_s > 0.0F
                               ? fmt::format("F {:.0f} mm/min", 60.0F * program.programmed_feed_mm_s)
                               : "F not known";
        text += fmt::format(", operator {:.0f} %", 100.0F * program.operator_override);
        text += program.line != 0 ? fmt::format(", line {}", program.line) : "";
        text += state_.newest->sample.tool != 0 ? fmt::format(", tool {}", state_.newest->sample.tool) : "";
        text += program.rapid ? ", rapid" : "";
        text += program.feed_hold ? ", feed hold" : "";
        add_labelled("program", text);
    }
    void add_conditions() {
        std::string text;
        for (std::size_t k = 0; k < firmware::condition_count; ++k) {
            if (const auto condition = static_cast<firmware::Condition>(k);
                state_.newest->sample.conditions.has(condition)) {
                text += (text.empty() ? "" : ", ") + in_words(firmware::name(condition));
            }
        }
        add_labelled("conditions", text.empty() ? "none" : text);
        if (state_.newest->lost > 0) {
            add_text(fmt::format("{} ticks were not shown: this view was too slow", state_.newest->lost));
        }
    }
    void add_events() {
        add_text("");
        for (const ViewEvent& event : state_.events) {
            if (lines_.size() >= size_.rows) {
                return;
            }
            const auto time_s = static_cast<std::time_t>(event.unix_us / 1'000'000);
            add_text(fmt::format("{:%H:%M:%S}  {}", fmt::localtime(time_s), event.text));
        }
    }
    [[nodiscard]] const firmware::TickRecord& tick() const { return state_.newest->sample.tick; }

    const ViewState& state_;
    const ViewSize& size_;
    const Marks& marks_;
    std::vector<std::string> lines_{};
};

bool is_same(const ViewEvent& event, std::uint64_t unix_us, const std::string& text) {
    constexpr std::uint64_t second_us = 1'000'000;
    return unix_us < event.unix_us + second_us && (event.text.ends_with(text) || text.ends_with(event.text));
}

}  // namespace

void ViewState::take(const Telemetry& telemetry) {
    newest = telemetry;
    if (telemetry.sample.tick.axial_depth_mm > deepest_mm) {
        deepest_mm = telemetry.sample.tick.axial_depth_mm;
    }
}

void ViewState::add_event(std::uint64_t unix_us, const std::string& text) {
    constexpr std::size_t few = 3;
    const std::string shown = in_ascii(text);
    const auto end = events.begin() + static_cast<std::ptrdiff_t>(std::min(few, events.size()));
    if (std::any_of(events.begin(), end, [&](const ViewEvent& event) { return is_same(event, unix_us, shown); })) {
        return;
    }
    events.push_front({unix_us, shown});
    if (events.size() > most_events) {
        events.pop_back();
    }
}

std::vector<std::string> view_lines(const ViewState& state, const ViewSize& size) {
    return View(state, size).lines();
}

}  // namespace millforce::host
