// SPDX-License-Identifier: Apache-2.0
#include "estimation/force_drop/force_drop.hpp"

#include "estimation/force_drop/face_mill_signal.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

using namespace millforce::estimation;
using millforce::tests::FaceMillSignal;

namespace {

using Estimate = ForceDropEstimate<float>;

ForceDropLaw<float> law_with_edges(double e_t_mm, double e_r_mm) {
    ForceDropLaw<float> law;
    law.valid = true;
    law.largest_immersion = 0.95F;
    law.e_t_mm = static_cast<float>(e_t_mm);
    law.e_r_mm = static_cast<float>(e_r_mm);
    law.r_scatter = 0.01F;
    law.ln_K_scatter = 0.02F;
    return law;
}

FaceMillSignal up_cut(double immersion) {
    FaceMillSignal signal;
    signal.exit_rad = std::acos(1.0 - immersion);
    signal.e_t_mm = 0.03;
    signal.e_r_mm = 0.04;
    signal.noise_N = 3.0;
    return signal;
}

/// `told_corner_hz`: of the low-pass; 0: the true one.
Estimate estimate_of(const FaceMillSignal& signal, int samples_per_rev = 512,
                     const ForceDropLaw<float>& law = law_with_edges(0.03, 0.04), double told_corner_hz = 0.0) {
    ForceDropSettings<float> settings;
    settings.revolutions = 1;
    settings.detector.teeth = signal.teeth;
    settings.detector.response.corner_hz = static_cast<float>(told_corner_hz > 0.0 ? told_corner_hz : signal.corner_hz);
    ForceDrop<float> force_drop(law, settings);
    Estimate estimate;
    for (const auto& sample : signal.samples(2.1, samples_per_rev)) {
        if (force_drop.add({static_cast<float>(sample.angle_rev), static_cast<float>(sample.dt_s),
                            static_cast<float>(sample.force.x_N), static_cast<float>(sample.force.y_N)},
                           static_cast<float>(signal.feed_mm))) {
            estimate = force_drop.estimate();
        }
    }
    return estimate;
}

}  // namespace

TEST_GROUP(ForceDrop){};

TEST(ForceDrop, estimates_the_immersion_of_an_up_cut_each_revolution) {
    for (const double immersion : {0.2, 0.35, 0.5, 0.65, 0.8}) {
        const auto estimate = estimate_of(up_cut(immersion));
        CHECK(estimate.valid());
        CHECK(estimate.side == CutSide::up);
        DOUBLES_EQUAL(immersion, static_cast<double>(estimate.radial_immersion), 0.05 * immersion);
    }
}

TEST(ForceDrop, tells_down_milling_by_the_rise_at_entry) {
    for (const double immersion : {0.2, 0.5, 0.8}) {
        auto signal = up_cut(immersion);
        signal.entry_rad = std::numbers::pi - signal.exit_rad;
        signal.exit_rad = std::numbers::pi;
        const auto estimate = estimate_of(signal);
        CHECK(estimate.valid());
        CHECK(estimate.side == CutSide::down);
        DOUBLES_EQUAL(immersion, static_cast<double>(estimate.radial_immersion), 0.06 * immersion);
    }
}

TEST(ForceDrop, takes_a_drifted_zero_off_where_there_is_air_between_teeth) {
    auto signal = up_cut(0.4);
    signal.offset_x_N = 60.0;
    signal.offset_y_N = -45.0;
    const auto estimate = estimate_of(signal);
    CHECK(estimate.valid());
    DOUBLES_EQUAL(0.4, static_cast<double>(estimate.radial_immersion), 0.02);
}

TEST(ForceDrop, takes_samples_at_any_rate) {
    const auto estimate = estimate_of(up_cut(0.5), 331);
    CHECK(estimate.valid());
    DOUBLES_EQUAL(0.5, static_cast<double>(estimate.radial_immersion), 0.025);
}

TEST(ForceDrop, copes_with_unequal_teeth) {
    auto signal = up_cut(0.5);
    signal.tooth_variation = 0.25;
    const auto estimate = estimate_of(signal);
    CHECK(estimate.valid());
    DOUBLES_EQUAL(0.5, static_cast<double>(estimate.radial_immersion), 0.025);
}

TEST(ForceDrop, gives_no_estimate_in_air) {
    auto signal = up_cut(0.5);
    signal.pressure_N_per_mm = 0.0;
    CHECK_FALSE(estimate_of(signal).valid());
}

TEST(ForceDrop, gives_no_estimate_where_teeth_pass_too_quickly) {
    auto signal = up_cut(0.5);
    signal.revs_per_s = 33.3;
    signal.corner_hz = 60.0;
    CHECK(estimate_of(signal).reason == Estimate::Reason::too_fast);
}

/// At 0.1 the edge where the tooth enters acts on the window of the jump.
TEST(ForceDrop, gives_no_estimate_where_the_low_pass_was_told_a_third_too_low_or_twice_too_high) {
    for (const double immersion : {0.1, 0.2, 0.35, 0.5, 0.65}) {
        const auto signal = up_cut(immersion);
        for (const double factor : {0.5, 0.67, 2.0}) {
            const auto estimate = estimate_of(signal, 512, law_with_edges(0.03, 0.04), factor * signal.corner_hz);
            CHECK(estimate.reason == Estimate::Reason::other_filter);
        }
    }
}

TEST(ForceDrop, gives_no_estimate_without_calibration) {
    CHECK(estimate_of(up_cut(0.5), 512, {}).reason == Estimate::Reason::no_law);
}
