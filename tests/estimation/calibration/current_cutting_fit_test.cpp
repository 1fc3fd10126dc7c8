// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/current_cutting_fit.hpp"

#include "estimation/fit_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

using namespace millforce::estimation;
using millforce::test::Coverage;
using millforce::test::Noise;

namespace {

constexpr double k_s = 831.16;
constexpr double p_s = -0.2749;
constexpr double k_1 = 0.1526;
constexpr double p_1 = -0.2227;

CuttingLaw<double> hss() {
    CuttingLaw<double> law;
    law.k_s_N_per_mm2 = k_s;
    law.p_s = p_s;
    law.k_1 = k_1;
    law.p_1 = p_1;
    return law;
}

/// Forces as drives with gains wrong by these shares would show them.
std::vector<CuttingMeasurement> cuts(double tangential_share, double feed_share, double sd_N, Noise& noise) {
    std::vector<CuttingMeasurement> result;
    for (const double f_z : {0.02, 0.05, 0.14}) {
        for (const double width_mm : {0.2, 0.8, 2.0}) {
            CuttingMeasurement m;
            m.cut = {f_z, 12.0, engagement_angles(CutSide::down, width_mm / 4.0), 4.0};
            const auto forces = average_forces(hss(), m.cut);
            m.tangential_N = forces.tangential_N * (1.0 + tangential_share) + noise.normal(sd_N);
            m.feed_N = forces.feed_N * (1.0 + feed_share) + noise.normal(sd_N);
            result.push_back(m);
        }
    }
    return result;
}

CuttingFit fit(const std::vector<CuttingMeasurement>& of, const DriveGainDoubt& doubt) {
    CuttingFitOptions options;
    options.form = CuttingLawForm::power;
    options.error_floor = 1.0;
    return fit_cutting_law_from_currents(of, doubt, options);
}

}  // namespace

TEST_GROUP(CurrentCuttingFit) {
    Noise noise{3};
};

TEST(CurrentCuttingFit, exact_forces_give_the_exact_law) {
    const auto found = fit(cuts(0.0, 0.0, 0.0, noise), {});
    DOUBLES_EQUAL(k_s, found.law.k_s_N_per_mm2, 0.01 * k_s);
    DOUBLES_EQUAL(p_s, found.law.p_s, 1e-3);
    DOUBLES_EQUAL(k_1, found.law.k_1, 0.01 * k_1);
    DOUBLES_EQUAL(p_1, found.law.p_1, 5e-3);
}

TEST(CurrentCuttingFit, standard_errors_cover_gains_that_are_wrong_for_all_cuts) {
    Coverage coverage;
    for (int k = 0; k < 300; ++k) {
        const double shared = noise.normal(0.03);
        const auto found =
            fit(cuts(shared + noise.normal(0.01), shared + noise.normal(0.015), 1.0, noise), {0.01, 0.015, 0.03});
        coverage.add(k_s, found.law.k_s_N_per_mm2, found.k_s_standard_error(), 1.96);
        coverage.add(k_1, found.law.k_1, found.k_1_standard_error(), 1.96);
    }
    CHECK(coverage.percent() > 90.0);
}

TEST(CurrentCuttingFit, a_doubt_that_both_gains_share_is_one_of_K_s_and_hardly_of_r_1) {
    const auto of = cuts(0.0, 0.0, 0.5, noise);
    const auto without = fit(of, {});
    const auto with = fit(of, {0.0, 0.0, 0.05});
    DOUBLES_EQUAL(0.05, with.standard_error(cutting_ln_K_s), 0.005);
    DOUBLES_EQUAL(without.standard_error(cutting_r_1), with.standard_error(cutting_r_1), 1e-3);
    DOUBLES_EQUAL(0.05, with.law.K_s_relative_sd, 0.01);
}

TEST(CurrentCuttingFit, one_chip_thickness_cannot_tell_an_exponent) {
    std::vector<CuttingMeasurement> same;
    for (int k = 0; k < 6; ++k) {
        same.push_back(cuts(0.0, 0.0, 0.5, noise)[4]);
    }
    const auto found = fit(same, {});
    CHECK(!found.determined(cutting_p_s));
    CHECK(!found.determined(cutting_p_1));
}
