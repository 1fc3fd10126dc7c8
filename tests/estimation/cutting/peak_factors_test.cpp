// SPDX-License-Identifier: Apache-2.0
#include "estimation/cutting/peak_factors.hpp"

#include "estimation/four_flutes.hpp"
#include "estimation/laws.hpp"
#include "host_test.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>

using namespace millforce::estimation;
using millforce::tests::carbide_in_SM45C;

namespace {

PeakFactorSettings<double> four_flutes(double helix_deg = 30.0) {
    PeakFactorSettings<double> s = millforce::tests::peaks_of_four_flutes<double>();
    s.helix_rad = helix_deg * pi<double> / 180.0;
    return s;
}

/// κ and τ by summing discs: no antiderivative, no shared code with the closed form.
PeakFactors<double> summed_factors(const PeakFactorSettings<double>& s, double immersion, double depth_mm) {
    const auto law = carbide_in_SM45C<double>();
    const auto cut = engagement_angles(s.side, immersion);
    const double t_a = mean_chip_thickness_mm(s.nominal_feed_per_tooth_mm, cut);
    const double r_1 = law.k_1 * std::pow(t_a, law.p_1);
    constexpr int discs = 600;
    constexpr int angles = 180;  // over one pitch: the next pitch repeats it
    double largest_tooth = 0.0;
    double largest_total = 0.0;
    double mean_tangential = 0.0;
    for (int a = 0; a < angles; ++a) {
        double total_x = 0.0;
        double total_y = 0.0;
        for (int tooth = 0; tooth < 4; ++tooth) {
            double x = 0.0;
            double y = 0.0;
            for (int disc = 0; disc < discs; ++disc) {
                const double z = (disc + 0.5) / discs * depth_mm;
                const double lag = z * std::tan(s.helix_rad) / s.cutter_radius_mm;
                const double phi =
                    std::remainder(0.5 * pi<double> * a / angles + tooth * pi<double> / 2.0 - lag - pi<double>,
                                   2.0 * pi<double>) +
                    pi<double>;
                if (phi < cut.entry_rad || phi > cut.exit_rad) {
                    continue;
                }
                const double F_t = std::sin(phi) / discs;
                x += F_t * (std::cos(phi) + r_1 * std::sin(phi));
                y += F_t * (-std::sin(phi) + r_1 * std::cos(phi));
                mean_tangential += F_t / angles;
            }
            largest_tooth = std::max(largest_tooth, std::hypot(x, y));
            total_x += x;
            total_y += y;
        }
        largest_total = std::max(largest_total, std::hypot(total_x, total_y));
    }
    return {largest_total / mean_tangential, largest_tooth / mean_tangential};
}

}  // namespace

TEST_GROUP(PeakFactors){};

HOST_TEST(PeakFactors, agree_with_a_sum_over_discs) {
    for (const double immersion : {0.1, 0.5, 1.2, 2.0}) {
        for (const double depth : {1.0, 5.0, 12.0}) {
            const auto closed = peak_factors(carbide_in_SM45C<double>(), four_flutes(), immersion, depth);
            const auto summed = summed_factors(four_flutes(), immersion, depth);
            DOUBLES_EQUAL(1.0, closed.total / summed.total, 0.01);
            DOUBLES_EQUAL(1.0, closed.tooth / summed.tooth, 0.01);
        }
    }
}

TEST(PeakFactors, leave_the_limit_to_the_tooth_while_one_tooth_cuts_and_share_it_in_a_slot) {
    const auto shallow = peak_factors(carbide_in_SM45C<double>(), four_flutes(), 0.1, 1.0);
    DOUBLES_EQUAL(1.0, shallow.threshold_factor(), 1e-9);
    // Four flutes in a slot: two cut at once, 90° apart, and their forces add as vectors: no more than one tooth's.
    const auto slot = peak_factors(carbide_in_SM45C<double>(), four_flutes(0.0), 2.0, 5.0);
    DOUBLES_EQUAL(1.0, slot.threshold_factor(), 0.01);
    auto eight = four_flutes();
    eight.teeth = 8.0;
    CHECK(peak_factors(carbide_in_SM45C<double>(), eight, 2.0, 5.0).threshold_factor() > 1.8);
}

TEST(PeakFactors, of_a_straight_edge_are_those_of_the_thickest_chip) {
    // One tooth at a time, no helix: the peak is at the entry of down milling, f = K_s f_z a_p sin φ_st √(1 + r_1²).
    const auto law = carbide_in_SM45C<double>();
    auto s = four_flutes(0.0);
    s.teeth = 2.0;
    const auto cut = engagement_angles(CutSide::down, 0.5);
    const double t_a = mean_chip_thickness_mm(s.nominal_feed_per_tooth_mm, cut);
    const double r_1 = law.k_1 * std::pow(t_a, law.p_1);
    const double expected = std::sin(cut.entry_rad) * std::sqrt(1.0 + r_1 * r_1) * pi<double> / 0.5;
    DOUBLES_EQUAL(1.0, peak_factors(law, s, 0.5, 3.0).tooth / expected, 0.002);
}

TEST_GROUP(ToothPeakTable){};

TEST(ToothPeakTable, interpolates_within_one_percent_of_the_direct_search) {
    ToothPeakTable<float> table;
    PeakFactorSettings<float> s = millforce::tests::peaks_of_four_flutes<float>();
    s.helix_rad = 0.5235988F;
    table.build(carbide_in_SM45C<float>(), s);
    double worst = 0.0;
    for (float immersion = 0.06F; immersion < 2.0F; immersion += 0.031F) {
        for (float depth = 0.3F; depth < 15.0F; depth += 0.37F) {
            const auto direct = peak_factors(carbide_in_SM45C<float>(), s, immersion, depth);
            worst = std::max(worst, std::abs(static_cast<double>(table.at(immersion, depth) / direct.tooth) - 1.0));
        }
    }
    CHECK(worst < 0.01);
}
