// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_calibration.hpp"
#include "files/input_error.hpp"
#include "firmware/program/calibration/synthetic_cuts.hpp"
#include "temporary_folder.hpp"

#include <toml++/toml.h>  // before CppUTest, which makes `new` a macro

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace millforce::host;
using namespace millforce::test;
using millforce::estimation::CutSide;
using millforce::estimation::CuttingLawForm;

namespace {

struct Ended {
    int code = -1;
    std::string error;
    std::string text;
    toml::table toml;

    bool has(const char* key) const { return toml["cutting"].as_table()->contains(key); }
    double number(const std::string& key) const { return toml["cutting"][key].value_or(std::nan("")); }
    std::string side() const { return toml["cutting"]["cut_side"].value_or(std::string()); }
    void finds(const std::string& key, double truth) const {
        DOUBLES_EQUAL(truth, number(key), 3.0 * number(key + "_se"));
    }
};

Ended calibrate(const std::vector<CutRow>& cuts, CuttingLawForm form = CuttingLawForm::power,
                CutSide side = CutSide::unknown) {
    const TemporaryFolder folder;
    CuttingCalibrationOptions options;
    options.data = {folder.write("cuts.csv", table_of(cuts))};
    options.output = folder.path("out.toml");
    options.asked_form = form;
    options.side = side;
    std::ostringstream out;
    Ended ended;
    ended.error = message_of<InputError>([&] { ended.code = calibrate_cutting(options, out); });
    ended.text = out.str();
    if (ended.error.empty()) {
        ended.toml = toml::parse(folder.read("out.toml"));
    } else {
        LONGS_EQUAL(1, folder.file_count());
        LONGS_EQUAL(0, std::count(ended.error.begin(), ended.error.end(), '\n'));
    }
    return ended;
}

void refuses(const Ended& ended, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        CHECK_TEXT(contains(ended.error, part), (part + " not in: " + ended.error).c_str());
    }
}

template <typename Change>
std::vector<CutRow> changed(std::vector<CutRow> cuts, Change change) {
    std::for_each(cuts.begin(), cuts.end(), change);
    return cuts;
}

const CutsToMake by_feed_force{.with_normal_force = false, .with_feed_force = true};

CutsToMake on_side(CutsToMake make, CutSide side) {
    make.side = side;
    return make;
}

}  // namespace

TEST_GROUP(CuttingSide){};

TEST(CuttingSide, is_the_one_that_fits_the_feed_force_or_the_normal_force) {
    for (const CutsToMake& make : {CutsToMake{}, by_feed_force}) {
        for (const CutSide side : {CutSide::down, CutSide::up}) {
            const Ended ended = calibrate(make_cuts(carbide_law(), on_side(make, side)));
            STRCMP_EQUAL("", ended.error.c_str());
            STRCMP_EQUAL(side == CutSide::up ? "up" : "down", ended.side().c_str());
            ended.finds("k_1", 0.2242);
            ended.finds("k_s_N_per_mm2", 1007.59);
        }
    }
}

TEST(CuttingSide, that_is_stated_and_does_not_fit_is_refused) {
    const auto cuts = make_cuts(carbide_law(), on_side(by_feed_force, CutSide::up));
    refuses(calibrate(cuts, CuttingLawForm::power, CutSide::down), {"cuts.csv", "--side down", "as up milling"});
    STRCMP_EQUAL("", calibrate(cuts, CuttingLawForm::power, CutSide::up).error.c_str());
}

TEST(CuttingSide, a_normal_force_of_the_opposite_sign_is_refused_by_its_column) {
    const auto turned = [](CutRow& row) { row.normal_force_N = -row.normal_force_N; };
    for (const CutSide side : {CutSide::down, CutSide::up}) {
        const auto cuts = changed(make_cuts(carbide_law(), on_side({}, side)), turned);
        refuses(calibrate(cuts), {"cuts.csv", "'normal_force_N'", "opposite", side == CutSide::up ? "up" : "down"});
        refuses(calibrate(cuts, CuttingLawForm::combined, side), {"'normal_force_N'", "opposite"});
    }
}

TEST(CuttingSide, a_feed_force_of_the_opposite_sign_is_refused_by_its_column) {
    const auto turned = [](CutRow& row) { row.feed_force_N = -row.feed_force_N; };
    for (const CutSide side : {CutSide::down, CutSide::up}) {
        refuses(calibrate(changed(make_cuts(carbide_law(), on_side(by_feed_force, side)), turned)),
                {"cuts.csv", "'feed_force_N'", "opposite"});
    }
}

