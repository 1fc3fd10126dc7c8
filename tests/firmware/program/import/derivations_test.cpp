// SPDX-License-Identifier: Apache-2.0
#include "import/derivations.hpp"

#include <functional>
#include <vector>

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <numbers>

using namespace millforce::host;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double turn = 2.0 * std::numbers::pi;

std::deque<Sample> derived(SampleDerivation& derivation, const std::vector<Sample>& samples) {
    std::deque<Sample> out;
    for (const Sample& sample : samples) {
        derivation.add(sample, out);
    }
    derivation.finish(out);
    return out;
}

std::vector<Sample> sampled(double step_s, std::size_t count, const std::function<double(double)>& value) {
    std::vector<Sample> samples;
    for (std::size_t k = 0; k < count; ++k) {
        const double time_s = step_s * static_cast<double>(k);
        samples.push_back({time_s, value(time_s)});
    }
    return samples;
}

/// Each sample comes out once, with its time.
void check_times(const std::vector<Sample>& in, const std::deque<Sample>& out) {
    LONGS_EQUAL(in.size(), out.size());
    for (std::size_t k = 0; k < in.size(); ++k) {
        DOUBLES_EQUAL(in[k].time_s, out[k].time_s, 0.0);
    }
}

}  // namespace

TEST_GROUP(Derivations){};

TEST(Derivations, the_slope_of_a_parabola_is_exact_in_the_middle_and_missing_at_the_ends) {
    const auto positions = sampled(0.001, 50, [](double t) { return 3.0 + 20.0 * t + 400.0 * t * t; });
    PositionSlope slope(0.006);
    const auto velocities = derived(slope, positions);
    check_times(positions, velocities);
    for (std::size_t k = 1; k + 1 < velocities.size(); ++k) {
        DOUBLES_EQUAL(20.0 + 800.0 * positions[k].time_s, velocities[k].value, 1e-9);
    }
    CHECK(std::isnan(velocities.front().value));
    CHECK(std::isnan(velocities.back().value));
}

TEST(Derivations, a_count_costs_the_slope_no_more_than_a_count_over_its_time) {
    constexpr double count_mm = 0.001;
    constexpr double velocity_mm_s = 20.3;
    const auto positions =
        sampled(0.001, 200, [](double t) { return count_mm * std::floor(velocity_mm_s * t / count_mm); });
    const auto worst_error = [&](double smoothing_s) {
        PositionSlope slope(smoothing_s);
        double worst = 0.0;
        for (const Sample& velocity : derived(slope, positions)) {
            const bool is_whole = velocity.time_s > 0.011 && velocity.time_s < 0.188;
            worst = is_whole ? std::max(worst, std::abs(velocity.value - velocity_mm_s)) : worst;
        }
        return worst;
    };
    CHECK(worst_error(0.020) <= count_mm / 0.020 + 1e-9);
    CHECK(worst_error(0.002) > count_mm / 0.020);
}

TEST(Derivations, no_slope_reaches_over_a_gap_or_a_missing_value) {
    std::vector<Sample> positions;
    for (int k = 0; k < 40; ++k) {
        const double time_s = 0.001 * k + (k >= 20 ? 1.0 : 0.0);
        positions.push_back({time_s, k < 20 ? 5.0 : 500.0});
    }
    positions[10].value = none;
    PositionSlope slope(0.006);
    const auto velocities = derived(slope, positions);
    for (const Sample& velocity : velocities) {
        CHECK(std::isnan(velocity.value) || velocity.value == 0.0);
    }
    CHECK(std::isnan(velocities[10].value));
    CHECK(std::isnan(velocities[19].value));
    CHECK(std::isnan(velocities[20].value));
    DOUBLES_EQUAL(0.0, velocities[15].value, 0.0);
}

TEST(Derivations, a_slope_holds_no_more_samples_than_its_time_has) {
    PositionSlope slope(0.010);
    std::deque<Sample> out;
    for (int k = 0; k < 1000; ++k) {
        slope.add({0.001 * k, 1.0 * k}, out);
        CHECK(0.001 * k - slope.waits_since_s() <= 0.0051);
    }
    CHECK(out.size() >= 994);
}

TEST(Derivations, a_ramp_of_speed_is_integrated_exactly) {
    const auto speeds = sampled(0.002, 100, [](double t) { return 100.0 + 50.0 * t; });
    SpeedIntegral integral;
    const auto angles = derived(integral, speeds);
    check_times(speeds, angles);
    const double end_s = speeds.back().time_s;
    DOUBLES_EQUAL(100.0 * end_s + 25.0 * end_s * end_s, angles.back().value, 1e-9);
}

TEST(Derivations, a_missing_speed_has_no_angle_and_does_not_stop_the_integral) {
    SpeedIntegral integral;
    const auto angles = derived(integral, {{0.0, 10.0}, {0.1, none}, {0.2, 10.0}});
    CHECK(std::isnan(angles[1].value));
    DOUBLES_EQUAL(2.0, angles[2].value, 1e-12);
}

TEST(Derivations, pulses_give_a_turn_each_and_nothing_outside_of_them) {
    // 50 turns per second, 100 samples each; the pulse is high for 3 samples.
    const auto levels = sampled(0.0002, 1000, [](double t) {
        return std::lround(t / 0.0002) % 100 >= 10 && std::lround(t / 0.0002) % 100 < 13 ? 5.0 : 0.1;
    });
    IndexAngle index(2.5);
    const auto angles = derived(index, levels);
    check_times(levels, angles);
    for (std::size_t k = 0; k < angles.size(); ++k) {
        const bool is_between_pulses = k >= 10 && k < 910;
        CHECK_EQUAL(is_between_pulses, !std::isnan(angles[k].value));
        if (is_between_pulses) {
            DOUBLES_EQUAL(turn * static_cast<double>(k - 10) / 100.0, angles[k].value, 1e-9);
        }
    }
}

TEST(Derivations, a_spindle_at_rest_has_no_angle_and_holds_two_seconds_at_most) {
    IndexAngle index(0.5);
    std::deque<Sample> out;
    for (int k = 0; k < 10'000; ++k) {
        const double time_s = 0.001 * k;
        index.add({time_s, k == 5 || k == 105 ? 1.0 : 0.0}, out);
        CHECK(time_s - index.waits_since_s() <= IndexAngle::longest_turn_s + 1e-9);
    }
    DOUBLES_EQUAL(0.5 * turn, out[55].value, 1e-9);
    CHECK(std::isnan(out[4].value));
    CHECK(std::isnan(out[105].value));
    CHECK(std::isnan(out[5000].value));
}

TEST(Derivations, a_counter_of_16_bits_goes_on_both_ways) {
    Unwrap unwrap(65536.0);
    double last = 65000.0;
    for (const double raw : {65000.0, 200.0, 1000.0, 64000.0, none, 63000.0}) {
        double value = raw;
        CHECK(unwrap.follow(value));
        CHECK(std::isnan(raw) || std::abs(value - last) <= 3000.0);
        last = std::isnan(raw) ? last : value;
    }
    DOUBLES_EQUAL(63000.0, last, 0.0);
}

TEST(Derivations, a_jump_beyond_the_wrap_is_no_counter_that_begins_again) {
    Unwrap unwrap(360.0);
    double value = 10.0;
    CHECK(unwrap.follow(value));
    value = 900.0;
    CHECK(!unwrap.follow(value));
}
