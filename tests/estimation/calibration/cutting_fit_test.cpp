// SPDX-License-Identifier: Apache-2.0
#include "estimation_calibration/cutting_fit.hpp"

#include "estimation/fit_statistics.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <vector>

using namespace millforce::estimation;
using millforce::test::Coverage;
using millforce::test::Noise;

namespace {

using Cuts = std::vector<CuttingMeasurement>;

/// Down milling, three flutes, all widths at all feeds; each force wrong by `error` of itself (normal).
Cuts cut_with(const CuttingLaw<double>& law, std::initializer_list<double> feeds, double error, Noise& noise) {
    Cuts cuts;
    for (const double f_z : feeds) {
        for (double R_r = 0.3; R_r < 1.85; R_r += 0.3) {
            CuttingMeasurement m;
            m.cut = {f_z, 1.0, engagement_angles(CutSide::down, R_r), 3.0};
            const auto forces = average_forces(law, m.cut);
            m.tangential_N = forces.tangential_N * (1.0 + noise.normal(error));
            m.normal_N = forces.normal_N * (1.0 + noise.normal(error));
            cuts.push_back(m);
        }
    }
    return cuts;
}

CuttingLaw<double> law_of(double K_s, double p_s, double r_1, double p_1, double K_te, double K_re, double t_ref) {
    CuttingLaw<double> law;
    law.k_s_N_per_mm2 = K_s * std::pow(t_ref, -p_s);
    law.p_s = p_s;
    law.k_1 = r_1 * std::pow(t_ref, -p_1);
    law.p_1 = p_1;
    law.K_te_N_per_mm = K_te;
    law.K_re_N_per_mm = K_re;
    return law;
}

CuttingFit fit(const Cuts& cuts, CuttingLawForm form) {
    CuttingFitOptions options;
    options.form = form;
    return fit_cutting_law(cuts, options);
}

constexpr std::initializer_list<double> five_feeds{0.015, 0.03, 0.05, 0.08, 0.12};

}  // namespace

TEST_GROUP(CuttingFit){};

TEST(CuttingFit, finds_the_linear_edge_law_with_honest_standard_errors) {
    const auto law = linear_edge_law(1400.0, 9.6, 1050.0, 6.1);
    const std::array<double, 4> truth{std::log(1400.0), 0.75, 9.6, 6.1};
    constexpr std::array<int, 4> index{cutting_ln_K_s, cutting_r_1, cutting_K_te, cutting_K_re};
    std::array<Coverage, 4> coverage;
    Noise noise(31);
    for (int repetition = 0; repetition < 2500; ++repetition) {
        const auto result = fit(cut_with(law, five_feeds, 0.03, noise), CuttingLawForm::linear_edge);
        LONGS_EQUAL(0, result.undetermined);
        for (std::size_t j = 0; j < 4; ++j) {
            coverage[j].add(truth[j], result.parameters(index[j]), result.standard_error(index[j]), 2.0);
        }
    }
    for (const Coverage& c : coverage) {
        CHECK(c.percent() > 93.0 && c.percent() < 97.0);
    }
}

TEST(CuttingFit, finds_the_power_law_with_honest_standard_errors) {
    std::array<Coverage, 4> coverage;
    Coverage of_k_s, of_k_1;
    constexpr std::array<int, 4> index{cutting_ln_K_s, cutting_p_s, cutting_r_1, cutting_p_1};
    Noise noise(32);
    CuttingLaw<double> law;  // Kim & Chung, carbide
    law.k_s_N_per_mm2 = 1007.59;
    law.p_s = -0.2557;
    law.k_1 = 0.2242;
    law.p_1 = -0.1546;
    for (int repetition = 0; repetition < 2500; ++repetition) {
        const auto result = fit(cut_with(law, five_feeds, 0.03, noise), CuttingLawForm::power);
        LONGS_EQUAL(0, result.undetermined);
        const double t = result.reference_chip_thickness_mm;
        const std::array<double, 4> truth{std::log(1007.59) - 0.2557 * std::log(t), -0.2557,
                                          0.2242 * std::pow(t, -0.1546), -0.1546};
        for (std::size_t j = 0; j < 4; ++j) {
            coverage[j].add(truth[j], result.parameters(index[j]), result.standard_error(index[j]), 2.0);
        }
        of_k_s.add(1007.59, result.law.k_s_N_per_mm2, result.k_s_standard_error(), 2.0);
        of_k_1.add(0.2242, result.law.k_1, result.k_1_standard_error(), 2.0);
    }
    for (const Coverage& c : {coverage[0], coverage[1], coverage[2], coverage[3], of_k_s, of_k_1}) {
        CHECK(c.percent() > 93.0 && c.percent() < 97.0);
    }
}

