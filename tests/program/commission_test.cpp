// SPDX-License-Identifier: Apache-2.0
#include "commission_inputs.hpp"
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce::test;

namespace {

/// The simulated machine beside a program that only records, as LinuxCNC's sampler does, at 250 Hz. The data sheets
/// that the answers come from are wrong by a tenth for the spindle, and by half for the axis.
class RecordedShop {
  public:
    explicit RecordedShop(const std::string& answers = commissioning_answers()) {
        folder_.write("answers.toml", answers + R"(spindle.rated_current_A = 12
spindle.rated_torque_Nm = 9
spindle.rated_torque_current_A = 12
spindle.encoder_counts_per_rev = 8192
x.torque_constant_Nm_per_A = 0.08
x.rated_current_A = 12
cnc.sample_rate_hz = 250
)");
        const std::string machine = text_of(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml");
        folder_.write("machine.toml", with(with(machine, "[cnc]", "[cnc]\nsample_rate_hz = 250\nstale_s = 0.1"),
                                           "sync_period_ms = 1.0", "sync_period_ms = 4.0"));
    }

    [[nodiscard]] Ended commission(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"commission", "--session", path("session"), "--answers", path("answers.toml")};
        words.insert(words.end(), more.begin(), more.end());
        return run_millforce(words);
    }
    /// Runs the session's program of a step on the machine; returns the option that gives its recording.
    [[nodiscard]] std::vector<std::string> record(const std::string& step, const CommissioningBlock& block,
                                                  double hardness = 1.0) {
        folder_.write(step + ".toml",
                      commissioning_scenario("machine.toml", "session/" + step + ".ngc", 3, block, hardness));
        run_millforce({"simulate", path(step + ".toml"), "--record", "--out", path("out_" + step)});
        return {"--recording", step + "=" + path("out_" + step) + "/recording.csv"};
    }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_.path(name); }
    [[nodiscard]] std::string session(const std::string& name) const { return text_of(path("session/" + name)); }

  private:
    TemporaryFolder folder_;
};

}  // namespace

TEST_GROUP(Commission) {
    RecordedShop shop;

    void expect_next(const std::string& step, double start_x_mm, const std::string& next) {
        expect_next_in(shop, step, block_along_x(start_x_mm), next);
    }
    /// Gives a step's recording and expects that the next one is asked for.
    static void expect_next_in(RecordedShop & shop, const std::string& step, const CommissioningBlock& block,
                               const std::string& next) {
        const Ended ended = shop.commission(shop.record(step, block));
        CHECK_EQUAL_TEXT(1, ended.exit_code, (ended.out + ended.error).c_str());
        CHECK_TEXT(contains(ended.out, next + ": not recorded yet: record " + next + ".ngc"), ended.out.c_str());
    }
};

TEST(Commission, goes_from_recording_to_recording_to_files_that_check_finds_sound) {
    const Ended begun = shop.commission();
    CHECK_EQUAL_TEXT(1, begun.exit_code, begun.error.c_str());
    CHECK(contains(begun.out, "idle: not recorded yet"));
    expect_next("idle", -25.0, "air");
    expect_next("air", 0.0, "standard_x");
    expect_next("standard_x", -25.0, "validation_x");
    // A steel that is a third harder than the one of the standard cut.
    const Ended harder = shop.commission(shop.record("validation_x", block_along_x(-25.0), 1.33));
    CHECK_EQUAL_TEXT(1, harder.exit_code, harder.error.c_str());
    CHECK_TEXT(contains(harder.out, "validation: to be repeated: "), harder.out.c_str());
    std::vector<std::string> again = shop.record("validation_x", block_along_x(-25.0));
    again.insert(again.end(), {"--repeat", "validation_x"});
    const Ended done = shop.commission(again);
    CHECK_EQUAL_TEXT(0, done.exit_code, (done.out + done.error).c_str());

    const std::string machine = shop.session("machine.toml");
    // The plant's own: 0.70 N·m/A and 120 N/A.
    DOUBLES_EQUAL(0.70, toml_value(machine, "spindle", "K_t1_Nm_per_A"), 0.02);
    DOUBLES_EQUAL(120.0, toml_value(machine, "x", "K_x4_N_per_A"), 4.0);
    const Ended check = run_millforce({"check", shop.path("session/machine.toml"), shop.path("session/tool.toml"),
                                       shop.path("session/standard_x.1.csv")});
    CHECK_EQUAL_TEXT(0, check.exit_code, check.out.c_str());
    const std::string page = shop.session("report.html");
    for (const char* part : {"Good enough: machine.toml and tool.toml are written.", "spindle.K_t1_Nm_per_A",
                             "x.K_x3_A", "<svg", "Cuts that the fit has not seen"}) {
        CHECK_TEXT(contains(page, part), part);
    }
    CHECK_FALSE(contains(page, "http://") || contains(page, "https://") || contains(page, "<script"));
}

