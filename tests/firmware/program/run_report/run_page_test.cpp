// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "firmware/program/report/json_check.hpp"
#include "history_bench.hpp"
#include "parameters/parameter_table.hpp"
#include "run_report/run_words.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::host::test;

namespace {

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
        ++count;
    }
    return count;
}

bool is_key(std::string_view key) {
    const auto rows = parameter_table();
    return std::any_of(rows.begin(), rows.end(), [&](const ParameterRow& row) { return key == row.key; });
}

}  // namespace

TEST_GROUP(RunPage) {
    RunHistory history{endmill()};
    RunOrigin origin{"Run on can0", false, false, {{"Machine", "vmc.toml"}}};

    /// 1 s in air, 1 s entering, 3 s in the cut.
    void mill() {
        for (int k = 0; k <= 5000; ++k) {
            history.add(0.001 * k, k <= 1000 ? in_air() : k <= 2000 ? entering(1.1F) : in_cut(0.87F), 0);
        }
    }
    [[nodiscard]] std::string page() const {
        return run_page_html(history, origin);
    }
};

TEST(RunPage, says_in_words_how_long_the_tool_cut_how_high_the_load_was_and_what_held_the_feed) {
    mill();
    const std::string html = page();
    CHECK(has(html, "The tool was in the cut for 4.0 s of 5.0 s."));
    CHECK(has(html, "reached 87 % of its limit"));
    CHECK(has(html, "was at most 110 % of its limit, and can have been above it for 1.00 s"));
    CHECK(has(html, "For 75 % of the cut the ceiling on the feed was: load on a tooth."));
    CHECK(has(html, "There was no fault."));
    CHECK(has(html, "In this run it was known in 75 % of the cut, and was 0.60 on average."));
    CHECK(has(html, "In this run it was known in 75 % of the cut, and was 4.00 mm on average."));
}

TEST(RunPage, says_how_much_the_tool_runs_out_by_the_cut_beside_what_its_file_states) {
    mill();
    CHECK(has(page(), "Runout of the tool"));
    CHECK(has(page(), "6 µm by its file; no cut showed it"));
    firmware::TickRecord tick = in_cut(0.9F);
    tick.runout_um = 23.6F;
    history.add(6.0, tick, 0);
    tick.runout_um = 6.0F;  // the zero of the encoder is lost
    history.add(6.1, tick, 0);
    CHECK(has(page(), "24 µm at most, as the cut showed; 6 µm by its file"));
}

TEST(RunPage, lists_the_ceilings_that_held_by_their_keys_and_no_other) {
    mill();
    const std::string html = page();
    CHECK(has(html, "tooth_<wbr>force_<wbr>limit_<wbr>N"));
    CHECK(has(html, "entry_<wbr>feed_<wbr>per_<wbr>tooth_<wbr>mm"));
    CHECK(has(html, "<td>75 %<small>3.0 s</small></td><td>60 %<small>3.0 s</small></td>"));
    CHECK_FALSE(has(html, "surge_<wbr>radial_<wbr>immersion"));
}

TEST(RunPage, names_keys_that_the_parameter_files_have) {
    for (unsigned k = 0; k < control::limit_count; ++k) {
        const CeilingWords& words = words_of(static_cast<control::Limit>(k));
        CHECK(std::strlen(words.label) > 3 && std::strlen(words.meaning) > 20);
        for (std::string_view keys = words.keys; !keys.empty();) {
            const std::size_t end = std::min(keys.find(", "), keys.size());
            const std::string key(keys.substr(0, end));
            CHECK_TEXT(is_key(key), key.c_str());
            keys.remove_prefix(std::min(end + 2, keys.size()));
        }
    }
}

TEST(RunPage, has_a_colour_for_each_ceiling) {
    const std::string html = page();
    for (unsigned k = 0; k < control::limit_count; ++k) {
        const std::string colour = "--limit-" + std::to_string(k) + ": #";
        CHECK_TEXT(has(html, colour), colour.c_str());
    }
}

TEST(RunPage, says_at_once_which_fault_came_and_when) {
    mill();
    auto tick = in_cut(1.4F);
    tick.feed_override.fault = static_cast<std::uint8_t>(control::Fault::overload);
    history.add(5.001, tick, 0);
    const std::string html = page();
    CHECK(has(html, "<strong class=\"fault\">Fault overload, at 5.0 s.</strong>"));
    CHECK(has(html, meaning_of(control::Fault::overload)));
}