TEST(CuttingFit, of_the_combined_law_covers_truths_drawn_from_its_beliefs) {
    std::array<Coverage, cutting_parameter_count> coverage;
    Noise noise(33);
    const CuttingFitOptions belief;
    for (int repetition = 0; repetition < 1500; ++repetition) {
        const double K_s = noise.uniform(700.0, 2500.0);
        const double edge_sd = K_s * belief.edge_thickness_sd_mm;
        const double t_ref = 0.03;
        const auto law =
            law_of(K_s, belief.p_s_mean + noise.normal(belief.p_s_sd), noise.uniform(0.4, 1.0),
                   belief.p_1_mean + noise.normal(belief.p_1_sd), noise.normal(edge_sd), noise.normal(edge_sd), t_ref);
        const auto result = fit(cut_with(law, {0.014, 0.04, 0.066}, 0.025, noise), CuttingLawForm::combined);
        CHECK(result.converged);
        const double u = std::log(result.reference_chip_thickness_mm / t_ref);
        const double r_1 = law.k_1 * std::pow(t_ref, law.p_1);
        const std::array<double, cutting_parameter_count> truth{std::log(K_s) + law.p_s * u, law.p_s,
                                                                r_1 * std::exp(law.p_1 * u), law.p_1,
                                                                law.K_te_N_per_mm,           law.K_re_N_per_mm};
        for (std::size_t j = 0; j < coverage.size(); ++j) {
            coverage[j].add(truth[j], result.parameters(static_cast<int>(j)),
                            result.standard_error(static_cast<int>(j)), 2.04);
        }
    }
    for (const Coverage& c : coverage) {
        CHECK(c.percent() > 93.0 && c.percent() < 97.0);
    }
}

TEST(CuttingFit, foretells_a_feed_beyond_the_calibrated_ones_within_its_stated_doubt) {
    Coverage torque, force;
    Noise noise(34);
    const CuttingFitOptions belief;
    for (int repetition = 0; repetition < 1000; ++repetition) {
        const auto law =
            law_of(1500.0, belief.p_s_mean + noise.normal(belief.p_s_sd), 0.8,
                   belief.p_1_mean + noise.normal(belief.p_1_sd), noise.normal(7.5), noise.normal(7.5), 0.03);
        const auto result = fit(cut_with(law, {0.04, 0.066}, 0.025, noise), CuttingLawForm::combined);
        const CutConditions<double> thin{0.014, 1.0, engagement_angles(CutSide::down, 0.9), 3.0};
        const auto truth = average_forces(law, thin);
        const auto foretold = average_forces_with_doubt(result.law, thin);
        torque.add(truth.tangential_N, foretold.mean.tangential_N, foretold.standard_deviation.tangential_N, 2.0);
        force.add(truth.normal_N, foretold.mean.normal_N, foretold.standard_deviation.normal_N, 2.0);
    }
    CHECK(torque.percent() > 93.0);
    CHECK(force.percent() > 93.0);
}

TEST(CuttingFit, is_not_bent_by_two_cuts_that_were_wider_than_stated) {
    Noise noise(35);
    const auto law = linear_edge_law(1400.0, 9.6, 1050.0, 6.1);
    Cuts cuts = cut_with(law, {0.014, 0.04, 0.066}, 0.02, noise);
    for (const std::size_t k : {std::size_t{6}, std::size_t{12}}) {
        cuts[k].tangential_N *= 1.2;
        cuts[k].normal_N *= 1.2;
    }
    const auto result = fit(cuts, CuttingLawForm::linear_edge);
    DOUBLES_EQUAL(std::log(1400.0), result.parameters(cutting_ln_K_s), 2.5 * result.standard_error(cutting_ln_K_s));
    DOUBLES_EQUAL(9.6, result.parameters(cutting_K_te), 2.5 * result.standard_error(cutting_K_te));
    CHECK(result.tangential.odd_cuts >= 2);
    CHECK(result.tangential.rms > 1.5 * result.tangential.robust_sd);
}

TEST(CuttingFit, with_one_feed_cannot_tell_edge_forces_from_the_cutting_force) {
    Noise noise(36);
    const auto cuts = cut_with(linear_edge_law(1400.0, 9.6, 1050.0, 6.1), {0.04}, 0.02, noise);
    for (const auto form : {CuttingLawForm::linear_edge, CuttingLawForm::combined}) {
        const auto result = fit(cuts, form);
        CHECK(!result.determined(cutting_K_te));
        CHECK(!result.determined(cutting_K_re));
        CHECK(result.determined(cutting_ln_K_s));
    }
}

TEST(CuttingFit, with_torques_alone_or_slots_alone_cannot_tell_the_radial_force) {
    Noise noise(37);
    const auto law = linear_edge_law(1400.0, 9.6, 1050.0, 6.1);
    Cuts torques = cut_with(law, five_feeds, 0.02, noise);
    Cuts slots = torques;
    for (std::size_t k = 0; k < torques.size(); ++k) {
        torques[k].normal_N = std::nan("");
        slots[k].cut.engagement = {0.0, pi<double>};
        const auto forces = average_forces(law, slots[k].cut);
        slots[k].tangential_N = forces.tangential_N * (1.0 + noise.normal(0.02));
        slots[k].normal_N = forces.normal_N * (1.0 + noise.normal(0.02));
    }
    for (const Cuts& cuts : {torques, slots}) {
        const auto result = fit(cuts, CuttingLawForm::combined);
        CHECK(!result.determined(cutting_r_1));
        CHECK(!result.determined(cutting_p_1));
        CHECK(!result.determined(cutting_K_re));
        CHECK(result.determined(cutting_ln_K_s));
        CHECK(result.determined(cutting_K_te));
    }
}