TEST(CuttingSide, a_sign_that_cuts_of_one_width_do_not_show_is_warned_of_unless_the_side_is_stated) {
    const auto cuts = make_cuts(carbide_law(), {.widths_mm = {0.8}});
    CHECK(
        contains(calibrate(cuts).text, "warning: with the opposite sign of normal_force_N the forces fit up milling"));
    CHECK(!contains(calibrate(cuts, CuttingLawForm::power, CutSide::down).text, "warning"));
    CHECK(!contains(calibrate(make_cuts(carbide_law(), {})).text, "warning"));
}

TEST(CuttingSide, a_sign_that_only_an_unheard_of_force_ratio_could_explain_is_refused) {
    CutsToMake one_width = by_feed_force;
    one_width.widths_mm = {0.8};
    const auto cuts =
        changed(make_cuts(carbide_law(), one_width), [](CutRow& row) { row.feed_force_N = -row.feed_force_N; });
    refuses(calibrate(cuts, CuttingLawForm::power, CutSide::down), {"'feed_force_N'", "opposite"});
}

TEST_GROUP(CuttingRefusals){};

TEST(CuttingRefusals, fewer_measured_values_than_parameters_and_one) {
    const CutsToMake few{.feeds_per_tooth_mm = {0.02, 0.05, 0.1}, .widths_mm = {2.0}};
    refuses(calibrate(make_cuts(carbide_law(), few), CuttingLawForm::combined),
            {"3 cuts with 6 measured values for the 6 parameters", "at least 7"});
}

TEST(CuttingRefusals, no_stated_deviation_is_zero_however_few_the_cuts) {
    const CutsToMake four{.feeds_per_tooth_mm = {0.03, 0.1}, .widths_mm = {1.2, 4.0}};
    int written = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        CutsToMake make = four;
        make.seed = seed;
        for (const auto form : {CuttingLawForm::combined, CuttingLawForm::power, CuttingLawForm::linear_edge}) {
            const Ended ended = calibrate(make_cuts(carbide_law(), make), form);
            if (ended.error.empty()) {
                ++written;
                for (const char* key : {"K_s_relative_sd", "K_s_exponent_sd", "r_1_relative_sd", "r_1_exponent_sd"}) {
                    CHECK_TEXT(ended.number(key) > 1e-3, key);
                }
            } else {
                CHECK(contains(ended.error, "4 cuts fit without any scatter"));
            }
        }
    }
    CHECK(written >= 30);
}

TEST(CuttingRefusals, few_cuts_state_a_wider_doubt_than_many_of_the_same_scatter) {
    double of_few = 0.0;
    double of_many = 0.0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const CutsToMake few{.feeds_per_tooth_mm = {0.03, 0.1}, .widths_mm = {1.2, 4.0}, .seed = seed};
        const CutsToMake many{.seed = seed};
        of_few += fit_cuts(make_cuts(carbide_law(), few), CuttingLawForm::power, CutSide::down).law.K_s_relative_sd;
        of_many += fit_cuts(make_cuts(carbide_law(), many), CuttingLawForm::power, CutSide::down).law.K_s_relative_sd;
    }
    CHECK(of_few > 1.3 * of_many);
}

TEST(CuttingRefusals, forces_that_follow_no_law) {
    CutsToMake wild;
    wild.error = 0.9;
    refuses(calibrate(make_cuts(carbide_law(), wild)), {"cuts.csv", "scatter", "30 %"});
}

TEST(CuttingRefusals, a_feed_in_mm_per_minute_by_its_chip) {
    refuses(calibrate(changed(make_cuts(carbide_law(), {}), [](CutRow& row) { row.feed_mm_s *= 60.0; })),
            {"cuts.csv:2", "'feed_mm_s'", "a chip of 1.2 mm on a tool of Ø8 mm", "mm/min?"});
}

TEST(CuttingRefusals, a_spindle_speed_in_1_per_minute_by_the_pressure_that_it_means) {
    refuses(calibrate(changed(make_cuts(carbide_law(), {}), [](CutRow& row) { row.spindle_rad_s *= 9.549; })),
            {"cuts.csv", "pressure", "is spindle_rad_s in 1/min"});
    refuses(calibrate(changed(make_cuts(carbide_law(), {}), [](CutRow& row) { row.spindle_rad_s = 40000.0; })),
            {"cuts.csv:2", "'spindle_rad_s'", "160 m/s", "1/min"});
}

TEST(CuttingRefusals, a_torque_in_another_unit_or_of_the_opposite_sign) {
    refuses(calibrate(changed(make_cuts(carbide_law(), {}), [](CutRow& row) { row.spindle_torque_Nm *= 1000.0; })),
            {"cuts.csv", "pressure", "spindle_torque_Nm in another unit"});
    refuses(calibrate(changed(make_cuts(carbide_law(), {}), [](CutRow& row) { row.spindle_torque_Nm *= -1.0; })),
            {"cuts.csv", "torque of the cuts is negative"});
}

