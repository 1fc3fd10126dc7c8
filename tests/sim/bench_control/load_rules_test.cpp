// SPDX-License-Identifier: Apache-2.0
#include "bench_control/load_rules.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::sim;

namespace {

constexpr double dt_s = 0.001;

/// The rule's answer after it has seen a load for so long.
double after(LoadRule& rule, double load, double duration_s, double feed_mm_s = 20.0) {
    double share = 0.0;
    for (int k = 0; k < static_cast<int>(duration_s / dt_s + 0.5); ++k) {
        share = rule.step({load, 0.5, dt_s, feed_mm_s * dt_s});
    }
    return share;
}

}  // namespace

TEST_GROUP(LoadRules){};

TEST(LoadRules, haas_takes_a_fifth_a_second_away_above_the_limit_and_gives_a_tenth_back_below_95_percent_of_it) {
    HaasRule rule({1.0, 1.3});
    DOUBLES_EQUAL(1.3 - 0.20, after(rule, 0.51, 1.0), 1e-9);
    DOUBLES_EQUAL(1.1, after(rule, 0.49, 1.0), 1e-9);  // between 95 % and the limit nothing moves
    DOUBLES_EQUAL(1.2, after(rule, 0.47, 1.0), 1e-9);
}

TEST(LoadRules, haas_stays_between_the_window_and_the_feed_at_the_start) {
    HaasRule rule({1.0, 1.1});
    DOUBLES_EQUAL(0.5, after(rule, 0.9, 10.0), 1e-9);
    DOUBLES_EQUAL(1.1, after(rule, 0.1, 10.0), 1e-9);
}

TEST(LoadRules, haas_changes_the_feed_ten_times_a_second) {
    HaasRule rule({1.0, 1.0});
    DOUBLES_EQUAL(1.0, after(rule, 0.9, 0.099), 1e-9);
    DOUBLES_EQUAL(0.98, after(rule, 0.9, 0.002), 1e-9);
}

TEST(LoadRules, toolscope_turns_down_by_as_much_as_the_load_is_above_its_target) {
    ToolScopeRule rule(1.0);
    DOUBLES_EQUAL(0.95, after(rule, 0.5 * 1.05, dt_s), 1e-9);
    DOUBLES_EQUAL(1.10, after(rule, 0.5 * 0.90, dt_s), 1e-9);
    DOUBLES_EQUAL(1.30, after(rule, 0.0, dt_s), 1e-9);
    DOUBLES_EQUAL(0.50, after(rule, 2.0, dt_s), 1e-9);
}

/// The manual's: 100 % at a load of 30 %, stop at 80 %, at most 120 %: FCTDEF(2, 0, 120, 160, -2).
TEST(LoadRules, synfct_is_the_line_of_the_manuals_example) {
    SynfctRule rule({1.0, -2.0 * 0.30, {0.0, 1.2}});
    const auto override_at = [&](double load) { return rule.step({load, 0.30, dt_s, 0.0}); };
    DOUBLES_EQUAL(1.0, override_at(0.30), 1e-9);
    DOUBLES_EQUAL(0.4, override_at(0.60), 1e-9);
    DOUBLES_EQUAL(0.0, override_at(0.80), 1e-9);
    DOUBLES_EQUAL(1.2, override_at(0.05), 1e-9);
}

TEST(LoadRules, afc_holds_the_entry_feed_for_the_cutters_radius_or_600_ms) {
    AfcRule::Settings settings;
    settings.idle_share = 1.2;
    settings.gain_per_s = 1.0;
    settings.cutter_radius_mm = 5.0;
    AfcRule fast(settings);
    DOUBLES_EQUAL(1.2, after(fast, 0.019, 1.0), 1e-9);  // below 2 % over idling: air
    DOUBLES_EQUAL(1.0, after(fast, 0.25, 0.25), 1e-9);  // 5 mm at 20 mm/s
    CHECK_COMPARE(after(fast, 0.25, 0.1), >, 1.01);
    AfcRule slow(settings);
    DOUBLES_EQUAL(1.0, after(slow, 0.25, 0.6, 1.0), 1e-9);
    CHECK_COMPARE(after(slow, 0.25, 0.1, 1.0), >, 1.01);
}

TEST(LoadRules, afc_follows_its_reference_between_50_and_130_percent_and_stops_below_30) {
    AfcRule rule({1.0, 1.0, 1.0, 0.0});
    after(rule, 0.5, 0.01);
    DOUBLES_EQUAL(1.3, after(rule, 0.25, 2.0), 1e-9);
    DOUBLES_EQUAL(0.8, after(rule, 0.75, 1.0), 1e-3);  // error -0.5 for a second
    DOUBLES_EQUAL(0.5, after(rule, 0.75, 0.9), 1e-9);
    CHECK_FALSE(rule.has_stopped());
    after(rule, 0.75, 0.2);
    CHECK_TRUE(rule.has_stopped());
}

TEST(LoadRules, pid_adds_its_three_terms_to_100_percent) {
    PidRule proportional({1.0, 0.4, 0.0, 0.0});
    DOUBLES_EQUAL(1.0 + 0.4 * 0.2, after(proportional, 0.4, 1.0), 1e-9);
    PidRule integral({1.0, 0.0, 1.0, 0.0});
    DOUBLES_EQUAL(1.0 + 0.2, after(integral, 0.4, 1.001), 1e-9);
    PidRule derivative({1.0, 0.0, 0.0, 0.002});
    after(derivative, 0.5, 1.0);
    DOUBLES_EQUAL(1.0 - 0.002 * 0.1 / dt_s, after(derivative, 0.55, dt_s), 1e-9);
    DOUBLES_EQUAL(1.0, after(derivative, 0.55, dt_s), 1e-9);
}

TEST(LoadRules, the_integral_of_the_pid_does_not_grow_while_its_output_is_limited) {
    PidRule rule({1.0, 0.0, 1.0, 0.0});
    DOUBLES_EQUAL(1.3, after(rule, 0.1, 20.0), 1e-9);
    CHECK_COMPARE(after(rule, 0.75, 0.2), <, 1.21);
}

TEST(LoadRules, each_is_made_with_its_own_settings_at_the_start) {
    for (const RuleDescription& rule : rule_descriptions()) {
        std::vector<double> values;
        for (const RuleParameter& parameter : rule.parameters) {
            CHECK_COMPARE(parameter.low, <=, parameter.start);
            CHECK_COMPARE(parameter.start, <=, parameter.high);
            values.push_back(parameter.start);
        }
        const double share = after(*make_rule(rule.name, values, 5.0), 0.5, 1.0);
        CHECK_COMPARE(share, >=, 0.5);
        CHECK_COMPARE(share, <=, 1.3);
    }
}
