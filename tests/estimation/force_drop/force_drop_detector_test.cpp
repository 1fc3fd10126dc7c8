// SPDX-License-Identifier: Apache-2.0
#include "estimation/force_drop/force_drop_detector.hpp"

#include "estimation/force_drop/face_mill_signal.hpp"
#include "host_test.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

using namespace millforce::estimation;
using millforce::tests::FaceMillSignal;

namespace {

using Detector = ForceDropDetector<float>;

RevolutionProfile<float> profile_of(const FaceMillSignal& signal, int revolutions = 1) {
    RevolutionProfile<float> profile(revolutions);
    for (const auto& sample : signal.samples(revolutions + 1.1)) {
        if (profile.add(static_cast<float>(sample.angle_rev), static_cast<float>(sample.dt_s),
                        static_cast<float>(sample.force.x_N), static_cast<float>(sample.force.y_N))) {
            break;
        }
    }
    return profile;
}

Detector detector_for(const FaceMillSignal& signal) {
    ForceDropDetectorSettings<float> settings;
    settings.teeth = signal.teeth;
    settings.response.corner_hz = static_cast<float>(signal.corner_hz);
    return Detector(settings);
}

double angle_distance_deg(double a_rev, double b_rev, int teeth) {
    const double pitches = (a_rev - b_rev) * teeth;
    return std::abs(pitches - std::round(pitches)) / teeth * 360.0;
}

}  // namespace

TEST_GROUP(ForceDropDetector){};

TEST(ForceDropDetector, reads_the_true_drop_behind_the_low_pass) {
    for (const double revs_per_s : {3.33, 5.0, 6.67}) {
        for (const int teeth : {1, 2, 3}) {
            FaceMillSignal signal;
            signal.revs_per_s = revs_per_s;
            signal.teeth = teeth;
            const auto jump = detector_for(signal).detect(profile_of(signal));
            const auto leaving = signal.tooth(signal.exit_rad);
            const double size = std::hypot(leaving.x_N, leaving.y_N);
            CHECK(jump.valid());
            DOUBLES_EQUAL(-leaving.x_N, static_cast<double>(jump.x_N.value), 0.015 * size);
            DOUBLES_EQUAL(-leaving.y_N, static_cast<double>(jump.y_N.value), 0.015 * size);
            const double exit_rev = signal.exit_rad / (2.0 * std::numbers::pi);
            CHECK(angle_distance_deg(static_cast<double>(jump.angle_rev), exit_rev, teeth) < 0.3);
        }
    }
}

TEST(ForceDropDetector, reads_the_drop_of_one_tooth_while_another_cuts) {
    FaceMillSignal signal;
    signal.teeth = 6;
    signal.exit_rad = 1.37;  // 78.5°: one tooth and a third
    const auto jump = detector_for(signal).detect(profile_of(signal));
    const auto leaving = signal.tooth(signal.exit_rad);
    CHECK(jump.valid());
    DOUBLES_EQUAL(-leaving.x_N, static_cast<double>(jump.x_N.value), 0.02 * 360.0);
    DOUBLES_EQUAL(-leaving.y_N, static_cast<double>(jump.y_N.value), 0.02 * 360.0);
}

TEST(ForceDropDetector, takes_the_mean_of_unequal_teeth) {
    FaceMillSignal signal;
    signal.tooth_variation = 0.3;
    const auto jump = detector_for(signal).detect(profile_of(signal));
    const auto leaving = signal.tooth(signal.exit_rad);
    DOUBLES_EQUAL(-leaving.x_N, static_cast<double>(jump.x_N.value), 5.0);
    DOUBLES_EQUAL(-leaving.y_N, static_cast<double>(jump.y_N.value), 5.0);
}

TEST(ForceDropDetector, finds_the_rise_at_entry_in_down_milling) {
    FaceMillSignal signal;
    signal.entry_rad = 2.0 * std::numbers::pi / 3.0;
    signal.exit_rad = std::numbers::pi;
    const auto jump = detector_for(signal).detect(profile_of(signal));
    const auto entering = signal.tooth(signal.entry_rad);
    CHECK(jump.valid());
    DOUBLES_EQUAL(entering.x_N, static_cast<double>(jump.x_N.value), 5.0);
    DOUBLES_EQUAL(entering.y_N, static_cast<double>(jump.y_N.value), 5.0);
}

HOST_TEST(ForceDropDetector, finds_nothing_in_noise) {
    int found = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        FaceMillSignal signal;
        signal.pressure_N_per_mm = 0.0;
        signal.noise_N = 10.0;
        signal.seed = seed;
        auto detector = detector_for(signal);
        found += detector.detect(profile_of(signal)).valid() ? 1 : 0;
    }
    CHECK(found <= 1);
}

HOST_TEST(ForceDropDetector, errs_as_much_as_its_deviation_says) {
    int within_two = 0;
    constexpr int trials = 40;
    for (unsigned seed = 1; seed <= trials; ++seed) {
        FaceMillSignal signal;
        signal.corner_hz = 1200.0;  // white noise after a filter that hardly correlates it
        signal.noise_N = 12.0;
        signal.seed = seed;
        const auto jump = detector_for(signal).detect(profile_of(signal));
        const double error = static_cast<double>(jump.x_N.value) + signal.tooth(signal.exit_rad).x_N;
        within_two += error * error <= 4.0 * static_cast<double>(jump.x_N.variance) ? 1 : 0;
    }
    CHECK(within_two >= 34);
}

TEST(ForceDropDetector, says_when_teeth_pass_too_quickly_for_the_low_pass) {
    FaceMillSignal signal;
    signal.revs_per_s = 33.3;
    signal.corner_hz = 60.0;
    const auto jump = detector_for(signal).detect(profile_of(signal));
    CHECK(jump.reason == ForceJump<float>::Reason::too_fast);
}

TEST(ForceDropDetector, takes_off_an_edge_that_is_told_to_it) {
    FaceMillSignal signal;
    signal.teeth = 6;
    signal.exit_rad = 1.05;  // 60.2°: the next tooth enters where this one leaves
    signal.e_t_mm = 0.04;
    signal.e_r_mm = 0.04;
    const auto profile = profile_of(signal);
    const auto detector = detector_for(signal);
    const auto blind = detector.detect(profile);
    OtherEdge<float> entry;
    entry.present = true;
    entry.behind_rev = static_cast<float>(-signal.exit_rad / (2.0 * std::numbers::pi));
    entry.step_x_N = static_cast<float>(signal.tooth(0.0).x_N);
    entry.step_y_N = static_cast<float>(signal.tooth(0.0).y_N);
    constexpr double h = 1e-4;
    const double per_rev = 2.0 * std::numbers::pi / h;
    entry.slope_x_N_per_rev = static_cast<float>((signal.tooth(h).x_N - signal.tooth(0.0).x_N) * per_rev);
    entry.slope_y_N_per_rev = static_cast<float>((signal.tooth(h).y_N - signal.tooth(0.0).y_N) * per_rev);
    const auto told = detector.detect_near(profile, blind.angle_rev, entry);
    const auto leaving = signal.tooth(signal.exit_rad);
    CHECK(std::abs(static_cast<double>(blind.x_N.value) + leaving.x_N) > 50.0);
    DOUBLES_EQUAL(-leaving.x_N, static_cast<double>(told.x_N.value), 12.0);
    DOUBLES_EQUAL(-leaving.y_N, static_cast<double>(told.y_N.value), 12.0);
}