TEST(RunPage, embeds_valid_data_in_which_no_estimate_is_null) {
    mill();
    const std::string data = run_page_json(history);
    CHECK(JsonCheck::valid(data));
    CHECK(has(page(), data));
    CHECK(has(data, "\"radial_immersion\":[null,null,"));
    CHECK(has(data, "\"states\":\"000"));
    CHECK_FALSE(has(data, "true_"));  // of a real run nobody knows the truth
}

TEST(RunPage, asks_the_network_for_nothing_and_leaves_no_placeholder) {
    mill();
    const std::string html = page();
    CHECK(has(html, "default-src 'none'"));
    for (const char* request :
         {" src=", "<link", "@import", "url(http", "sourceMappingURL", "fetch(", "{{title}}", "{{data}}"}) {
        CHECK_TEXT(!has(html, request), request);
    }
}

TEST(RunPage, shows_text_from_outside_as_text) {
    mill();
    const std::string calm = page();
    origin.title = "Run on </title><script>alert('x')</script>{{data}}";
    origin.facts[0].second = "<img onerror=\"x\">";
    history.note(1.0, "</script><b>");
    const std::string html = page();
    LONGS_EQUAL(count_of(calm, "</script"), count_of(html, "</script"));
    LONGS_EQUAL(count_of(calm, "<img"), count_of(html, "<img"));
    LONGS_EQUAL(count_of(calm, "<b>"), count_of(html, "<b>"));
    CHECK(JsonCheck::valid(run_page_json(history)));
}

TEST(RunPage, of_a_run_without_a_sample_or_without_a_cut_says_so) {
    CHECK(has(page(), "No complete sample of the drives came"));
    CHECK(JsonCheck::valid(run_page_json(history)));
    history.add(0.0, in_air(), 0);
    history.add(0.4, in_air(), 0);
    CHECK(has(page(), "In 0.4 s no cut was seen."));
}

TEST(RunPage, of_a_long_run_gives_times_in_hours_minutes_and_seconds) {
    for (int k = 0; k <= 40'000; ++k) {
        history.add(0.2 * k, k == 19'000 ? in_cut(0.5F) : in_air(), 0);
    }
    history.note(3725.0, "Something.");
    const std::string html = page();
    CHECK(has(html, "<span class=\"when\">1:02:05</span><span>Something.</span>"));
    CHECK(has(html, "<dd>2 h 13 min</dd>"));
}

TEST(RunPage, of_a_replay_says_that_the_override_did_not_act) {
    mill();
    CHECK_FALSE(has(page(), "This is a replay"));
    origin.is_replay = true;
    CHECK(has(page(), "This is a replay"));
}

TEST(RunPage, of_a_tool_that_is_only_watched_says_that_the_feed_was_the_operators) {
    mill();
    origin.is_monitor_only = true;
    CHECK(has(page(), "The tool's file says monitor_only: the feed was the operator's."));
    CHECK_FALSE(has(page(), "the ceiling on the feed was"));
}

TEST(RunPage, of_a_cut_whose_engagement_was_never_known_gives_a_bound_of_the_load) {
    for (int k = 0; k <= 1000; ++k) {
        history.add(0.001 * k, entering(0.6F), 0);
    }
    const std::string html = page();
    CHECK(has(html, "How the tool was engaged was not known: the load on one tooth was at most 60 % of its limit."));
    CHECK(has(html, "<strong>60 %</strong><span>of its limit at most"));
    CHECK(has(html, "In this run it was never known."));
}

TEST(RunPage, of_a_cut_without_a_load_says_so) {
    for (int k = 0; k <= 1000; ++k) {
        history.add(0.001 * k, entering(std::nanf("")), 0);
    }
    const std::string html = page();
    CHECK(has(html, "The forces gave no load of a tooth to compare with its limit."));
    CHECK(has(html, "<strong>–</strong>"));
}

TEST(RunPage, marks_a_load_that_stays_above_its_limit_or_ends_in_a_fault_but_not_one_that_scatters) {
    for (int k = 0; k <= 5000; ++k) {
        history.add(0.001 * k, in_cut(k == 2500 ? 1.05F : 0.9F), 0);
    }
    CHECK(has(page(), "<div class=\"stat hero\">"));
    for (int k = 5001; k <= 6000; ++k) {
        history.add(0.001 * k, in_cut(1.05F), 0);
    }
    CHECK(has(page(), "<div class=\"stat hero over\">"));
}

TEST(RunPage, names_samples_that_it_does_not_show) {
    history.add(0.0, in_air(), 0);
    CHECK_FALSE(has(page(), "Samples missing on this page"));
    history.set_lost(17);
    CHECK(has(page(), "<dt>Samples missing on this page</dt><dd>17</dd>"));
}
