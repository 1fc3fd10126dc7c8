// SPDX-License-Identifier: Apache-2.0
#include "run_report/ceiling_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "report/page_parts.hpp"
#include "run_report/run_words.hpp"

namespace millforce::host {

namespace {

/// Each key in a line of its own, which may break after an underscore.
std::string keys_html(std::string_view keys) {
    std::string out;
    while (!keys.empty()) {
        const std::size_t end = std::min(keys.find(", "), keys.size());
        out += "<code>";
        for (const char letter : keys.substr(0, end)) {
            out += letter == '_' ? std::string("_<wbr>") : std::string(1, letter);
        }
        out += "</code>";
        keys.remove_prefix(std::min(end + 2, keys.size()));
    }
    return out;
}

}  // namespace

void CeilingTimes::add(double step_s, control::Limit limit, control::CutState state) {
    const std::size_t k = static_cast<std::size_t>(limit) % control::limit_count;
    const double in_cut_s = control::is_cutting(state) ? step_s : 0.0;
    held_s[k] += step_s;
    held_in_cut_s[k] += in_cut_s;
    all_s += step_s;
    cut_s += in_cut_s;
}

std::vector<control::Limit> CeilingTimes::longest_first() const {
    std::vector<control::Limit> ceilings;
    for (unsigned k = 0; k < control::limit_count; ++k) {
        if (held_s[k] > 0.0) {
            ceilings.push_back(static_cast<control::Limit>(k));
        }
    }
    std::stable_sort(ceilings.begin(), ceilings.end(), [this](control::Limit a, control::Limit b) {
        return std::pair(in_cut(a), of(a)) > std::pair(in_cut(b), of(b));
    });
    return ceilings;
}

std::string ceilings_html(const CeilingTimes& times) {
    std::string out =
        "<table class=\"figures\" style=\"--values: 2\">\n<thead><tr><th scope=\"col\">Ceiling and its key</th>"
        "<th scope=\"col\">in the cut</th><th scope=\"col\">of all time</th>"
        "<th scope=\"col\" class=\"explanation\">Why the feed was not higher</th></tr></thead>\n<tbody>\n";
    for (const control::Limit limit : times.longest_first()) {
        const CeilingWords& words = words_of(limit);
        const double in_cut_s = times.in_cut(limit);
        const double held_s = times.of(limit);
        out += fmt::format(
            "<tr><th scope=\"row\"><span class=\"swatch\" style=\"background: var(--limit-{})\"></span>{} {}</th>"
            "<td>{}<small>{}</small></td><td>{}<small>{}</small></td><td class=\"explanation\">{}</td></tr>\n",
            static_cast<unsigned>(limit), words.label, keys_html(words.keys),
            readable_share(share_of(in_cut_s, times.cut_s)), readable_time(in_cut_s),
            readable_share(share_of(held_s, times.all_s)), readable_time(held_s), words.meaning);
    }
    return out + "</tbody>\n</table>\n";
}

}  // namespace millforce::host
