// SPDX-License-Identifier: Apache-2.0
#include "estimation/depth_shape/flute_profile_fit.hpp"

#include "estimation/depth_shape/depth_monitor.hpp"
#include "estimation/depth_shape/flute_force.hpp"
#include "estimation/depth_shape/flute_profile_impl.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

using namespace millforce::estimation;
using millforce::tests::FluteCut;
using millforce::tests::pitch_force;

namespace {

constexpr double degree_rad = pi<double> / 180.0;
using ProfileFit = FluteProfileFit<float, 10>;
using Spectrum = ProfileSpectrum<float, 10>;

Spectrum spectrum_of(const FluteCut& cut, std::complex<double> factor = 1.0, double noise_share = 0.0) {
    constexpr std::size_t bins = 180;
    constexpr std::size_t finer = 8;
    const auto force = pitch_force(cut, bins * finer);
    double peak = 0.0;
    for (const auto& f : force) {
        peak = std::max(peak, std::abs(f));
    }
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise(0.0, noise_share * peak);
    FluteAverage<float, 2, 180> average;
    average.spindle_speed_rev_s = 1000.0F / 60.0F;
    for (std::size_t b = 0; b < bins; ++b) {
        std::complex<double> mean = std::complex<double>(noise(random), noise(random));
        for (std::size_t i = 0; i < finer; ++i) {
            mean += force[b * finer + i] / static_cast<double>(finer);
        }
        average.mean[b] << static_cast<float>((mean * factor).real()), static_cast<float>((mean * factor).imag());
    }
    return profile_spectrum<10>(average);
}

FluteProfileFitSettings<float> settings_for(const FluteCut& cut, double reach = 0.5) {
    FluteProfileFitSettings<float> s;
    s.cutter = {cut.teeth, static_cast<float>(cut.radius_mm), static_cast<float>(cut.helix_rad)};
    s.side = cut.up ? CutSide::up : CutSide::down;
    // Off centre, so that the true depth is no node of the search.
    s.axial = {static_cast<float>(cut.axial_mm * (1.03 - reach)), static_cast<float>(cut.axial_mm * (1.03 + reach))};
    s.radial = {static_cast<float>(cut.radial_mm * (0.98 - reach)),
                static_cast<float>(std::min(cut.radial_mm * (0.98 + reach), 2.0 * cut.radius_mm))};
    s.tip_angle_rad = {true, static_cast<float>(cut.tip_angle_rad), 1e-5F, 1e-5F};
    return s;
}

FluteCut cut_of(int teeth, double sweep_in_pitches, double engagement_deg) {
    FluteCut cut;
    cut.teeth = teeth;
    cut.axial_mm = sweep_in_pitches * 2.0 * pi<double> / teeth * cut.radius_mm / std::tan(cut.helix_rad);
    cut.radial_mm = cut.radius_mm * (1.0 - std::cos(engagement_deg * degree_rad));
    return cut;
}

void check_depths(const FluteCut& cut, const FluteProfileEstimate<float>& estimate, double relative_bound) {
    CHECK_TRUE(estimate.axial_depth_mm.valid);
    CHECK_TRUE(estimate.radial_depth_mm.valid);
    DOUBLES_EQUAL(1.0, static_cast<double>(estimate.axial_depth_mm.value) / cut.axial_mm, relative_bound);
    DOUBLES_EQUAL(1.0, static_cast<double>(estimate.radial_depth_mm.value) / cut.radial_mm, relative_bound);
}

}  // namespace

TEST_GROUP(FluteProfileFit){};

TEST(FluteProfileFit, finds_both_depths_in_all_twelve_categories_up_and_down) {
    struct Case {
        int teeth;
        double sweep_in_pitches;
        double engagement_deg;
        CutCategory category;
    };
    using Type = FluteForceType;
    using Overlap = FluteOverlap;
    const Case cases[] = {{3, 0.25, 60.0, {Type::I, Overlap::none}},      {4, 0.30, 78.0, {Type::I, Overlap::low}},
                          {6, 0.40, 85.0, {Type::I, Overlap::medium}},    {6, 1.30, 100.0, {Type::I, Overlap::high}},
                          {4, 0.60, 30.0, {Type::II, Overlap::none}},     {4, 0.78, 43.0, {Type::II, Overlap::low}},
                          {3, 1.21, 43.0, {Type::II, Overlap::medium}},   {6, 1.70, 75.0, {Type::II, Overlap::high}},
                          {2, 0.15, 135.0, {Type::III, Overlap::none}},   {3, 0.15, 127.0, {Type::III, Overlap::low}},
                          {4, 0.12, 127.0, {Type::III, Overlap::medium}}, {6, 0.80, 150.0, {Type::III, Overlap::high}}};
    for (const Case& c : cases) {
        for (const bool up : {false, true}) {
            FluteCut cut = cut_of(c.teeth, c.sweep_in_pitches, c.engagement_deg);
            cut.up = up;
            const auto estimate = ProfileFit(settings_for(cut)).estimate(spectrum_of(cut, 1.0, 0.001));
            check_depths(cut, estimate, 0.01);
            CHECK_TRUE(estimate.category == c.category);
        }
    }
}

