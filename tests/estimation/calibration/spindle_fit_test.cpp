// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/spindle_fit.hpp"

#include "estimation/fit_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <array>
#include <vector>

using namespace millforce::estimation;
using millforce::test::Coverage;
using millforce::test::Noise;

namespace {

struct Drive {
    double K_t1 = 1.4, K_t2 = -0.6, slope = 0.002, inertia = 0.02, base_speed = 157.0;
};

/// Current of the drive under a known torque; the noise is on the torque that the user knows.
SpindleSample sample(const Drive& d, double speed, double acceleration, double torque, double error) {
    const double gain = d.base_speed > 0.0 && speed > d.base_speed ? d.base_speed / speed : 1.0;
    return {(torque - d.K_t2 + d.slope * speed + d.inertia * acceleration) / (d.K_t1 * gain), speed, acceleration,
            torque + error};
}

std::vector<SpindleSample> cuts(const Drive& d, std::initializer_list<double> speeds, Noise& noise, double sd) {
    std::vector<SpindleSample> samples;
    for (const double speed : speeds) {
        for (const double torque : {0.0, 0.0, 2.0, 4.0, 6.0, 8.0}) {
            samples.push_back(sample(d, speed, noise.uniform(-40, 40), torque, noise.normal(sd)));
        }
    }
    return samples;
}

}  // namespace

TEST_GROUP(SpindleFit){};

TEST(SpindleFit, finds_all_five_parameters_with_honest_standard_errors) {
    const Drive drive;
    const std::array<double, 5> truth{1.4, -0.6, 0.002, 0.02, 157.0};
    std::array<Coverage, 5> coverage;
    Noise noise(21);
    for (int repetition = 0; repetition < 1000; ++repetition) {
        const auto samples = cuts(drive, {60, 90, 120, 220, 300, 400}, noise, 0.05);
        const auto fit = fit_spindle(samples, {true, true, true});
        for (int j = 0; j < spindle_parameter_count; ++j) {
            const auto index = static_cast<std::size_t>(j);
            coverage[index].add(truth[index], fit.solution.parameters(j), fit.solution.standard_error(j),
                                millforce::test::student_t_95(31));
        }
    }
    for (const Coverage& c : coverage) {
        CHECK(c.percent() > 93.0 && c.percent() < 97.0);
    }
}

TEST(SpindleFit, sees_no_field_weakening_where_there_is_none) {
    Drive drive;
    drive.base_speed = 0.0;
    Noise noise(22);
    int seen = 0;
    for (int repetition = 0; repetition < 200; ++repetition) {
        const auto fit = fit_spindle(cuts(drive, {60, 120, 240, 400}, noise, 0.05), {true, true, true});
        seen += fit.solution.parameters(spindle_base_speed) > 0.0 ? 1 : 0;
    }
    CHECK(seen <= 4);  // one in a thousand per candidate speed
}

TEST(SpindleFit, above_the_base_speed_alone_knows_power_and_says_that_nothing_is_known_below) {
    const Drive drive;
    Noise noise(23);
    int said = 0;
    for (int repetition = 0; repetition < 200; ++repetition) {
        const auto fit = fit_spindle(cuts(drive, {200, 300, 400}, noise, 0.02), {true, true, true});
        said += fit.nothing_below_base_speed ? 1 : 0;
        const double power = fit.solution.parameters(spindle_K_t1) * fit.solution.parameters(spindle_base_speed);
        DOUBLES_EQUAL(1.4 * 157.0, power, 0.03 * 1.4 * 157.0);
    }
    CHECK(said >= 196);  // one in a thousand per candidate speed
}

TEST(SpindleFit, without_load_cannot_tell_the_torque_constant) {
    std::vector<SpindleSample> samples(10, SpindleSample{2.0, 100.0, 0.0, 0.0});
    const auto fit = fit_spindle(samples, {});
    CHECK(!fit.solution.determined(spindle_K_t1));
    CHECK(!fit.solution.determined(spindle_K_t2));
}

TEST(SpindleFit, recovers_the_published_spindle) {
    // Kim & Chung Eq. 8 as forces: F_at = 196.61 I − 1911.0.
    std::vector<SpindleSample> samples;
    for (const double current : {9.72, 11.0, 13.0, 15.0}) {
        samples.push_back({current, 131.9, 0.0, 196.61 * current - 1911.0});
    }
    const auto fit = fit_spindle(samples, {});
    DOUBLES_EQUAL(196.61, fit.solution.parameters(spindle_K_t1), 1e-8);
    DOUBLES_EQUAL(-1911.0, fit.solution.parameters(spindle_K_t2), 1e-6);
}

TEST(SpindleFit, of_samples_rounded_to_float_is_the_same_within_a_tenth_of_its_standard_errors) {
    const Drive drive;
    Noise noise(24);
    const auto samples = cuts(drive, {60, 90, 120, 220, 300, 400}, noise, 0.05);
    const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    std::vector<SpindleSample> coarse;
    std::transform(samples.begin(), samples.end(), std::back_inserter(coarse), [&](const SpindleSample& s) {
        return SpindleSample{rounded(s.current_A), rounded(s.speed_rad_s), rounded(s.acceleration_rad_s2),
                             rounded(s.torque_Nm)};
    });
    const auto exact = fit_spindle(samples, {true, true, true});
    const auto from_coarse = fit_spindle(coarse, {true, true, true});
    for (int j = 0; j < spindle_parameter_count; ++j) {
        DOUBLES_EQUAL(exact.solution.parameters(j), from_coarse.solution.parameters(j),
                      0.1 * exact.solution.standard_error(j));
    }
}

TEST(SpindleFit, without_outliers_is_as_good_as_without_them_from_the_start) {
    const Drive drive;
    Noise noise(25);
    for (int repetition = 0; repetition < 5; ++repetition) {
        auto samples = cuts(drive, {60, 90, 120, 220, 300, 400}, noise, 0.05);
        const auto clean = fit_spindle(samples, {true, true, true});
        std::vector<std::size_t> spoilt;
        for (std::size_t k = 3; k < samples.size(); k += 17) {
            samples[k].current_A += noise.uniform(0.0, 1.0) < 0.5 ? 25.0 : -25.0;
            spoilt.push_back(k);
        }
        const auto trimmed = fit_spindle_without_outliers(samples, {true, true, true});
        CHECK(trimmed.outliers == spoilt);
        for (int j = 0; j < spindle_parameter_count; ++j) {
            DOUBLES_EQUAL(clean.solution.parameters(j), trimmed.fit.solution.parameters(j),
                          2.0 * clean.solution.standard_error(j));
        }
    }
}

TEST(SpindleFit, leaves_no_sample_out_where_there_is_no_outlier) {
    const Drive drive;
    Noise noise(26);
    std::size_t left_out = 0;
    for (int repetition = 0; repetition < 20; ++repetition) {
        const auto samples = cuts(drive, {60, 90, 120, 220, 300, 400}, noise, 0.05);
        left_out += fit_spindle_without_outliers(samples, {true, true, true}).outliers.size();
    }
    CHECK(left_out <= 4);  // of 720 samples
}
