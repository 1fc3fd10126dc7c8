// SPDX-License-Identifier: Apache-2.0
#include "estimation/depth_shape/depth_variation.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

using namespace millforce::estimation;

namespace {

constexpr float deg = static_cast<float>(std::numbers::pi / 180.0);
constexpr FluteGeometry<float> mill_1{4, 9.525F, 30.0F * deg};
constexpr FluteGeometry<float> mill_2{3, 4.7625F, 50.0F * deg};

/// A profile of straight lines: from the valley up over `rise`, flat, then down to the valley.
FluteAverage<float, 1, 720> trapezoid(float valley_deg, float rise_deg, float flat_deg, float pitch_deg) {
    FluteAverage<float, 1, 720> average;
    for (std::size_t b = 0; b < 720; ++b) {
        const float place = (static_cast<float>(b) + 0.5F) / 720.0F * pitch_deg;
        const float after = place >= valley_deg ? place - valley_deg : place - valley_deg + pitch_deg;
        const float fall_deg = pitch_deg - rise_deg - flat_deg;
        const float height = after < rise_deg              ? after / rise_deg
                             : after < rise_deg + flat_deg ? 1.0F
                                                           : (pitch_deg - after) / fall_deg;
        average.mean[b] << 100.0F + 300.0F * height;
    }
    return average;
}

}  // namespace

TEST_GROUP(CutCategory){};

TEST(CutCategory, of_the_published_cuts) {
    const auto of = [](const FluteGeometry<float>& mill, float axial, float radial) {
        return cut_category(flute_angles(mill, DepthsOfCut<float>{axial, radial}));
    };
    CHECK(of(mill_1, 7.62F, 7.62F) == (CutCategory{FluteForceType::I, FluteOverlap::low}));
    CHECK(of(mill_1, 20.32F, 2.54F) == (CutCategory{FluteForceType::II, FluteOverlap::low}));
    CHECK(of(mill_1, 2.54F, 15.24F) == (CutCategory{FluteForceType::III, FluteOverlap::medium}));
    CHECK(of(mill_2, 10.16F, 1.27F) == (CutCategory{FluteForceType::II, FluteOverlap::medium}));
    CHECK(of(mill_2, 1.27F, 7.62F) == (CutCategory{FluteForceType::III, FluteOverlap::low}));
}

TEST(CutCategory, turns_from_I_to_II_where_the_sweep_passes_the_engagement_and_to_III_past_the_critical_one) {
    const auto type = [](float engagement_deg, float sweep_deg) {
        return cut_category(FluteAngles<float>{engagement_deg * deg, sweep_deg * deg, 90.0F * deg}).type;
    };
    CHECK(type(60.0F, 59.0F) == FluteForceType::I);
    CHECK(type(60.0F, 61.0F) == FluteForceType::II);
    CHECK(type(99.0F, 20.0F) == FluteForceType::I);
    CHECK(type(101.0F, 20.0F) == FluteForceType::III);
    CHECK(type(179.0F, 175.0F) == FluteForceType::III);
}

TEST(CutCategory, has_the_peak_angle_of_table_1) {
    const auto angle_deg = [](float engagement, float sweep, float pitch) {
        return static_cast<double>(
            published_peak_angle_rad(FluteAngles<float>{engagement * deg, sweep * deg, pitch * deg}) / deg);
    };
    DOUBLES_EQUAL(26.46, angle_deg(78.46F, 26.46F, 90.0F), 1e-3);    // I: α_sw
    DOUBLES_EQUAL(10.0, angle_deg(85.0F, 70.0F, 60.0F), 1e-3);       // I/HO: α_sw − α_T
    DOUBLES_EQUAL(30.0, angle_deg(30.0F, 50.0F, 90.0F), 1e-3);       // II/NO: α_en
    DOUBLES_EQUAL(19.43, angle_deg(42.83F, 70.57F, 90.0F), 1e-3);    // II/LO: α_T − α_sw
    DOUBLES_EQUAL(25.67, angle_deg(42.83F, 145.67F, 120.0F), 1e-3);  // II/MO: α_sw − α_T
    DOUBLES_EQUAL(15.0, angle_deg(75.0F, 100.0F, 60.0F), 1e-3);      // II/HO: α_en − α_T
    DOUBLES_EQUAL(41.28, angle_deg(126.87F, 8.82F, 90.0F), 1e-2);    // III/MO: α_en + ½(α_sw − π)
}

TEST_GROUP(ForceIndexFinder){};

TEST(ForceIndexFinder, reads_corners_off_a_profile_wherever_it_begins) {
    for (const float valley_deg : {0.0F, 20.0F, 55.0F, 89.9F}) {
        const auto profile = trapezoid(valley_deg, 30.0F, 25.0F, 90.0F);
        const auto indices = ForceIndexFinder<float, 1, 720>(profile, 90.0F * deg, CutSide::down, 2.0F * deg).find();
        // The sharper corner of the top is where the steeper slope ends: the rise (1/30 against 1/35).
        DOUBLES_EQUAL(30.0, static_cast<double>(indices.valley_to_corner_rad / deg), 0.2);
        DOUBLES_EQUAL(60.0, static_cast<double>(indices.flat_top_to_valley_rad / deg), 0.2);
        DOUBLES_EQUAL(100.0 + 300.0 * (0.5 * 65.0 + 25.0) / 90.0, static_cast<double>(indices.mean_N), 0.5);
    }
}

