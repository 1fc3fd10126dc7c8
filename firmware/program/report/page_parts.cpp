// SPDX-License-Identifier: Apache-2.0
#include "report/page_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/page_template.hpp"

namespace millforce::host {

namespace {

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{{title}} – millforce</title>
{{more}}</head>
)";

/// Nothing is loaded from anywhere.
constexpr std::string_view of_one_file = R"(<meta http-equiv="Content-Security-Policy"
      content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'">
)";

}  // namespace

std::string page_head(std::string_view title, std::initializer_list<std::string_view> styles) {
    std::string more(of_one_file);
    for (const std::string_view style : styles) {
        more += fmt::format("<style>{}</style>\n", style);
    }
    return filled(head, {{"title", title}, {"more", more}});
}

std::string served_page_head(std::string_view title, std::initializer_list<std::string_view> style_files) {
    std::string more = "<link rel=\"icon\" href=\"data:,\">\n";
    for (const std::string_view file : style_files) {
        more += fmt::format("<link rel=\"stylesheet\" href=\"{}\">\n", file);
    }
    return filled(head, {{"title", title}, {"more", more}});
}

std::string readable_time(double time_s, double longest_s) {
    if (!std::isfinite(time_s)) {
        return "–";
    }
    if (!(longest_s >= 120.0)) {
        return fmt::format("{:.1f} s", time_s);
    }
    const double seconds = std::round(time_s);
    const double minutes = std::floor(seconds / 60.0);
    if (!(longest_s >= 7200.0)) {
        return fmt::format("{:.0f} min {:.0f} s", minutes, seconds - 60.0 * minutes);
    }
    const double hours = std::floor(minutes / 60.0);
    return fmt::format("{:.0f} h {:.0f} min", hours, minutes - 60.0 * hours);
}

std::string readable_time(double time_s) {
    return readable_time(time_s, time_s);
}

std::string readable_share(double share) {
    if (!std::isfinite(share)) {
        return "–";
    }
    return share > 0.0 && share < 0.01 ? "under 1 %" : fmt::format("{:.0f} %", 100.0 * share);
}

std::string fact_html(std::string_view name, std::string_view value) {
    return value.empty() ? std::string{}
                         : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, html_escaped(value));
}

std::string stat_html(std::string_view style, std::string_view value, std::string_view meaning) {
    return fmt::format("<div class=\"stat {}\"><strong>{}</strong><span>{}</span></div>\n", style, value, meaning);
}

}  // namespace millforce::host
