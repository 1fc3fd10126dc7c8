// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_side.hpp"
#include "calibration/cutting_refusals.hpp"
#include "files/input_error.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <sstream>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;
using estimation::CutSide;
using estimation::CuttingFit;
using estimation::CuttingLawForm;

namespace {

/// A fit as the side's choice reads it.
struct Said {
    double scatter = 0.02;
    double r_1 = 0.4;
};
constexpr Said worthless{.scatter = 0.9};
constexpr Said pulling_edge{.scatter = 0.1, .r_1 = -0.4};

CuttingFit fit_that_says(const Said& said) {
    CuttingFit fit;
    fit.converged = true;
    fit.parameters(estimation::cutting_r_1) = said.r_1;
    fit.normal = {.robust_sd = said.scatter, .cuts = 8};
    return fit;
}

/// What the fits of the same cuts say: on each side, and with the sign of the normal force turned.
struct Fits {
    Said down;
    Said up;
    Said turned_down = worthless;
    Said turned_up = worthless;
};

struct Choice {
    CutSide side = CutSide::unknown;
    std::string error;
    std::string text;
};

Choice choice_by(const FitOnSide& fit, CutSide asked) {
    CutRow row;
    row.normal_force_N = 100.0;
    Choice choice;
    std::ostringstream out;
    choice.error = message_of<InputError>([&] {
        choice.side = side_that_fits({"cuts.csv", "'k_1' cannot be determined"}, {row}, asked, fit, out);
    });
    choice.text = out.str();
    return choice;
}

Choice choice_of(const Fits& fits, CutSide asked = CutSide::unknown) {
    return choice_by(
        [&fits](const std::vector<CutRow>& cuts, CutSide side) {
            const bool is_turned = cuts.front().normal_force_N < 0.0;
            const Said& down = is_turned ? fits.turned_down : fits.down;
            const Said& up = is_turned ? fits.turned_up : fits.up;
            return fit_that_says(side == CutSide::up ? up : down);
        },
        asked);
}

}  // namespace

TEST_GROUP(CuttingSideChoice){};

TEST(CuttingSideChoice, of_two_that_are_possible_is_the_one_that_fits_far_better) {
    CHECK(choice_of({.down = {.scatter = 0.02}, .up = {.scatter = 0.04}}).side == CutSide::down);
    const Choice up = choice_of({.down = {.scatter = 0.04}, .up = {.scatter = 0.02}});
    CHECK(up.side == CutSide::up);
    STRCMP_CONTAINS("up milling (as down milling they scatter by 4.0 %)", up.text.c_str());
}

TEST(CuttingSideChoice, of_two_that_fit_alike_is_the_one_of_a_usual_force_ratio) {
    CHECK(choice_of({.down = {.r_1 = 5.0}, .up = {.scatter = 0.025}}).side == CutSide::up);
    STRCMP_CONTAINS("the forces do not show the side",
                    choice_of({.down = {.r_1 = 5.0}, .up = {.scatter = 0.025, .r_1 = 5.0}}).error.c_str());
}

TEST(CuttingSideChoice, that_the_forces_leave_open_has_to_be_stated) {
    const Fits alike{.down = {.scatter = 0.020}, .up = {.scatter = 0.025}};
    STRCMP_CONTAINS(
        "cuts.csv: the forces do not show the side of the cuts: as down milling the forces scatter by 2.0 %",
        choice_of(alike).error.c_str());
    STRCMP_CONTAINS("expected --side down or up", choice_of(alike).error.c_str());
    CHECK(choice_of(alike, CutSide::up).side == CutSide::up);
    CHECK(choice_of(alike, CutSide::down).side == CutSide::down);
}

TEST(CuttingSideChoice, that_is_stated_is_refused_where_the_other_one_fits_far_better) {
    const Choice wrong = choice_of({.down = {.scatter = 0.02}, .up = {.scatter = 0.1}}, CutSide::up);
    STRCMP_CONTAINS("cuts.csv: --side up: as down milling the forces scatter by 2.0 %", wrong.error.c_str());
    STRCMP_CONTAINS("expected the side of the cuts", wrong.error.c_str());
}

TEST(CuttingSideChoice, names_the_opposite_sign_where_the_forces_fit_far_better_with_it) {
    const Choice turned = choice_of({.down = {.scatter = 0.2}, .up = worthless, .turned_up = {.scatter = 0.02}});
    STRCMP_CONTAINS("column 'normal_force_N': the sign is opposite", turned.error.c_str());
    STRCMP_CONTAINS("fit up milling (scatter 2.0 %", turned.error.c_str());
    CHECK(choice_of({.down = {.scatter = 0.04}, .up = worthless, .turned_up = {.scatter = 0.01}}).side ==
          CutSide::down);  // they fit well as they are
    CHECK(choice_of({.down = {.scatter = 0.2}, .up = worthless, .turned_up = {.scatter = 0.15}}).side == CutSide::down);
}

TEST(CuttingSideChoice, takes_the_better_of_two_opposite_signs_and_none_of_an_unheard_of_ratio) {
    const Fits both{
        .down = worthless, .up = worthless, .turned_down = {.scatter = 0.1}, .turned_up = {.scatter = 0.02}};
    STRCMP_CONTAINS("fit up milling", choice_of(both).error.c_str());
    const Fits other{
        .down = worthless, .up = worthless, .turned_down = {.scatter = 0.02}, .turned_up = {.scatter = 0.1}};
    STRCMP_CONTAINS("fit down milling", choice_of(other).error.c_str());
    const Fits unheard_of{.down = worthless, .up = worthless, .turned_down = {.r_1 = 3.0}};
    STRCMP_CONTAINS("the cuts fit neither side", choice_of(unheard_of).error.c_str());
}