TEST(Commission, by_up_milling_measures_x_and_y_and_says_why_z_keeps_the_data_sheets_gain) {
    RecordedShop three_axes(
        with(commissioning_answers(), "machine.axes = \"x\"", "machine.axes = \"xyz\"\nstandard_cut.side = \"up\"") +
        R"(y.travel_per_motor_turn_mm = 5
y.mass_kg = 250
y.torque_constant_Nm_per_A = 0.08
y.rated_current_A = 12
z.travel_per_motor_turn_mm = 5
z.mass_kg = 180
z.torque_constant_Nm_per_A = 0.08
z.rated_current_A = 12
)");
    (void)three_axes.commission();
    expect_next_in(three_axes, "idle", block_below(), "air");
    expect_next_in(three_axes, "air", block_below(), "standard_x");
    expect_next_in(three_axes, "standard_x", block_along_x(45.0), "standard_y");
    expect_next_in(three_axes, "standard_y", block_along_y(45.0), "validation_x");
    expect_next_in(three_axes, "validation_x", block_along_x(45.0), "validation_y");
    const Ended done = three_axes.commission(three_axes.record("validation_y", block_along_y(45.0)));
    CHECK_EQUAL_TEXT(0, done.exit_code, (done.out + done.error).c_str());
    CHECK_TEXT(contains(done.out, "z is not fitted: the law of the standard cut has no force along the tool"),
               done.out.c_str());

    const std::string machine = three_axes.session("machine.toml");
    DOUBLES_EQUAL(0.70, toml_value(machine, "spindle", "K_t1_Nm_per_A"), 0.02);
    DOUBLES_EQUAL(120.0, toml_value(machine, "x", "K_x4_N_per_A"), 4.0);
    DOUBLES_EQUAL(120.0, toml_value(machine, "y", "K_x4_N_per_A"), 4.0);
    DOUBLES_EQUAL(2.0 * 3.14159265 * 1e3 * 0.08 / 5.0, toml_value(machine, "z", "K_x4_N_per_A"), 0.1);
    CHECK(toml_value(machine, "z", "K_x3_A") > 0.0);
    CHECK(contains(three_axes.session("standard_y.ngc"), "(Up milling along -y"));
}

TEST(Commission, refuses_another_answer_under_recordings_and_a_recording_that_is_none) {
    (void)shop.commission();
    expect_next("idle", -25.0, "air");
    STRCMP_EQUAL("", not_refused(shop.commission({"--set", "idle.dwell_s=2"}),
                                 {"idle.dwell_s = 1.0: another answer than when the recordings were made"})
                         .c_str());
    STRCMP_EQUAL("",
                 not_refused(shop.commission({"--recording", "milling=x.csv"}), {"expected one of idle, air"}).c_str());
    const Ended wrong = shop.commission({"--recording", "air=" + shop.path("out_idle") + "/recording.csv"});
    CHECK_EQUAL(1, wrong.exit_code);
    CHECK(contains(wrong.out, "air: the recording is not enough. Missing: x: +1000 -1000"));
}

TEST(Commission, without_answers_names_all_that_are_missing) {
    TemporaryFolder empty;
    const Ended ended = run_millforce({"commission", "--session", empty.path("s")});
    STRCMP_EQUAL("", not_refused(ended, {"missing answers: ", "standard_cut.feed_mm_min in mm/min",
                                         "tool.overhang_mm in mm", "tool.teeth"})
                         .c_str());
    CHECK_TEXT(ended.error.find("tool.teeth") == ended.error.rfind("tool.teeth"), "each is named once");
    CHECK_FALSE(contains(ended.error, "idle.lowest_rpm"));  // it follows from the highest
}

TEST_GROUP(Init) {
    TemporaryFolder folder;
    const std::vector<std::string> tool{
        "tool.teeth=4",        "tool.diameter_mm=10",      "tool.flute_length_mm=22",
        "tool.overhang_mm=35", "tool.workpiece=aluminium", "control.max_feed_per_tooth_mm=0.1"};

    Ended init(const std::vector<std::string>& more) {
        std::vector<std::string> words{"init", "--tool", folder.path("tool.toml")};
        words.insert(words.end(), tool.begin(), tool.end());
        words.insert(words.end(), more.begin(), more.end());
        return run_millforce(words);
    }
};

TEST(Init, writes_a_tool_with_the_reasons_for_its_limit_and_never_over_a_file) {
    const Ended first = init({});
    CHECK_EQUAL_TEXT(0, first.exit_code, first.error.c_str());
    CHECK_TEXT(contains(first.out, "bending: "), first.out.c_str());
    CHECK_TEXT(contains(first.out, "advised: "), first.out.c_str());
    STRCMP_EQUAL("", not_refused(init({}), {"tool.toml: exists already", "--force"}).c_str());
    const Ended other = init({"--force", "tool.tooth_force_limit_N=123"});
    CHECK_EQUAL_TEXT(0, other.exit_code, other.error.c_str());
    DOUBLES_EQUAL(123.0, toml_value(text_of(folder.path("tool.toml")), "tool", "tooth_force_limit_N"), 0.0);
}

TEST(Init, leaves_no_file_where_an_answer_is_missing_or_wrong) {
    STRCMP_EQUAL("", not_refused(run_millforce({"init", "--tool", folder.path("tool.toml"), "tool.teeth=4"}),
                                 {"missing answers: ", "tool.diameter_mm in mm", "control.max_feed_per_tooth_mm"})
                         .c_str());
    STRCMP_EQUAL("", not_refused(init({"tool.helix_deg=90"}), {"tool.helix_deg", "60"}).c_str());
    UNSIGNED_LONGS_EQUAL(0, folder.file_count());
}
