// SPDX-License-Identifier: Apache-2.0
#include "feed_ahead_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <initializer_list>
#include <vector>

using namespace millforce::control;
using namespace millforce::control::bench;

TEST_GROUP(FeedAheadMaterial){};

TEST(FeedAheadMaterial, the_first_estimate_tells_it) {
    FeedAheadSettings<float> settings = exact();
    settings.assumed_hardness = 1.3F;
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)}, settings);
    (void)ahead.step(estimate_at(1.0F, 300.0F));
    DOUBLES_EQUAL(1.0, static_cast<double>(ahead.hardness()), 0.01);
}

TEST(FeedAheadMaterial, no_material_is_taken_for_softer_or_harder_than_any) {
    const auto is_refuted_after = [](float measured, float then) {
        Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
        CHECK_TRUE(cut(ahead, 1.0F, 10.0F, measured * 300.0F).known);
        (void)cut(ahead, 10.1F, 11.0F, then * 300.0F);
        return ahead.is_refuted();
    };
    CHECK_TRUE(is_refuted_after(0.67F, 0.56F));  // 0.65, and 4·5 N of noise
    CHECK_FALSE(is_refuted_after(0.67F, 0.63F));
    CHECK_TRUE(is_refuted_after(1.9F, 2.15F));
    CHECK_FALSE(is_refuted_after(1.9F, 2.05F));
    CHECK_TRUE(is_refuted_after(1.0F, 0.70F));  // once measured, a quarter more or less
    CHECK_FALSE(is_refuted_after(1.0F, 0.76F));
    CHECK_TRUE(is_refuted_after(1.0F, 1.36F));
    CHECK_FALSE(is_refuted_after(1.0F, 1.29F));
}

TEST(FeedAheadMaterial, a_material_softer_than_any_is_found_behind_a_noise_that_hides_it_in_each_estimate) {
    const auto is_refuted_by = [](float share) {
        Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
        for (int k = 0; k < 100; ++k) {
            Ahead::Step now = estimate_at(1.0F + step_mm * static_cast<float>(k), share * 300.0F);
            now.tangential_sd_N = 30.0F;
            (void)ahead.step(now);
        }
        return ahead.is_refuted();
    };
    CHECK_TRUE(is_refuted_by(0.53F));  // 0.65, and 4·0.23·30 N of the average's noise
    CHECK_FALSE(is_refuted_by(0.59F));
}

TEST(FeedAheadMaterial, it_is_found_as_well_where_the_part_becomes_softer_later) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    for (int k = 0; k < 150; ++k) {
        Ahead::Step now = estimate_at(1.0F + step_mm * static_cast<float>(k), (k < 50 ? 0.8F : 0.53F) * 300.0F);
        now.tangential_sd_N = 30.0F;
        (void)ahead.step(now);
    }
    CHECK_TRUE(ahead.is_refuted());
}

TEST(FeedAheadMaterial, a_force_softer_than_any_material_refutes_the_next_program_at_once) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 0.67F * 300.0F);
    ahead.restart();
    CHECK_TRUE(ahead.add(cut_from(0.0F)));
    CHECK_TRUE(ahead.add(air_from(60.0F)));
    (void)cut(ahead, 1.0F, 2.0F, 0.56F * 300.0F);
    CHECK_TRUE(ahead.is_refuted());
}

TEST(FeedAheadMaterial, the_first_estimates_alone_refute_no_material_within_their_noise) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    for (int k = 0; k < 19; ++k) {
        Ahead::Step now = estimate_at(1.0F + step_mm * static_cast<float>(k), 0.4F * 300.0F);
        now.tangential_sd_N = 30.0F;
        (void)ahead.step(now);
    }
    CHECK_FALSE(ahead.is_refuted());
}

TEST(FeedAheadMaterial, where_the_cut_changes_a_force_between_both_says_nothing_of_the_material) {
    Ahead ahead = with({cut_from(0.0F), cut_from(20.0F, wall_feed_mm_s, 200.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 300.0F);
    for (const float force_N : {240.0F, 260.0F, 280.0F}) {
        (void)ahead.step(estimate_at(20.2F, force_N, 0.0F));
    }
    DOUBLES_EQUAL(1.0, static_cast<double>(ahead.hardness()), 1e-3);
}

TEST(FeedAheadMaterial, cuts_that_never_stay_the_same_tell_that_the_material_is_soft_but_not_how_soft) {
    std::vector<Stretch<float>> teeth;
    for (int k = 0; k < 30; ++k) {
        teeth.push_back(cut_from(static_cast<float>(k), 10.0F, k % 2 == 0 ? 300.0F : 200.0F));
    }
    teeth.push_back(air_from(30.0F));
    FeedAheadSettings<float> settings = exact(0.0F);
    settings.farthest_off_mm = 1.5F;
    settings.assumed_hardness = 1.3F;
    Ahead ahead = with(teeth, settings);
    const float before_mm_s = ahead.step(at(2.0F)).feed_mm_s;
    const float after_mm_s = cut(ahead, 2.0F, 25.0F, 0.6F * 250.0F).feed_mm_s;
    DOUBLES_EQUAL(10.0 / 1.3, static_cast<double>(before_mm_s), 1e-2);
    // κ is 0.6 of 250 N over 200 N at most.
    DOUBLES_EQUAL(10.0 / 0.75, static_cast<double>(after_mm_s), 0.2);
    DOUBLES_EQUAL(0.0, static_cast<double>(ahead.hardness()), 0.0);
}

TEST(FeedAheadMaterial, a_harder_material_than_any_is_measured_as_the_hardest) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 2.05F * 300.0F);
    CHECK_FALSE(ahead.is_refuted());
    DOUBLES_EQUAL(2.0, static_cast<double>(ahead.hardness()), 1e-4);
}

TEST(FeedAheadMaterial, one_estimate_moves_the_measured_material_by_a_tenth) {
    Ahead ahead = with({cut_from(0.0F), air_from(60.0F)});
    (void)cut(ahead, 1.0F, 10.0F, 300.0F);
    (void)ahead.step(estimate_at(10.1F, 330.0F));
    DOUBLES_EQUAL(1.01, static_cast<double>(ahead.hardness()), 1e-4);
}

TEST(FeedAheadMaterial, stays_known_in_cuts_that_never_stay_the_same) {
    std::vector<Stretch<float>> map{cut_from(0.0F)};
    for (int k = 20; k < 40; ++k) {
        map.push_back(cut_from(static_cast<float>(k), wall_feed_mm_s, k % 2 == 0 ? 300.0F : 200.0F));
    }
    map.push_back(air_from(40.0F));
    FeedAheadSettings<float> settings = exact();
    settings.farthest_off_mm = 1.5F;
    Ahead ahead = with(map, settings);
    (void)cut(ahead, 2.0F, 10.0F, 300.0F);
    (void)cut(ahead, 22.0F, 35.0F, 250.0F);
    DOUBLES_EQUAL(1.0, static_cast<double>(ahead.hardness()), 1e-3);
}

TEST(FeedAheadMaterial, near_air_a_force_says_nothing_of_it) {
    FeedAheadSettings<float> settings = exact();
    settings.farthest_off_mm = 1.5F;
    Ahead ahead = with({cut_from(0.0F), air_from(20.0F), air_from(60.0F)}, settings);
    (void)cut(ahead, 2.0F, 10.0F, 300.0F);
    (void)cut(ahead, 18.8F, 19.9F, 350.0F);
    CHECK_FALSE(ahead.is_refuted());
    DOUBLES_EQUAL(1.0, static_cast<double>(ahead.hardness()), 1e-3);
}