TEST(CuttingSideChoice, keeps_an_unusual_ratio_where_the_opposite_sign_fits_worse) {
    const Fits unusual{.down = {.scatter = 0.02, .r_1 = 2.5}, .up = worthless, .turned_up = {.scatter = 0.2}};
    CHECK(choice_of(unusual).side == CutSide::down);
    CHECK(choice_of(unusual).text.find("warning") == std::string::npos);
}

TEST(CuttingSideChoice, says_why_it_is_not_the_other_one) {
    STRCMP_CONTAINS("(up milling would need an edge that pulls)",
                    choice_of({.down = {}, .up = pulling_edge}).text.c_str());
    const auto fits_down_alone = [](const std::vector<CutRow>&, CutSide side) {
        CuttingFit fit = fit_that_says({});
        fit.converged = side == CutSide::down;
        return fit;
    };
    STRCMP_CONTAINS("(up milling does not fit)", choice_by(fits_down_alone, CutSide::unknown).text.c_str());
}

TEST(CuttingSideChoice, without_a_fit_on_either_side_names_what_the_cuts_lack) {
    const auto fits_none = [](const std::vector<CutRow>&, CutSide) { return CuttingFit{}; };
    STRCMP_EQUAL("cuts.csv: 'k_1' cannot be determined", choice_by(fits_none, CutSide::unknown).error.c_str());
}

TEST_GROUP(CuttingLawRefusals) {
    CuttingFit fit;

    void setup() override {
        fit.converged = true;
        fit.parameters(estimation::cutting_r_1) = 0.4;
        fit.covariance(estimation::cutting_r_1, estimation::cutting_r_1) = 1e-4;
        fit.degrees_of_freedom = 12.0;
        fit.minimum_feed_per_tooth_mm = 0.05;
        fit.maximum_feed_per_tooth_mm = 0.1;
        fit.tangential = {.robust_sd = 0.02, .cuts = 8};
        fit.normal = {.robust_sd = 0.02, .cuts = 8};
        fit.law.K_s_relative_sd = fit.law.K_s_exponent_sd = 0.05;
        fit.law.r_1_relative_sd = fit.law.r_1_exponent_sd = 0.05;
    }
    std::string refusal(CuttingLawForm form = CuttingLawForm::combined) const {
        return message_of<InputError>([&] { refuse_vague_law("cuts.csv", fit, form); });
    }
};

TEST(CuttingLawRefusals, a_well_known_law_passes) {
    STRCMP_EQUAL("", refusal().c_str());
}

TEST(CuttingLawRefusals, name_the_key_that_the_cuts_do_not_determine_and_the_cut_that_is_missing) {
    const auto without = [&](int parameter, CuttingLawForm form = CuttingLawForm::combined) {
        fit.undetermined = 1U << static_cast<unsigned>(parameter);
        return refusal(form);
    };
    STRCMP_CONTAINS("cuts.csv: 'k_s_N_per_mm2' cannot be determined", without(estimation::cutting_ln_K_s).c_str());
    STRCMP_CONTAINS("'k_1' cannot be determined: the forces hold nothing of the radial force",
                    without(estimation::cutting_r_1).c_str());
    STRCMP_CONTAINS("'p_s' cannot be determined: all chips are equally thick",
                    without(estimation::cutting_p_s).c_str());
    STRCMP_EQUAL("", without(estimation::cutting_K_te).c_str());  // at two feeds
    fit.minimum_feed_per_tooth_mm = fit.maximum_feed_per_tooth_mm;
    STRCMP_CONTAINS("'K_te_N_per_mm' cannot be separated from 'k_s_N_per_mm2': all cuts have about 0.1 mm",
                    without(estimation::cutting_K_te).c_str());
    STRCMP_EQUAL("", without(estimation::cutting_K_te, CuttingLawForm::power).c_str());  // which has none
}

TEST(CuttingLawRefusals, a_ratio_that_is_smaller_than_its_error) {
    fit.covariance(estimation::cutting_r_1, estimation::cutting_r_1) = 0.25;
    STRCMP_CONTAINS("cuts.csv: 'k_1' cannot be determined: r_1 = 0.4 ± 0.5", refusal().c_str());
}

TEST(CuttingLawRefusals, forces_without_scatter_unless_they_are_many) {
    fit.normal.robust_sd = 1e-4;
    STRCMP_EQUAL("", refusal().c_str());
    fit.degrees_of_freedom = 3.0;
    STRCMP_CONTAINS("cuts.csv: the normal forces of 8 cuts fit without any scatter", refusal().c_str());
}

TEST(CuttingLawRefusals, torques_or_forces_that_follow_no_law_and_ask_about_the_unit_where_no_tool_does_that) {
    fit.normal.robust_sd = 0.4;
    STRCMP_CONTAINS("cuts.csv: the forces scatter by 40.0 % about the law; expected less than 30 %", refusal().c_str());
    CHECK(refusal().find("in another unit") == std::string::npos);
    fit.tangential.robust_sd = 1.5;
    STRCMP_CONTAINS("the torques scatter by 150.0 %", refusal().c_str());
    STRCMP_CONTAINS("is in another unit (daN, kgf)?", refusal().c_str());
}

TEST(CuttingLawRefusals, a_law_whose_deviation_no_parameter_file_may_hold) {
    fit.law.K_s_relative_sd = 2.5;
    STRCMP_CONTAINS("cuts.csv: the cuts leave 'k_s_N_per_mm2' open: a standard deviation of 2.5", refusal().c_str());
    fit.law.K_s_relative_sd = 0.05;
    fit.law.r_1_exponent_sd = 3.0;
    STRCMP_CONTAINS("leave 'k_1' open: a standard deviation of 3", refusal().c_str());
}