TEST(FluteProfileFit, does_not_see_hardness_nor_the_direction_of_the_frame) {
    const FluteCut cut;
    const auto plain = ProfileFit(settings_for(cut)).estimate(spectrum_of(cut));
    for (const std::complex<double> factor :
         {std::complex<double>(7.0, 0.0), std::polar(0.3, 1.1), std::polar(1.0, 4.0)}) {
        const auto other = ProfileFit(settings_for(cut)).estimate(spectrum_of(cut, factor));
        DOUBLES_EQUAL(1.0, static_cast<double>(other.axial_depth_mm.value / plain.axial_depth_mm.value), 2e-4);
        DOUBLES_EQUAL(1.0, static_cast<double>(other.radial_depth_mm.value / plain.radial_depth_mm.value), 2e-4);
    }
}

TEST(FluteProfileFit, does_not_need_to_know_the_law_of_force) {
    for (const double ratio : {0.1, 0.35, 0.7}) {
        for (const double edge : {0.0, 0.2, 0.6}) {
            for (const double exponent : {0.0, -0.3}) {
                FluteCut cut;
                cut.K_r = ratio * cut.K_t;
                cut.edge_t = edge * cut.K_t;
                cut.edge_r = 1.2 * edge * cut.K_t;
                cut.size_exponent = exponent;
                check_depths(cut, ProfileFit(settings_for(cut)).estimate(spectrum_of(cut)), 0.006);
            }
        }
    }
}

TEST(FluteProfileFit, learns_the_tips_angle_from_a_cut_of_known_depths) {
    FluteCut cut;
    cut.tip_angle_rad = 0.77;
    auto settings = settings_for(cut);
    settings.tip_angle_rad.valid = false;
    const DepthsOfCut<float> known{static_cast<float>(cut.axial_mm), static_cast<float>(cut.radial_mm)};
    const auto learnt = ProfileFit(settings).calibrate_tip_angle(spectrum_of(cut), known, 0.005F);
    CHECK_TRUE(learnt.valid);
    DOUBLES_EQUAL(0.77, static_cast<double>(learnt.value), 0.2 * degree_rad);
    CHECK(static_cast<double>(learnt.variance) > 0.0);
}

TEST(FluteProfileFit, finds_the_tips_angle_with_the_depths_where_no_runout_blurs_them) {
    FluteCut cut;
    auto settings = settings_for(cut);
    settings.tip_angle_rad.valid = false;
    const auto estimate = ProfileFit(settings).estimate(spectrum_of(cut));
    check_depths(cut, estimate, 0.015);
    DOUBLES_EQUAL(cut.tip_angle_rad, static_cast<double>(estimate.tip_angle_rad.value), 0.5 * degree_rad);
}

TEST(FluteProfileFit, tells_up_from_down_milling_by_itself) {
    for (const bool up : {false, true}) {
        FluteCut cut;
        cut.up = up;
        auto settings = settings_for(cut);
        settings.side = CutSide::unknown;
        const auto estimate = ProfileFit(settings).estimate(spectrum_of(cut));
        CHECK(estimate.side == (up ? CutSide::up : CutSide::down));
        check_depths(cut, estimate, 0.006);
    }
}

TEST(FluteProfileFit, undoes_the_low_pass_that_it_is_told_of) {
    const FluteCut cut;
    Spectrum spectrum = spectrum_of(cut);
    const LowPass<float> filter{2, 470.0F};
    for (int k = 0; k <= 10; ++k) {
        const auto H = low_pass_response(filter, static_cast<float>(k * cut.teeth) * spectrum.spindle_speed_rev_s);
        auto& plus = spectrum.line[static_cast<std::size_t>(10 + k)];
        auto& minus = spectrum.line[static_cast<std::size_t>(10 - k)];
        plus = plus * H;
        minus = k > 0 ? minus * conjugate(H) : minus;
    }
    auto settings = settings_for(cut);
    settings.low_pass = filter;
    check_depths(cut, ProfileFit(settings).estimate(spectrum), 0.006);
    settings.low_pass.cutoff_Hz *= 1.1F;
    check_depths(cut, ProfileFit(settings).estimate(spectrum), 0.01);
}

