// SPDX-License-Identifier: Apache-2.0
#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "closed_form_average.hpp"
#include "cutting/angle_units.hpp"
#include "cutting/revolution_load.hpp"
#include "random_numbers.hpp"

using namespace millforce::sim;

namespace {

constexpr double pi = std::numbers::pi;

struct RandomCut {
    Cutter cutter;
    CuttingCoefficients coefficients;
    double entry_rad;
    double exit_rad;
    double axial_depth_mm;
    double feed_per_tooth_mm;
};

RandomCut random_cut(RandomNumbers& random) {
    RandomCut cut;
    cut.cutter.teeth = random.whole(1, 12);
    cut.cutter.diameter_mm = random.between(3.0, 80.0);
    cut.cutter.helix_rad = random.between(0.0, 55.0) * degree;
    cut.axial_depth_mm = random.between(0.02, 1.5) * cut.cutter.diameter_mm;
    cut.cutter.flute_length_mm = cut.axial_depth_mm * random.between(1.0, 2.0);
    cut.coefficients = {.K_tc_N_mm2 = random.between(500.0, 3000.0),
                        .K_rc_N_mm2 = random.between(100.0, 1500.0),
                        .K_ac_N_mm2 = random.between(-100.0, 800.0),
                        .K_te_N_mm = random.between(0.0, 40.0),
                        .K_re_N_mm = random.between(0.0, 40.0),
                        .K_ae_N_mm = random.between(0.0, 5.0)};
    cut.feed_per_tooth_mm = random.between(0.01, 0.3);
    const double immersion_rad = std::acos(1.0 - random.between(0.02, 1.98));
    switch (random.whole(0, 3)) {
        case 0:  // up
            cut.entry_rad = 0.0;
            cut.exit_rad = immersion_rad;
            break;
        case 1:  // down
            cut.entry_rad = pi - immersion_rad;
            cut.exit_rad = pi;
            break;
        case 2:  // slot
            cut.entry_rad = 0.0;
            cut.exit_rad = pi;
            break;
        default: {  // face milling, the cutter beside the workpiece's middle
            const double one = random.between(0.0, pi);
            const double other = random.between(0.0, pi);
            cut.entry_rad = std::min(one, other);
            cut.exit_rad = std::max({one, other, cut.entry_rad + 3.0 * degree});
        }
    }
    return cut;
}

/// Kim & Chung's published conditions: N 4, D 8 mm, a_p 12 mm, f_z 0.0496 mm, down milling, carbide in SM45C.
struct PublishedCut {
    double tangential_N;
    double fx_N;
    double fy_N;
    CuttingCoefficients coefficients;
};

PublishedCut numeric_average(double radial_width_mm) {
    constexpr AverageChipLaw carbide{.k_s = 1007.59, .p_s = -0.2557, .k_1 = 0.2242, .p_1 = -0.1546};
    constexpr double feed_per_tooth_mm = 0.0496;
    Cutter cutter;
    cutter.diameter_mm = 8.0;
    cutter.flute_length_mm = 12.0;
    cutter.helix_rad = 30.0 * degree;
    const double immersion_rad = std::acos(1.0 - radial_width_mm / 4.0);
    const double average_chip_mm = feed_per_tooth_mm * (radial_width_mm / 4.0) / immersion_rad;
    const CuttingCoefficients coefficients = coefficients_at(carbide, average_chip_mm);
    const CuttingForce force(cutter, coefficients, {.chip_model = ChipModel::circular});
    const RevolutionLoad load =
        revolution_load(force, feed_per_tooth_mm, uniform_engagement(pi - immersion_rad, pi, 12.0));
    return {1e3 * load.mean_torque_Nm / 4.0, load.mean_fx_N, load.mean_fy_N, coefficients};
}

}  // namespace

TEST_GROUP(PlantAgainstClosedForm){};

TEST(PlantAgainstClosedForm, averages_of_400_random_cuts_agree_to_a_thousandth) {
    RandomNumbers random(20240611);
    double worst = 0.0;
    for (int i = 0; i < 400; ++i) {
        const RandomCut cut = random_cut(random);
        const CuttingForce force(cut.cutter, cut.coefficients, {.chip_model = ChipModel::circular});
        const RevolutionLoad plant = revolution_load(
            force, cut.feed_per_tooth_mm, uniform_engagement(cut.entry_rad, cut.exit_rad, cut.axial_depth_mm));
        const ClosedFormAverage exact = closed_form_average(cut.cutter, cut.coefficients, cut.entry_rad, cut.exit_rad,
                                                            cut.axial_depth_mm, cut.feed_per_tooth_mm);
        const double resultant_N = std::hypot(exact.fx_N, exact.fy_N);
        const double deviation = std::max({std::abs(plant.mean_fx_N - exact.fx_N) / resultant_N,
                                           std::abs(plant.mean_fy_N - exact.fy_N) / resultant_N,
                                           std::abs(plant.mean_fz_N - exact.fz_N) / resultant_N,
                                           std::abs(plant.mean_torque_Nm - exact.torque_Nm) / exact.torque_Nm});
        worst = std::max(worst, deviation);
    }
    UT_PRINT(StringFromFormat("largest deviation of an average over 400 cuts: %.2e", worst).asCharString());
    CHECK(worst < 1e-3);
    CHECK(worst > 1e-9);  // exact agreement would mean that the plant uses the closed form
}

