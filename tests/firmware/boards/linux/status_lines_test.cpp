// SPDX-License-Identifier: Apache-2.0
#include "daemon/status_lines.hpp"

#include <cerrno>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using cia402::NodeState;
using cia402::PowerState;
using firmware::Condition;

namespace {

StatusEntry with(Condition condition) {
    StatusEntry entry;
    entry.conditions.set(condition, true);
    entry.is_used = {true, true, true, false};
    return entry;
}

}  // namespace

TEST_GROUP(StatusLines){};

TEST(StatusLines, name_the_drives_that_cause_a_condition_and_no_other) {
    StatusEntry preparing = with(Condition::drive_preparing);
    preparing.drives[0].state = NodeState::preparing;
    preparing.drives[1].state = NodeState::operational;
    preparing.drives[2].state = NodeState::starting;
    preparing.drives[3].state = NodeState::starting;  // is not used
    STRCMP_EQUAL("drive_preparing (spindle, y)", condition_list(preparing).c_str());

    StatusEntry refused = with(Condition::drive_refused);
    refused.drives[1].state = NodeState::refused;
    STRCMP_EQUAL("drive_refused (x)", condition_list(refused).c_str());

    StatusEntry lost = with(Condition::drive_lost);
    lost.drives[2].state = NodeState::lost;
    STRCMP_EQUAL("drive_lost (y)", condition_list(lost).c_str());

    StatusEntry not_enabled = with(Condition::drive_not_enabled);
    not_enabled.drives[0].power = PowerState::fault;
    not_enabled.drives[1].power = PowerState::quick_stop_active;
    not_enabled.drives[2].power = PowerState::operation_enabled;
    STRCMP_EQUAL("drive_not_enabled (spindle, x)", condition_list(not_enabled).c_str());

    StatusEntry emergency = with(Condition::drive_emergency);
    emergency.drives[1].emergency_active = true;
    emergency.drives[2].units_disagree = true;
    emergency.conditions.set(Condition::drive_units_disagree, true);
    STRCMP_EQUAL("drive_emergency (x), drive_units_disagree (y)", condition_list(emergency).c_str());
}

TEST(StatusLines, of_a_condition_that_no_drive_causes_name_none) {
    StatusEntry entry = with(Condition::sync_lost);
    entry.drives[1].state = NodeState::lost;
    STRCMP_EQUAL("sync_lost", condition_list(entry).c_str());
    STRCMP_EQUAL("", condition_list({}).c_str());
}

TEST(StatusLines, say_what_a_local_input_or_output_fails_by) {
    StatusEntry input = with(Condition::local_input_failed);
    input.input.what = "silent";
    STRCMP_EQUAL("local_input_failed (silent)", condition_list(input).c_str());
    input.input.fault = {iio::IioError::file_missing, ENOENT, iio::Path("/sys/raw")};
    STRCMP_EQUAL("local_input_failed (silent: /sys/raw: file missing (No such file or directory))",
                 condition_list(input).c_str());
    StatusEntry output = with(Condition::local_output_failed);
    output.output.what = "lines";
    output.output.error = EBUSY;
    STRCMP_EQUAL("local_output_failed (lines (Device or resource busy))", condition_list(output).c_str());
    StatusEntry pause = with(Condition::process_paused);
    pause.pause_us = 2'340'000;
    STRCMP_EQUAL("process_paused (2.3 s)", condition_list(pause).c_str());
}

TEST(StatusLines, as_json_tell_emergency_and_abort_only_where_there_was_one) {
    StatusEntry entry = with(Condition::drive_emergency);
    const std::string without = json_line(entry);
    CHECK(without.find("emergency\":\"") == std::string::npos && without.find("sdo_abort") == std::string::npos);
    STRCMP_CONTAINS("\"type\":\"conditions\"", without.c_str());
    entry.is_periodic = true;
    entry.drives[1].emergency.error_code = 0x2310;
    entry.drives[1].sdo_abort_code = 0x06090011;
    const std::string text = json_line(entry);
    STRCMP_CONTAINS("\"type\":\"status\"", text.c_str());
    STRCMP_CONTAINS("\"emergency\":\"0x2310\",\"sdo_abort\":\"0x06090011\"", text.c_str());
}

TEST(StatusLines, for_a_person_show_the_estimates_that_there_are) {
    StatusEntry entry;
    entry.newest.tick.feed_override.ratio = 0.8F;
    entry.newest.tick.feed_override.hold = false;
    const std::string in_air = status_line(entry);
    STRCMP_CONTAINS("override 80 %", in_air.c_str());
    CHECK(in_air.find("hold") == std::string::npos && in_air.find("F_t") == std::string::npos);
    CHECK(in_air.find("immersion") == std::string::npos && in_air.find(';') == std::string::npos);
    entry.newest.tick.feed_override.hold = true;
    entry.newest.tick.tangential_force_N = 250.4F;
    entry.newest.tick.radial_immersion = 0.5F;
    entry.newest.tick.axial_depth_mm = 2.04F;
    entry.conditions.set(Condition::sync_lost, true);
    STRCMP_CONTAINS("override 80 %, hold, F_t 250 N, immersion 0.50, depth 2.0 mm; sync_lost",
                    status_line(entry).c_str());
}