TEST(CuttingRefusals, a_force_in_kN_or_mN_by_the_torque_beside_it) {
    const auto times = [](double factor) {
        return changed(make_cuts(carbide_law(), {}), [=](CutRow& row) { row.normal_force_N *= factor; });
    };
    refuses(calibrate(times(1e-3)), {"cuts.csv: column 'normal_force_N': ",
                                     "along the edge by the torque (medians of 20 cuts); expected 0.02 "
                                     "to 20 times as much; is it in kN?"});
    refuses(calibrate(times(1e3)), {"cuts.csv: column 'normal_force_N': ", "is it in mN"});
    refuses(calibrate(changed(make_cuts(carbide_law(), by_feed_force), [](CutRow& row) { row.feed_force_N *= 1e-3; })),
            {"cuts.csv: column 'feed_force_N': ", "is it in kN?"});
}

TEST(CuttingRefusals, a_spindle_speed_in_1_per_s_by_its_chip) {
    refuses(
        calibrate(changed(make_cuts(carbide_law(), {}), [](CutRow& row) { row.spindle_rad_s /= 6.2831853; })),
        {"cuts.csv:12", "a chip of 0.503 mm on a tool of Ø8 mm", "is spindle_rad_s in 1/s, or feed_mm_s in mm/min?"});
}

TEST(CuttingRefusals, a_feed_in_m_per_second_by_a_chip_thinner_than_an_edge_is_sharp) {
    refuses(calibrate(changed(make_cuts(carbide_law(), {}), [](CutRow& row) { row.feed_mm_s *= 1e-3; })),
            {"cuts.csv:2: column 'feed_mm_s'", "a chip of 0.02 µm on a tool of Ø8 mm; expected at least 0.8 µm",
             "feed_mm_s in m/min or m/s?"});
}

TEST(CuttingRefusals, a_spindle_speed_in_1_per_s_is_asked_about_where_soft_material_would_be_cut_slowly) {
    const CutsToMake thin_chips{.feeds_per_tooth_mm = {0.02, 0.04, 0.06}};
    LONGS_EQUAL(0, calibrate(make_cuts(carbide_law(), thin_chips)).code);
    const Ended ended =
        calibrate(changed(make_cuts(carbide_law(), thin_chips), [](CutRow& row) { row.spindle_rad_s /= 6.2831853; }));
    STRCMP_EQUAL("", ended.error.c_str());
    STRCMP_CONTAINS("N/mm² at 0.084 m/s (medians) takes 3", ended.text.substr(ended.text.find("warning")).c_str());
    LONGS_EQUAL(1, ended.code);
    CHECK(contains(ended.text, "spindle_rad_s in 1/s"));
}

TEST(CuttingRefusals, a_spindle_speed_in_1_per_min_is_asked_about_where_hard_material_would_be_cut_fast) {
    auto aluminium = carbide_law();
    aluminium.k_s_N_per_mm2 = 300.0;
    CutsToMake make;
    const auto fast = [](double factor) {
        return [=](CutRow& row) {
            row.spindle_rad_s *= factor;
            row.feed_mm_s *= 4.0;
        };
    };
    LONGS_EQUAL(0, calibrate(changed(make_cuts(aluminium, make), fast(4.0))).code);
    const Ended ended = calibrate(changed(make_cuts(aluminium, make), fast(4.0 * 9.549)));
    STRCMP_EQUAL("", ended.error.c_str());
    LONGS_EQUAL(1, ended.code);
    CHECK(contains(ended.text, "soft material is cut fast, and hard one slowly; is spindle_rad_s in 1/min"));
}

TEST_GROUP(CuttingParameters){};

TEST(CuttingParameters, that_are_smaller_than_their_error_are_neither_fitted_nor_written) {
    auto law = carbide_law();
    law.p_1 = 0.0;
    law.k_1 = 0.4;
    int left_out = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        const Ended ended = calibrate(make_cuts(law, {.seed = seed}));
        STRCMP_EQUAL("", ended.error.c_str());
        if (ended.has("p_1")) {
            CHECK(ended.number("p_1_se") < std::abs(ended.number("p_1")));
            continue;
        }
        ++left_out;
        CHECK(contains(ended.text, "not determined by these data; fitted without it, not written"));
        CHECK(!ended.has("p_1_se"));
        ended.finds("k_1", 0.4);
        CHECK(ended.number("k_1_se") < 0.02);  // with an exponent it is three times as large
    }
    CHECK(left_out >= 4);
}