TEST(PlantAgainstClosedForm, published_conditions_at_a_tenth_of_the_diameter) {
    const PublishedCut cut = numeric_average(0.8);
    DOUBLES_EQUAL(2928.0, cut.coefficients.K_tc_N_mm2, 1.0);
    DOUBLES_EQUAL(0.427, cut.coefficients.K_rc_N_mm2 / cut.coefficients.K_tc_N_mm2, 5e-4);
    DOUBLES_EQUAL(221.92, cut.tangential_N, 0.22);
    DOUBLES_EQUAL(-160.96, cut.fx_N, 0.22);
    DOUBLES_EQUAL(-176.06, cut.fy_N, 0.22);
}

TEST(PlantAgainstClosedForm, published_conditions_at_half_the_diameter) {
    const PublishedCut cut = numeric_average(4.0);
    DOUBLES_EQUAL(923.72, cut.tangential_N, 0.92);
    DOUBLES_EQUAL(-184.36, cut.fx_N, 0.92);
    DOUBLES_EQUAL(-902.15, cut.fy_N, 0.92);
}

TEST(PlantAgainstClosedForm, published_conditions_in_a_slot) {
    const PublishedCut cut = numeric_average(8.0);
    DOUBLES_EQUAL(1847.44, cut.tangential_N, 1.5);
    DOUBLES_EQUAL(555.00, cut.fx_N, 1.5);
    DOUBLES_EQUAL(-1450.98, cut.fy_N, 1.5);
}

TEST(PlantAgainstClosedForm, helix_alone_does_not_change_the_averages) {
    const CuttingCoefficients coefficients{.K_tc_N_mm2 = 1800.0, .K_rc_N_mm2 = 700.0, .K_te_N_mm = 20.0};
    const EngagementMap map = uniform_engagement(100.3 * degree, 161.7 * degree, 7.0);
    Cutter cutter;
    const RevolutionLoad straight = revolution_load(CuttingForce(cutter, coefficients, {}), 0.08, map);
    for (const double helix_deg : {5.0, 30.0, 45.0, 55.0}) {
        cutter.helix_rad = helix_deg * degree;
        const RevolutionLoad helical = revolution_load(CuttingForce(cutter, coefficients, {}), 0.08, map);
        const double resultant_N = std::hypot(straight.mean_fx_N, straight.mean_fy_N);
        DOUBLES_EQUAL(straight.mean_fx_N, helical.mean_fx_N, 5e-4 * resultant_N);
        DOUBLES_EQUAL(straight.mean_fy_N, helical.mean_fy_N, 5e-4 * resultant_N);
        DOUBLES_EQUAL(straight.mean_torque_Nm, helical.mean_torque_Nm, 5e-4 * straight.mean_torque_Nm);
        CHECK(helical.peak_total_N < straight.peak_total_N);  // the peak does change
    }
}

TEST(PlantAgainstClosedForm, energy_of_a_turn_is_pressure_times_the_volume_removed) {
    const CuttingCoefficients coefficients{.K_tc_N_mm2 = 2000.0, .K_rc_N_mm2 = 800.0};
    Cutter cutter;
    cutter.helix_rad = 40.0 * degree;
    const CuttingForce force(cutter, coefficients, {.chip_model = ChipModel::circular});
    const double entry_rad = 40.0 * degree;
    const double exit_rad = 130.0 * degree;
    const RevolutionLoad load = revolution_load(force, 0.1, uniform_engagement(entry_rad, exit_rad, 4.0));
    const double width_mm = 5.0 * (std::cos(entry_rad) - std::cos(exit_rad));
    const double volume_mm3 = width_mm * 4.0 * (4.0 * 0.1);
    DOUBLES_EQUAL(2000.0 * volume_mm3, 1e3 * load.mean_torque_Nm * 2.0 * pi, 5e-4 * 2000.0 * volume_mm3);
}
