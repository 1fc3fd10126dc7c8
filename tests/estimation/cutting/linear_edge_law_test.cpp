// SPDX-License-Identifier: Apache-2.0
#include "estimation/cutting/cutting_law.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>

using namespace millforce::estimation;

namespace {

CuttingLaw<double> carbide_in_SM45C() {
    CuttingLaw<double> law;
    law.k_s_N_per_mm2 = 1007.59;
    law.p_s = -0.2557;
    law.k_1 = 0.2242;
    law.p_1 = -0.1546;
    return law;
}

CutConditions<double> four_flutes_8_mm(double radial_width_mm) {
    return {0.0496, 12.0, engagement_angles(CutSide::down, radial_width_mm / 4.0), 4.0};
}

// The force of one tooth at φ, summed over 20 000 discs of the engagement, per pitch.
AverageForces<double> integrated_forces(const CuttingLaw<double>& law, const CutConditions<double>& cut) {
    constexpr int steps = 20000;
    const double width = (cut.engagement.exit_rad - cut.engagement.entry_rad) / steps;
    const double t_a = mean_chip_thickness_mm(cut.feed_per_tooth_mm, cut.engagement);
    const double K_s = law.k_s_N_per_mm2 * std::pow(t_a, law.p_s);
    const double r_1 = law.k_1 * std::pow(t_a, law.p_1);
    AverageForces<double> sum;
    for (int k = 0; k < steps; ++k) {
        const double phi = cut.engagement.entry_rad + (k + 0.5) * width;
        const double area = cut.feed_per_tooth_mm * std::sin(phi) * cut.axial_depth_mm;
        const double F_t = K_s * area + law.K_te_N_per_mm * cut.axial_depth_mm;
        const double F_r = r_1 * K_s * area + law.K_re_N_per_mm * cut.axial_depth_mm;
        const double share = width * cut.teeth / (2.0 * pi<double>);
        sum.tangential_N += F_t * share;
        sum.feed_N += (F_t * std::cos(phi) + F_r * std::sin(phi)) * share;
        sum.normal_N += (-F_t * std::sin(phi) + F_r * std::cos(phi)) * share;
    }
    return sum;
}

}  // namespace

TEST_GROUP(CuttingLaw){};

TEST(CuttingLaw, gives_the_check_values_of_the_published_carbide_law) {
    struct Case {
        double radial_width_mm, F_at, F_ax, F_ay;
    };
    for (const Case& c : {Case{0.8, 221.92, -160.96, -176.06}, Case{4.0, 923.72, -184.36, -902.15},
                          Case{8.0, 1847.44, 555.00, -1450.98}}) {
        const auto forces = average_forces(carbide_in_SM45C(), four_flutes_8_mm(c.radial_width_mm));
        DOUBLES_EQUAL(c.F_at, forces.tangential_N, 0.006);
        DOUBLES_EQUAL(c.F_ax, forces.feed_N, 0.006);
        DOUBLES_EQUAL(c.F_ay, forces.normal_N, 0.006);
    }
    const auto cut = four_flutes_8_mm(0.8);
    const double t_a = mean_chip_thickness_mm(cut.feed_per_tooth_mm, cut.engagement);
    const auto coefficients = cutting_coefficients(carbide_in_SM45C(), t_a);
    DOUBLES_EQUAL(0.0154, t_a, 0.00005);
    DOUBLES_EQUAL(2928.0, coefficients.K_s_N_per_mm2, 0.5);
    DOUBLES_EQUAL(0.427, coefficients.r_1, 0.0005);
}

TEST(CuttingLaw, agrees_with_integration_over_any_entry_and_exit_with_edge_forces) {
    CuttingLaw<double> law = carbide_in_SM45C();
    law.K_te_N_per_mm = 23.0;
    law.K_re_N_per_mm = 31.0;
    for (double entry = 0.0; entry < 3.0; entry += 0.37) {
        for (double exit = entry + 0.1; exit <= pi<double>; exit += 0.41) {
            const CutConditions<double> cut{0.08, 3.0, {entry, exit}, 3.0};
            const auto closed = average_forces(law, cut);
            const auto summed = integrated_forces(law, cut);
            const double tolerance = 1e-6 * summed.tangential_N;
            DOUBLES_EQUAL(summed.tangential_N, closed.tangential_N, tolerance);
            DOUBLES_EQUAL(summed.feed_N, closed.feed_N, tolerance);
            DOUBLES_EQUAL(summed.normal_N, closed.normal_N, tolerance);
        }
    }
}

