// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/warm_up_fit.hpp"

#include "estimation/fit_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

using namespace millforce::estimation;
using millforce::test::Coverage;
using millforce::test::Noise;

namespace {

constexpr double warm_Nm = 0.95;
constexpr double cold_Nm = 0.33;
constexpr double tau_s = 240.0;

std::vector<IdleTorque> idle(double duration_s, double excess_Nm, Noise& noise, double sd_Nm = 0.003) {
    std::vector<IdleTorque> record;
    for (double t = 0.5; t < duration_s; t += 1.0) {
        record.push_back({t, warm_Nm + excess_Nm * std::exp(-(t - 0.5) / tau_s) + noise.normal(sd_Nm)});
    }
    return record;
}

void lacks(WarmUpLack lack, const std::vector<IdleTorque>& record) {
    LONGS_EQUAL(static_cast<int>(lack), static_cast<int>(fit_warm_up(record).lack));
}

}  // namespace

TEST_GROUP(WarmUpFit) {
    Noise noise{2};
};

TEST(WarmUpFit, an_exact_record_gives_the_exact_curve) {
    const auto fit = fit_warm_up(idle(720.0, cold_Nm, noise, 0.0));
    LONGS_EQUAL(static_cast<int>(WarmUpLack::nothing), static_cast<int>(fit.lack));
    DOUBLES_EQUAL(tau_s, fit.time_constant_s, 0.01);
    DOUBLES_EQUAL(cold_Nm, fit.excess_Nm, 1e-5);
    DOUBLES_EQUAL(warm_Nm, fit.warm_Nm, 1e-5);
}

TEST(WarmUpFit, standard_errors_cover) {
    Coverage coverage;
    for (int k = 0; k < 150; ++k) {
        const auto fit = fit_warm_up(idle(720.0, cold_Nm, noise));
        coverage.add(tau_s, fit.time_constant_s, fit.time_constant_se_s, 1.96);
        coverage.add(cold_Nm, fit.excess_Nm, fit.excess_se_Nm, 1.96);
        coverage.add(warm_Nm, fit.warm_Nm, fit.warm_se_Nm, 1.96);
    }
    DOUBLES_EQUAL(95.0, coverage.percent(), 4.0);
}

TEST(WarmUpFit, a_record_that_does_not_bend_is_too_short) {
    lacks(WarmUpLack::duration, idle(60.0, cold_Nm, noise));
    lacks(WarmUpLack::duration, idle(240.0, cold_Nm, noise));
    lacks(WarmUpLack::nothing, idle(600.0, cold_Nm, noise));
}

TEST(WarmUpFit, a_warm_spindle_has_no_excess_to_fit) {
    lacks(WarmUpLack::excess, idle(720.0, 0.0, noise));
    lacks(WarmUpLack::excess, idle(720.0, -0.3, noise));
}

TEST(WarmUpFit, a_handful_of_samples_is_no_record) {
    lacks(WarmUpLack::samples, idle(10.0, cold_Nm, noise));
    lacks(WarmUpLack::samples, {});
}
