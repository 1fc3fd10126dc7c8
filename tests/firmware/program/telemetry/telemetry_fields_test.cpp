// SPDX-License-Identifier: Apache-2.0
#include "telemetry/telemetry_fields.hpp"

#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "control/cut_state.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;

namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// The unit as the end of a name has it.
std::string suffix_of(std::string_view unit) {
    return unit == "mm/s" ? "_mm_s" : unit == "rad/s" ? "_rad_s" : unit == "µm" ? "_um" : "_" + std::string(unit);
}

}  // namespace

TEST_GROUP(TelemetryFields) {
    Telemetry telemetry;
};

TEST(TelemetryFields, have_names_of_their_own_that_end_with_their_units_and_a_meaning) {
    std::set<std::string_view> names;
    for (const TelemetryField& field : telemetry_fields()) {
        const std::string name(field.name);
        CHECK_TEXT(names.insert(field.name).second, name.c_str());
        CHECK_TEXT(!field.meaning.empty(), name.c_str());
        CHECK_TEXT(field.value != nullptr, name.c_str());
        const bool has_unit = !field.unit.empty() && field.unit != "1";
        CHECK_TEXT(!has_unit || name.ends_with(suffix_of(field.unit)), name.c_str());
        const bool is_word = field.kind == FieldKind::word || field.kind == FieldKind::words;
        CHECK_TEXT(is_word != field.words.empty(), name.c_str());
    }
}

TEST(TelemetryFields, leave_out_what_is_not_known) {
    const std::string text = telemetry_json(telemetry);
    for (const char* unknown : {"radial_immersion", "axial_depth_mm", "peak_force_N", "spindle_current_A",
                                "x_velocity_mm_s", "programmed_feed_mm_s", "nan", "inf"}) {
        CHECK_TEXT(!contains(text, unknown), unknown);
    }
    CHECK(contains(text, R"("hold":true)"));
    CHECK(contains(text, R"("conditions":[])"));
}

TEST(TelemetryFields, show_what_the_tick_answered_and_what_went_in) {
    TelemetrySample& sample = telemetry.sample;
    telemetry.time_s = 1.25;
    sample.tick.feed_override = {0.75F, false, static_cast<std::uint8_t>(control::CutState::in_cut), 0, 42};
    sample.tick.limit = static_cast<std::uint8_t>(control::Limit::force);
    sample.tick.radial_immersion = 0.5F;
    sample.tick.side = estimation::CutSide::up;
    sample.tick.law_misfit = 2.5F;
    sample.tick.runout_um = 24.0F;
    sample.is_held = false;
    sample.drives.spindle_current_A = 8.5F;
    hal::set_present(sample.drives, hal::Present::spindle_current);
    hal::set_known(sample.drives, 1, false, true);
    sample.drives.axis_velocity_mm_s[1] = -12.5F;
    sample.conditions.set(firmware::Condition::drive_lost, true);
    const std::string text = telemetry_json(telemetry);
    for (const char* member : {R"("time_s":1.250000)", R"("state":"in_cut")", R"("limit":"force")", R"("fault":"none")",
                               R"("hold":false)", R"("override":0.75)", R"("ticks":42)", R"("radial_immersion":0.5)",
                               R"("spindle_current_A":8.5)", R"("cut_side":"up")", R"("law_misfit":2.5)",
                               R"("runout_um":24)", R"("y_velocity_mm_s":-12.5)", R"("conditions":["drive_lost"])"}) {
        CHECK_TEXT(contains(text, member), (std::string(member) + " in " + text).c_str());
    }
    CHECK(!contains(text, "y_current_A"));
}

TEST(TelemetryFields, show_numbers_that_no_json_can_hold_as_none) {
    telemetry.sample.tick.feed_override.ratio = std::numeric_limits<float>::infinity();
    telemetry.sample.program.operator_override = std::numeric_limits<float>::quiet_NaN();
    telemetry.sample.tick.feed_override.state = 200;  // of a later program
    const std::string text = telemetry_json(telemetry);
    CHECK(!contains(text, "inf") && !contains(text, "nan"));
    CHECK(!contains(text, R"("override")"));
}

TEST(TelemetryFields, are_documented_as_they_are) {
    std::ostringstream text;
    text << std::ifstream(MILLFORCE_SOURCE_DIR "/firmware/program/telemetry/README.md").rdbuf();
    CHECK_TEXT(contains(text.str(), telemetry_table()), "'millforce telemetry' prints the table of fields anew");
}
