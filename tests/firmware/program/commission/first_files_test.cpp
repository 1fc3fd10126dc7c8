// SPDX-License-Identifier: Apache-2.0
#include "commission/first_files.hpp"
#include "check/check_parameters.hpp"
#include "commission/tooth_force_advice.hpp"
#include "commission/workpieces.hpp"
#include "files/input_error.hpp"
#include "parameters/machine_bus.hpp"
#include "parameters/parameter_files.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

const std::vector<std::string> data_sheet{
    "machine.axes=xy",
    "spindle.rated_current_A=12",
    "spindle.rated_torque_Nm=8",
    "spindle.rated_torque_current_A=12",
    "spindle.encoder_counts_per_rev=8192",
    "x.torque_constant_Nm_per_A=0.2",
    "x.travel_per_motor_turn_mm=10",
    "x.rated_current_A=12",
    "y.torque_constant_Nm_per_A=0.2",
    "y.travel_per_motor_turn_mm=5",
    "y.rated_current_A=12",
    "bus.spindle.node_id=1",
    "bus.x.node_id=2",
    "bus.y.node_id=3",
    "tool.teeth=4",
    "tool.diameter_mm=10",
    "tool.flute_length_mm=22",
    "tool.overhang_mm=35",
    "tool.deepest_cut_mm=8",
    "tool.workpiece=steel",
    "control.max_feed_per_tooth_mm=0.08",
};

/// The tool of sim/scenarios/tools/README.md.
ToothForceQuestion readme_tool() {
    ToothForceQuestion question;
    question.diameter_mm = 10.0;
    question.teeth = 4;
    question.overhang_mm = 35.0;
    question.deepest_cut_mm = 8.0;
    question.strength_N_per_mm2 = carbide_strength_N_per_mm2;
    question.largest_feed_per_tooth_mm = 0.05;
    question.law.k_s_N_per_mm2 = 1688.0;
    question.law.k_1 = 0.40;
    question.law.K_te_N_per_mm = 22.0;
    question.law.K_re_N_per_mm = 28.0;
    return question;
}

}  // namespace

TEST_GROUP(FirstFiles) {
    TemporaryFolder folder;
    std::ostringstream advice;

    void write(const std::vector<std::string>& pairs) {
        Answers answers("", pairs);
        first_machine_file(answers).save(folder.path("machine.toml"));
        first_tool_file(answers, advice).save(folder.path("tool.toml"));
        answers.require_all();
    }
    firmware::Parameters<float> read() {
        return read_parameters(folder.path("machine.toml"), folder.path("tool.toml"));
    }
};

TEST(FirstFiles, from_data_sheets_are_sound_and_name_a_bus) {
    write(data_sheet);
    const auto parameters = read();
    CHECK(check_parameters(parameters).empty());
    DOUBLES_EQUAL(8.0 / 12.0, parameters.machine.spindle.K_t1_Nm_per_A, 1e-4);
    // A turn of the motor does 2π · 0.2 N·m of work over 10 mm, or 5 mm.
    DOUBLES_EQUAL(125.7, parameters.machine.axes[0].K_x4_N_per_A, 0.05);
    DOUBLES_EQUAL(251.3, parameters.machine.axes[1].K_x4_N_per_A, 0.05);
    CHECK(parameters.tool.monitor_only);
    const auto bus = read_machine_bus(folder.path("machine.toml"));
    CHECK(bus.has_value());
    UNSIGNED_LONGS_EQUAL(3, bus->drives.drives[2].node_id);
    UNSIGNED_LONGS_EQUAL(0, bus->drives.drives[3].node_id);
}

TEST(FirstFiles, hold_only_keys_that_were_asked_for_each_below_its_meaning) {
    write(data_sheet);
    for (const char* name : {"machine.toml", "tool.toml"}) {
        std::istringstream lines(folder.read(name));
        std::string before;
        int keys = 0;
        for (std::string line; std::getline(lines, line); before = line) {
            const bool is_heading = line.starts_with("name") || line.starts_with("description");
            if (line.find(" = ") == std::string::npos || line.starts_with("#") || is_heading) {
                continue;
            }
            ++keys;
            CHECK_TEXT(before.starts_with("# "), line.c_str());
        }
        CHECK(keys > 9 && keys < 50);
    }
}

TEST(FirstFiles, an_entry_into_the_unknown_meets_the_limit_in_the_hardest_workpiece_by_the_tooth_that_stands_out) {
    write(data_sheet);
    const auto tool = read().tool;
    estimation::CuttingLaw<double> law;
    law.k_s_N_per_mm2 = workpiece_of("steel").k_s_N_per_mm2;
    law.p_s = workpiece_of("steel").p_s;
    law.k_1 = table_k_1;
    law.p_1 = table_p_1;
    const double standing_out_mm = usual_runout_mm * std::sin(std::numbers::pi / tool.teeth);
    const double chip_mm = static_cast<double>(tool.control.entry_feed_per_tooth_mm) + standing_out_mm;
    const double force_N = hardest_batch * straight_tooth_force_N(law, chip_mm, 8.0);
    DOUBLES_EQUAL(1.0, force_N / static_cast<double>(tool.tooth_force_limit_N), 0.01);
    CHECK(tool.control.entry_feed_per_tooth_mm < tool.control.max_feed_per_tooth_mm);
}

TEST(FirstFiles, refuse_a_tool_that_is_shorter_than_its_cut) {
    auto pairs = data_sheet;
    std::replace(pairs.begin(), pairs.end(), std::string("tool.overhang_mm=35"), std::string("tool.overhang_mm=4"));
    CHECK(contains(message_of<InputError>([&] { write(pairs); }), "tool.overhang_mm = 4: expected more than half"));
}

TEST_GROUP(ToothForceAdvice){};

TEST(ToothForceAdvice, is_that_of_the_worked_example) {
    const ToothForceAdvice advice = advise_tooth_force(readme_tool());
    DOUBLES_EQUAL(850.0, advice.bending_N, 10.0);      // 1020 N on the tool, 1.2 of it on one tooth
    DOUBLES_EQUAL(600.0, advice.makers_feed_N, 20.0);  // a slot 0.5 D deep at 0.05 mm per tooth
    DOUBLES_EQUAL(2.0 / 3.0 * advice.makers_feed_N, advice.advised_N, 1e-9);
    UNSIGNED_LONGS_EQUAL(3, advice.reasons.size());
}

TEST(ToothForceAdvice, a_longer_or_thinner_tool_withstands_less) {
    ToothForceQuestion scaled = readme_tool();
    scaled.diameter_mm *= 0.6;
    scaled.overhang_mm *= 0.6;
    scaled.deepest_cut_mm *= 0.6;
    const double whole_N = advise_tooth_force(readme_tool()).bending_N;
    DOUBLES_EQUAL(0.36, advise_tooth_force(scaled).bending_N / whole_N, 1e-9);
    ToothForceQuestion thin = readme_tool();
    thin.diameter_mm = 6.0;
    DOUBLES_EQUAL(0.216, advise_tooth_force(thin).bending_N / whole_N, 1e-9);
    ToothForceQuestion longer = readme_tool();
    longer.overhang_mm = 2.0 * 31.0 + 4.0;  // twice the lever
    DOUBLES_EQUAL(0.5, advise_tooth_force(longer).bending_N / whole_N, 1e-9);
}
