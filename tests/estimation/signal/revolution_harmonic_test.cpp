// SPDX-License-Identifier: Apache-2.0
#include "estimation/signal/revolution_harmonic.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

namespace {

using Harmonic = millforce::estimation::RevolutionHarmonic<float>;
using Complex = std::complex<double>;

constexpr double turn = 2.0 * std::numbers::pi;

/// A spindle whose speed and current vary once, twice and four times per revolution.
struct Spindle {
    double samples_per_rev = 18.1;
    Complex current_A = std::polar(0.7, 0.9);
    Complex time = std::polar(1e-3, -2.1);
    double counts_per_rev = 0.0;  // 0: the angle is exact
    double time_rev = 0.123;      // at an even speed
    double last_rev = 0.0;

    [[nodiscard]] double angle_rev(double at_rev) const {
        // dθ/dt = ω (1 − Re(T_1 e^(iθ))): to first order θ − ωt = −Im(T_1 e^(iωt))
        const double exact = at_rev - std::imag(time * std::polar(1.0, turn * at_rev)) / turn;
        return counts_per_rev > 0.0 ? std::floor(exact * counts_per_rev) / counts_per_rev : exact;
    }
    void sample(Harmonic& harmonic) {
        time_rev += 1.0 / samples_per_rev;
        const double rev = angle_rev(time_rev);
        const double current = 5.0 + std::real(current_A * std::polar(1.0, turn * rev)) +
                               0.8 * std::cos(2.0 * turn * rev + 0.3) + 0.8 * std::cos(4.0 * turn * rev);
        harmonic.add(1e-3F, static_cast<float>(rev - last_rev), static_cast<float>(rev - std::floor(rev)),
                     static_cast<float>(current));
        last_rev = rev;
    }
    Harmonic::Mean turn_for(Harmonic& harmonic, int revolutions) {
        last_rev = angle_rev(time_rev);
        for (int k = 0; k < static_cast<int>(samples_per_rev * (revolutions + 1.5)); ++k) {
            sample(harmonic);
        }
        return harmonic.take();
    }
};

Complex of(const millforce::estimation::Phasor<float>& phasor) {
    return {static_cast<double>(phasor.re), static_cast<double>(phasor.im)};
}

}  // namespace

TEST_GROUP(RevolutionHarmonic){};

TEST(RevolutionHarmonic, finds_what_repeats_once_per_revolution_and_nothing_else) {
    for (const double samples_per_rev : {9.3, 18.1, 57.0}) {
        Spindle spindle{.samples_per_rev = samples_per_rev};
        Harmonic harmonic(8192);
        const Harmonic::Mean mean = spindle.turn_for(harmonic, 100);
        CHECK_COMPARE(mean.revolutions, >=, 100);
        DOUBLES_EQUAL(0.0, std::abs(of(mean.current_A) - spindle.current_A), 0.03);
        DOUBLES_EQUAL(0.0, std::abs(of(mean.time) - spindle.time), 0.03e-3);
        DOUBLES_EQUAL(samples_per_rev, static_cast<double>(mean.samples), 1.0);
    }
}

TEST(RevolutionHarmonic, is_taken_once) {
    Spindle spindle;
    Harmonic harmonic(8192);
    CHECK_COMPARE(spindle.turn_for(harmonic, 1).revolutions, >=, 1);
    CHECK_EQUAL(0, harmonic.take().revolutions);
}

TEST(RevolutionHarmonic, a_revolution_that_is_not_seen_from_its_begin_does_not_count) {
    Spindle spindle;
    Harmonic harmonic(8192);
    spindle.last_rev = spindle.angle_rev(spindle.time_rev);
    for (int k = 0; k < 16; ++k) {  // over angle 0, and not to the next
        spindle.sample(harmonic);
    }
    CHECK_EQUAL(0, harmonic.take().revolutions);
    harmonic.restart();
    for (int k = 0; k < 8; ++k) {
        spindle.sample(harmonic);
    }
    CHECK_EQUAL(0, harmonic.take().revolutions);
}

TEST(RevolutionHarmonic, less_than_five_samples_say_nothing) {
    Spindle spindle{.samples_per_rev = 3.7};
    Harmonic harmonic(8192);
    CHECK_EQUAL(0, spindle.turn_for(harmonic, 50).revolutions);
}

TEST(RevolutionHarmonic, a_revolution_in_which_the_spindle_stood_does_not_count) {
    Spindle spindle;
    Harmonic harmonic(8192);
    CHECK_COMPARE(spindle.turn_for(harmonic, 3).revolutions, >=, 3);
    const double rev = spindle.last_rev - std::floor(spindle.last_rev);
    for (int k = 0; k < 50; ++k) {
        harmonic.add(1e-3F, 0.0F, static_cast<float>(rev), 5.0F);
    }
    while (spindle.last_rev - std::floor(spindle.last_rev) >= rev) {  // to the end of this revolution
        spindle.sample(harmonic);
    }
    CHECK_EQUAL(0, harmonic.take().revolutions);
    CHECK_COMPARE(spindle.turn_for(harmonic, 3).revolutions, >=, 3);
}

TEST(RevolutionHarmonic, states_how_far_an_encoder_of_whole_counts_is_off) {
    for (const double samples_per_rev : {7.31, 18.1}) {
        Spindle spindle{.samples_per_rev = samples_per_rev, .time = {}, .counts_per_rev = 512.0};
        Harmonic harmonic(512);
        double square_sum = 0.0;
        double stated = 0.0;
        int revolutions = 0;
        for (int r = 0; r < 3000; ++r) {
            const Harmonic::Mean mean = spindle.turn_for(harmonic, 1);
            harmonic.restart();
            square_sum += mean.revolutions * std::norm(of(mean.time)) / 2.0;
            revolutions += mean.revolutions > 0 ? 1 : 0;
            stated = std::pow(static_cast<double>(mean.time_sd), 2.0);
        }
        CHECK_COMPARE(revolutions, >, 1000);
        DOUBLES_EQUAL(1.0, square_sum / revolutions / stated, 0.5);
    }
}
