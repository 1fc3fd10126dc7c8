// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "report/page_assets.hpp"
#include "report/page_parts.hpp"
#include "report/page_template.hpp"
#include "run_report/run_page_assets.hpp"
#include "run_report/run_words.hpp"

namespace millforce::host {

namespace {

using control::CutState;
using control::Limit;

std::string percent(float share) {
    return fmt::format("{:.0f} %", 100.0 * static_cast<double>(share));
}

std::string above_words(const RunPeak& peak, const char* verb) {
    return peak.over_limit_s > 0.0 ? fmt::format(", and {} above it for {:.2f} s", verb, peak.over_limit_s) : "";
}

std::string load_words(const RunTotals& totals) {
    const RunPeak& peak = totals.peak;
    const RunPeak& bound = totals.bound;
    const bool has_bound = !std::isnan(bound.share) && !(bound.share <= peak.share);
    std::string words;
    if (!std::isnan(peak.share)) {
        words = fmt::format("The load on one tooth reached {} of its limit at {}, as estimated{}. ",
                            percent(peak.share), readable_time(peak.time_s), above_words(peak, "was"));
    }
    if (has_bound) {
        words += fmt::format("{} {} of its limit{}. ",
                             words.empty() ? "How the tool was engaged was not known: the load on one tooth was at most"
                                           : "While it was not known how the tool was engaged, the load was at most",
                             percent(bound.share), above_words(bound, "can have been"));
    }
    return words.empty() ? "The forces gave no load of a tooth to compare with its limit. " : words;
}

std::string ceiling_words(const RunTotals& totals, const RunOrigin& origin) {
    const std::vector<Limit> ceilings = totals.ceilings.longest_first();
    if (origin.is_monitor_only) {
        return "The tool's file says monitor_only: the feed was the operator's. ";
    }
    const Limit first = ceilings.empty() ? Limit::none : ceilings.front();
    const double share = share_of(totals.ceilings.in_cut(first), totals.ceilings.cut_s);
    return fmt::format("For {} of the cut the ceiling on the feed was: {}. ", readable_share(share),
                       words_of(first).label);
}

std::string fault_words(const RunHistory& history) {
    const std::vector<RunEvent> events = history.events();
    const auto fault = std::find_if(events.begin(), events.end(), [](const RunEvent& event) { return event.is_fault; });
    return fault == events.end()
               ? std::string("There was no fault.")
               : fmt::format("<strong class=\"fault\">{}, at {}.</strong>",
                             html_escaped(fault->text.substr(0, fault->text.find(':'))), readable_time(fault->time_s));
}

std::string verdict_html(const RunHistory& history, const RunOrigin& origin) {
    const RunTotals& totals = history.totals();
    if (history.is_empty()) {
        return "No complete sample of the drives came, so there is nothing to show.";
    }
    if (!(totals.ceilings.cut_s > 0.0)) {
        return fmt::format("In {} no cut was seen. ", readable_time(totals.length_s)) + fault_words(history);
    }
    return fmt::format("The tool was in the cut for {} of {}. ", readable_time(totals.ceilings.cut_s, totals.length_s),
                       readable_time(totals.length_s)) +
           load_words(totals) + ceiling_words(totals, origin) + fault_words(history) +
           (origin.is_replay
                ? " This is a replay: the override is the one that the controller would have sent, and the "
                  "recorded cut did not obey it."
                : "");
}

/// Single estimates scatter: one above the limit is not yet a tooth above it.
const char* style_of_load(const RunTotals& totals, float share) {
    constexpr double scatter_share = 0.01;
    if (!(share > 1.0F)) {
        return "hero held";
    }
    const bool has_fault = totals.in_state_s[static_cast<std::size_t>(CutState::fault)] > 0.0;
    const bool stays_above = totals.peak.over_limit_s > scatter_share * totals.ceilings.cut_s;
    return has_fault || stays_above ? "hero over" : "hero";
}

std::string stats_html(const RunTotals& totals, const RunOrigin& origin) {
    if (!(totals.ceilings.cut_s > 0.0)) {
        return {};
    }
    const bool is_known = !std::isnan(totals.peak.share);
    const float share = is_known ? totals.peak.share : totals.bound.share;
    return stat_html(style_of_load(totals, share), std::isnan(share) ? "–" : percent(share),
                     is_known ? "of its limit: the largest load on one tooth, as estimated from the currents"
                              : "of its limit at most: the largest load on one tooth, by the currents") +
           stat_html("", fmt::format("{:.0f} %", 100.0 * totals.override_ratio.mean()),
                     origin.is_replay
                         ? "of the programmed feed: what the controller would have sent in the cut, on average"
                         : "of the programmed feed: the override in the cut, on average") +
           stat_html("", readable_time(totals.ceilings.cut_s), "in the cut");
}

std::string runout_words(const RunRunout& runout) {
    const std::string stated = fmt::format("{:.0f} µm by its file", runout.stated_um);
    if (runout.is_shown()) {
        return fmt::format("{:.0f} µm at most, as the cut showed; {}", runout.shown_um, stated);
    }
    return stated + (runout.stated_um > 0.0F ? "; no cut showed it" : ", and so not measured");
}

/// Of one tool, or of those of a folder whose runout a cut has shown.
std::string runout_fact(const RunHistory& history) {
    std::string words;
    for (const auto& [number, runout] : history.runouts()) {
        if (number == 0) {
            words = runout_words(runout);
        } else if (runout.is_shown()) {
            words += fmt::format("{}T{}: {}", words.empty() ? "" : "; ", number, runout_words(runout));
        }
    }
    return words;
}

std::string facts_html(const RunHistory& history, const RunOrigin& origin) {
    const RunTotals& totals = history.totals();
    std::string out;
    for (const auto& [name, value] : origin.facts) {
        out += fact_html(name, value);
    }
    out += fact_html("Runout of the tool (runout_um)", runout_fact(history));
    out += fact_html("Length", readable_time(totals.length_s));
    out += fact_html("Feed held for", readable_time(totals.hold_s));
    out += fact_html("Samples", fmt::to_string(totals.ticks));
    out += fact_html("Time without samples", totals.missing_s > 0.0 ? readable_time(totals.missing_s) : "");
    return out + fact_html("Samples missing on this page", history.lost() > 0 ? fmt::to_string(history.lost()) : "");
}

std::string states_html(const RunTotals& totals) {
    std::string out =
        "<table class=\"figures\" style=\"--values: 1\">\n<thead><tr><th scope=\"col\">State</th><th "
        "scope=\"col\">of all time</th><th scope=\"col\" class=\"explanation\">What it is</th></tr></thead>\n<tbody>\n";
    for (unsigned k = 0; k < control::state_count; ++k) {
        if (!(totals.in_state_s[k] > 0.0)) {
            continue;
        }
        const auto state = static_cast<CutState>(k);
        std::string name = control::name(state);
        std::replace(name.begin(), name.end(), '_', ' ');
        out += fmt::format(
            "<tr><th scope=\"row\"><span class=\"swatch\" style=\"background: var(--state-{})\"></span>{}</th>"
            "<td>{}<small>{}</small></td><td class=\"explanation\">{}</td></tr>\n",
            control::name(state), name, readable_share(share_of(totals.in_state_s[k], totals.ceilings.all_s)),
            readable_time(totals.in_state_s[k]), meaning_of(state));
    }
    return out + "</tbody>\n</table>\n";
}

/// `unit`: with the blank before it.
std::string mean_words(const RunMean& mean, const RunTotals& totals, const char* unit) {
    if (!(mean.known_s > 0.0)) {
        return "In this run it was never known.";
    }
    return fmt::format("In this run it was known in {} of the cut, and was {:.2f}{} on average.",
                       readable_share(share_of(mean.known_s, totals.ceilings.cut_s)), mean.mean(), unit);
}

/// Alike in all of a list: in a long run as hours, minutes and seconds.
std::string time_of_event(double time_s, double length_s) {
    constexpr double long_s = 600.0;
    if (length_s < long_s) {
        return fmt::format("{:.2f} s", time_s);
    }
    const auto seconds = static_cast<std::int64_t>(time_s);
    return fmt::format("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
}

std::string events_html(const RunHistory& history) {
    const std::vector<RunEvent> events = history.events();
    if (events.empty()) {
        return "<p>Nothing that needs a word: no fault, and nothing wrong with the signals.</p>\n";
    }
    std::string out = "<ol class=\"events\">\n";
    for (const RunEvent& event : events) {
        out += fmt::format("<li{}><span class=\"when\">{}</span><span>{}</span></li>\n",
                           event.is_fault ? " class=\"fault\"" : "",
                           time_of_event(event.time_s, history.totals().length_s), html_escaped(event.text));
    }
    out += "</ol>\n";
    return history.events_left_out() == 0
               ? out
               : out + fmt::format("<p>{} more before the last one are left out.</p>\n", history.events_left_out());
}

}  // namespace

std::string run_page_html(const RunHistory& history, const RunOrigin& origin) {
    const RunTotals& totals = history.totals();
    const std::string title = html_escaped(origin.title);
    const std::string head = page_head(title, {without_source_map(page_assets::dygraphs_style()),
                                               page_assets::report_style(), run_page_assets::run_style()});
    const std::string facts = facts_html(history, origin);
    const std::string stats = stats_html(totals, origin);
    const std::string verdict = verdict_html(history, origin);
    const std::string ceilings = ceilings_html(totals.ceilings);
    const std::string states = states_html(totals);
    const std::string immersion = mean_words(totals.radial_immersion, totals, "");
    const std::string depth = mean_words(totals.axial_depth_mm, totals, " mm");
    const std::string events = events_html(history);
    const std::string data = run_page_json(history);
    return filled(run_page_assets::run_template(),
                  {
                      {"head", head},
                      {"title", title},
                      {"facts", facts},
                      {"stats", stats},
                      {"verdict", verdict},
                      {"ceilings", ceilings},
                      {"states", states},
                      {"immersion", immersion},
                      {"depth", depth},
                      {"events", events},
                      {"data", data},
                      {"charts_script", page_assets::charts_script()},
                      {"run_script", run_page_assets::run_script()},
                      {"dygraphs_script", without_source_map(page_assets::dygraphs_script())},
                  });
}

}  // namespace millforce::host