TEST(FluteProfileFit, is_honest_about_its_error) {
    int within = 0;
    int depths = 0;
    for (int i = 0; i < 20; ++i) {
        const FluteCut cut = cut_of(3 + i % 3, 0.2 + 0.05 * i, 50.0 + 4.0 * i);
        const auto estimate = ProfileFit(settings_for(cut)).estimate(spectrum_of(cut, 1.0, 0.005));
        const auto count = [&](const Measurement<float>& m, double truth) {
            if (m.valid) {
                ++depths;
                within +=
                    std::abs(static_cast<double>(m.value) - truth) < 2.0 * std::sqrt(static_cast<double>(m.variance))
                        ? 1
                        : 0;
            }
        };
        count(estimate.axial_depth_mm, cut.axial_mm);
        count(estimate.radial_depth_mm, cut.radial_mm);
    }
    CHECK(depths >= 30);
    CHECK(within >= 0.9 * depths);
}

TEST(FluteProfileFit, gives_no_estimate_where_there_is_none) {
    const FluteCut whole_pitch = cut_of(4, 1.0, 80.0);  // the force is constant
    const auto constant = ProfileFit(settings_for(whole_pitch)).estimate(spectrum_of(whole_pitch));
    CHECK_FALSE(constant.axial_depth_mm.valid);
    CHECK_FALSE(constant.radial_depth_mm.valid);

    const auto empty = ProfileFit(settings_for(FluteCut{})).estimate(Spectrum{});
    CHECK_FALSE(empty.axial_depth_mm.valid);
    CHECK_FALSE(empty.radial_depth_mm.valid);

    FluteCut cut;
    auto elsewhere = settings_for(cut);
    elsewhere.axial = {1.4F * elsewhere.axial.low_mm + 5.0F, 2.0F * elsewhere.axial.high_mm};
    CHECK_FALSE(ProfileFit(elsewhere).estimate(spectrum_of(cut)).axial_depth_mm.valid);

    auto straight = settings_for(cut);
    straight.cutter.helix_rad = 0.0F;
    CHECK_FALSE(ProfileFit(straight).estimate(spectrum_of(cut)).axial_depth_mm.valid);

    auto muffled = settings_for(cut);
    muffled.low_pass = {2, 60.0F};  // not even the first harmonic passes in full
    CHECK_FALSE(ProfileFit(muffled).estimate(spectrum_of(cut)).axial_depth_mm.valid);
}

TEST_GROUP(DepthMonitor){};

TEST(DepthMonitor, turns_a_recording_into_depths_within_fixed_memory) {
    const FluteCut cut;
    DepthMonitor<float> monitor(settings_for(cut), 20);
    constexpr std::size_t per_pitch = 180;
    const auto force = pitch_force(cut, per_pitch);
    const double step_rad = 2.0 * pi<double> / (cut.teeth * static_cast<double>(per_pitch));
    int profiles = 0;
    for (std::size_t i = 0; i < 41 * 4 * per_pitch; ++i) {
        const auto& f = force[i % per_pitch];
        const double angle = std::fmod(static_cast<double>(i) * step_rad, 2.0 * pi<double>);
        if (monitor.add(1e-4F, static_cast<float>(angle), static_cast<float>(f.real()), static_cast<float>(f.imag()))) {
            ++profiles;
            check_depths(cut, monitor.evaluate(), 0.006);
        }
    }
    CHECK_EQUAL(2, profiles);
    CHECK(sizeof(monitor) <= 2600);
    CHECK_FALSE(monitor.evaluate().axial_depth_mm.valid);  // the third profile is not complete
}

TEST(DepthMonitor, makes_do_with_fifteen_samples_per_tooth) {
    const FluteCut cut;  // 1 kHz at 1 000 rpm, four flutes
    DepthMonitor<float> monitor(settings_for(cut), 20);
    const double step_rad = 2.0 * pi<double> / 60.0;
    double angle = 0.0;
    for (int i = 0; i < 1300; ++i) {
        const auto f = millforce::tests::plane_force(cut, angle);
        if (monitor.add(1e-3F, static_cast<float>(std::fmod(angle, 2.0 * pi<double>)), static_cast<float>(f.real()),
                        static_cast<float>(f.imag()))) {
            check_depths(cut, monitor.evaluate(), 0.03);
            return;
        }
        angle += step_rad * 1.0137;  // not locked to the tooth
    }
    FAIL("no profile");
}