TEST(ForceIndexFinder, reads_the_end_of_a_flat_top) {
    const auto profile = trapezoid(10.0F, 45.0F, 30.0F, 90.0F);  // falls over 15°
    const auto indices = ForceIndexFinder<float, 1, 720>(profile, 90.0F * deg, CutSide::down, 2.0F * deg).find();
    DOUBLES_EQUAL(15.0, static_cast<double>(indices.flat_top_to_valley_rad / deg), 0.2);
}

TEST(ForceIndexFinder, reads_up_milling_backwards) {
    const auto profile = trapezoid(10.0F, 15.0F, 30.0F, 90.0F);
    const auto indices = ForceIndexFinder<float, 1, 720>(profile, 90.0F * deg, CutSide::up, 2.0F * deg).find();
    DOUBLES_EQUAL(15.0, static_cast<double>(indices.flat_top_to_valley_rad / deg), 0.2);
}

TEST_GROUP(DepthVariationMethod){};

TEST(DepthVariationMethod, recovers_depths_from_the_indices_of_table_1_in_every_type) {
    struct Case {
        FluteGeometry<float> mill;
        DepthsOfCut<float> nominal;
    };
    const Case cases[] = {{mill_1, {7.62F, 7.62F}}, {mill_1, {20.32F, 2.54F}}, {mill_1, {2.54F, 15.24F}},
                          {mill_2, {3.81F, 3.81F}}, {mill_2, {10.16F, 1.27F}}, {mill_2, {1.27F, 7.62F}}};
    for (const Case& c : cases) {
        for (const float axial : {-0.2F, -0.05F, 0.15F}) {
            for (const float radial : {-0.2F, 0.04F, 0.15F}) {
                const DepthsOfCut<float> depths{c.nominal.axial_mm * (1.0F + axial),
                                                c.nominal.radial_mm * (1.0F + radial)};
                const auto angles = flute_angles(c.mill, depths);
                DepthVariationSettings<float> settings;
                settings.cutter = c.mill;
                settings.nominal = c.nominal;
                settings.specific_energy_N_mm2 = 7.0F;
                ForceIndices<float> indices;
                indices.*index_of<float>(cut_category(angles)) = published_peak_angle_rad(angles);
                indices.mean_N = 7.0F * depths.axial_mm * depths.radial_mm;
                const auto result = DepthVariationMethod<float>(settings).solve(indices);
                CHECK_TRUE(result.valid);
                bool found = false;
                for (std::size_t k = 0; k < result.count; ++k) {
                    const auto& candidate = result.candidates[k];
                    found = found || (candidate.consistent && std::abs(candidate.axial_variation - axial) < 2e-3F &&
                                      std::abs(candidate.radial_variation - radial) < 2e-3F);
                }
                CHECK_TRUE(found);
            }
        }
    }
}

TEST(DepthVariationMethod, calls_ten_percent_normal_and_more_a_variation) {
    const auto solve = [](float axial, float radial) {
        DepthVariationSettings<float> settings;
        settings.cutter = mill_1;
        settings.nominal = {7.62F, 7.62F};
        settings.specific_energy_N_mm2 = 7.0F;
        const DepthsOfCut<float> depths{7.62F * (1.0F + axial), 7.62F * (1.0F + radial)};
        ForceIndices<float> indices;
        indices.valley_to_corner_rad = flute_angles(mill_1, depths).sweep_rad;
        indices.mean_N = 7.0F * depths.axial_mm * depths.radial_mm;
        return DepthVariationMethod<float>(settings).solve(indices);
    };
    CHECK_TRUE(solve(0.09F, -0.09F).normal);
    CHECK_FALSE(solve(0.12F, 0.0F).normal);
    CHECK_FALSE(solve(0.0F, -0.12F).normal);
    CHECK_FALSE(solve(0.7F, 0.0F).valid);  // beyond ±50 %: no candidate is believed
}

TEST(DepthVariationMethod, gives_nothing_for_no_force) {
    DepthVariationSettings<float> settings;
    settings.cutter = mill_1;
    settings.nominal = {7.62F, 7.62F};
    settings.specific_energy_N_mm2 = 7.0F;
    CHECK_FALSE(DepthVariationMethod<float>(settings).solve({}).valid);
}

TEST(DepthVariationMethod, needs_as_many_samples_as_equation_13_says) {
    DOUBLES_EQUAL(4081.0, static_cast<double>(samples_per_revolution(mill_1, DepthsOfCut<float>{2.54F, 15.24F}, 0.01F)),
                  1.0);
}