TEST(CuttingFit, of_nothing_determines_nothing) {
    Cuts cuts(3);
    cuts[1].cut = {0.05, 1.0, {0.0, 1.0}, 3.0};          // nothing measured
    cuts[2].cut = {std::nan(""), 1.0, {0.0, 1.0}, 3.0};  // no feed
    cuts[2].tangential_N = 5.0;
    LONGS_EQUAL(0x3F, fit(cuts, CuttingLawForm::combined).undetermined);
    LONGS_EQUAL(0x3F, fit({}, CuttingLawForm::combined).undetermined);
}

TEST(CuttingFit, of_forces_rounded_to_float_is_the_same_within_a_tenth_of_its_standard_errors) {
    Noise noise(38);
    const auto cuts = cut_with(linear_edge_law(1400.0, 9.6, 1050.0, 6.1), {0.014, 0.04, 0.066}, 0.03, noise);
    const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
    Cuts coarse = cuts;
    for (CuttingMeasurement& m : coarse) {
        m.cut.feed_per_tooth_mm = rounded(m.cut.feed_per_tooth_mm);
        m.cut.engagement = {rounded(m.cut.engagement.entry_rad), rounded(m.cut.engagement.exit_rad)};
        m.tangential_N = rounded(m.tangential_N);
        m.normal_N = rounded(m.normal_N);
    }
    const auto exact = fit(cuts, CuttingLawForm::combined);
    const auto from_coarse = fit_cutting_law(coarse);
    LONGS_EQUAL(0, from_coarse.undetermined);
    for (int j = 0; j < cutting_parameter_count; ++j) {
        DOUBLES_EQUAL(exact.parameters(j), from_coarse.parameters(j), 0.1 * exact.standard_error(j));
    }
}

TEST(CuttingFit, without_the_exponents_is_the_linear_law) {
    Noise noise(41);
    const auto cuts = cut_with(linear_edge_law(1400.0, 0.0, 1050.0, 0.0), five_feeds, 0.02, noise);
    CuttingFitOptions options;
    options.form = CuttingLawForm::power;
    options.held_at_zero = (1U << cutting_p_s) | (1U << cutting_p_1);
    const auto held = fit_cutting_law(cuts, options);
    LONGS_EQUAL(0, held.undetermined);
    DOUBLES_EQUAL(0.0, held.law.p_s, 1e-6);
    DOUBLES_EQUAL(0.0, held.law.p_1, 1e-6);
    DOUBLES_EQUAL(0.75, held.law.k_1, 3.0 * held.k_1_standard_error());
    CHECK(held.k_1_standard_error() < 0.5 * fit(cuts, CuttingLawForm::power).k_1_standard_error());
}

TEST(CuttingFit, states_its_doubt_at_a_chip_that_was_cut_and_covers_the_fits_variance_beyond) {
    Noise noise(42);
    for (const auto form : {CuttingLawForm::combined, CuttingLawForm::linear_edge, CuttingLawForm::power}) {
        const auto result = fit(cut_with(linear_edge_law(1400.0, 15.0, 1050.0, 10.0), five_feeds, 0.02, noise), form);
        const auto& law = result.law;
        CHECK(law.reference_chip_thickness_mm >= law.minimum_chip_thickness_mm);
        CHECK(law.reference_chip_thickness_mm <= law.maximum_chip_thickness_mm);
        CHECK(result.degrees_of_freedom > 50.0);
        for (double t_mm = law.minimum_chip_thickness_mm / 3.0; t_mm < 3.0 * law.maximum_chip_thickness_mm;
             t_mm *= 1.1) {
            const double u = std::log(t_mm / result.reference_chip_thickness_mm);
            const double ln_K_s_variance = result.covariance(cutting_ln_K_s, cutting_ln_K_s) +
                                           u * u * result.covariance(cutting_p_s, cutting_p_s) +
                                           2.0 * u * result.covariance(cutting_ln_K_s, cutting_p_s);
            CHECK(cutting_coefficients(law, t_mm).ln_K_s_variance >
                  (form == CuttingLawForm::power ? ln_K_s_variance : 0.0));
        }
    }
}

TEST(CuttingFit, says_which_parameters_the_cuts_decide) {
    Noise noise(43);
    const auto law = linear_edge_law(1400.0, 9.6, 1050.0, 6.1);
    const auto of_few = fit(cut_with(law, {0.03, 0.05}, 0.05, noise), CuttingLawForm::combined);
    const auto of_linear = fit(cut_with(law, five_feeds, 0.02, noise), CuttingLawForm::linear_edge);
    CHECK(of_few.decided_by_cuts(cutting_ln_K_s) > 0.99);
    CHECK(of_few.decided_by_cuts(cutting_p_1) < 0.5);
    CHECK(of_linear.decided_by_cuts(cutting_K_re) > 0.99);
    DOUBLES_EQUAL(0.0, of_linear.decided_by_cuts(cutting_p_s), 1e-6);
}