TEST(CuttingLaw, holds_the_linear_edge_law_as_a_special_case) {
    const auto law = linear_edge_law(600.0, 4.0, 200.0, 5.0);
    const CutConditions<double> cut{0.05, 1.0, {0.3, 2.1}, 3.0};
    const auto i = engagement_integrals(cut.engagement);
    const double per_pitch = 3.0 / (2.0 * pi<double>);
    DOUBLES_EQUAL((600.0 * 0.05 * i.c + 4.0 * 1.8) * per_pitch, average_forces(law, cut).tangential_N, 1e-12);
    DOUBLES_EQUAL((0.05 * (600.0 * i.s + 200.0 * i.b) + 4.0 * i.d + 5.0 * i.c) * per_pitch,
                  average_forces(law, cut).feed_N, 1e-12);
}

TEST(CuttingLaw, in_float_keeps_five_digits_down_to_a_thousandth_of_the_radius) {
    const auto law = carbide_in_SM45C();
    CuttingLaw<float> narrow;
    narrow.k_s_N_per_mm2 = 1007.59F;
    narrow.p_s = -0.2557F;
    narrow.k_1 = 0.2242F;
    narrow.p_1 = -0.1546F;
    for (const double entry : {0.0, 0.5, 1.5, 2.5}) {
        for (const double delta : {0.0447, 0.2, 0.6}) {
            const EngagementAngles<float> angles{static_cast<float>(entry), static_cast<float>(entry + delta)};
            const EngagementAngles<double> same{static_cast<double>(angles.entry_rad),
                                                static_cast<double>(angles.exit_rad)};
            const auto wide = average_forces(law, {0.0496, 12.0, same, 4.0});
            const auto slim = average_forces(narrow, {0.0496F, 12.0F, angles, 4.0F});
            DOUBLES_EQUAL(1.0, static_cast<double>(slim.tangential_N) / wide.tangential_N, 1e-5);
            DOUBLES_EQUAL(wide.feed_N, static_cast<double>(slim.feed_N), 1e-5 * wide.tangential_N);
            DOUBLES_EQUAL(wide.normal_N, static_cast<double>(slim.normal_N), 1e-5 * wide.tangential_N);
        }
    }
}

TEST(CuttingLaw, doubts_a_force_more_the_further_the_chip_is_from_the_calibrated_one) {
    CuttingLaw<double> law = carbide_in_SM45C();
    law.K_s_relative_sd = 0.02;
    law.K_s_exponent_sd = 0.1;
    law.r_1_relative_sd = 0.03;
    law.reference_chip_thickness_mm = mean_chip_thickness_mm(0.05, EngagementAngles<double>{0.0, pi<double>});
    const CutConditions<double> at{0.05, 2.0, {0.0, pi<double>}, 4.0};
    CutConditions<double> thin = at;
    thin.feed_per_tooth_mm = 0.005;
    const auto calibrated = average_forces_with_doubt(law, at);
    const auto beyond = average_forces_with_doubt(law, thin);
    DOUBLES_EQUAL(0.02, calibrated.standard_deviation.tangential_N / calibrated.mean.tangential_N, 1e-12);
    DOUBLES_EQUAL(std::hypot(0.02, 0.1 * std::log(10.0)),
                  beyond.standard_deviation.tangential_N / beyond.mean.tangential_N, 1e-12);
    // F_ax depends on both coefficients.
    const auto& x = calibrated.per_ln_K_s.feed_N;
    DOUBLES_EQUAL(std::hypot(0.02 * x, 0.03 * calibrated.per_ln_r_1.feed_N), calibrated.standard_deviation.feed_N,
                  1e-9);
}

TEST(CuttingLaw, is_silent_where_nothing_is_cut) {
    const auto law = carbide_in_SM45C();
    for (const CutConditions<double>& cut :
         {CutConditions<double>{0.05, 2.0, {1.0, 1.0}, 4.0}, CutConditions<double>{0.0, 2.0, {0.0, 1.0}, 4.0},
          CutConditions<double>{0.05, 2.0, {2.0, 1.0}, 4.0}, CutConditions<double>{0.05, 0.0, {0.0, 1.0}, 4.0}}) {
        const auto forces = average_forces(law, cut);
        DOUBLES_EQUAL(0.0, forces.tangential_N, 0.0);
        DOUBLES_EQUAL(0.0, forces.feed_N, 0.0);
        DOUBLES_EQUAL(0.0, forces.normal_N, 0.0);
    }
}
