// SPDX-License-Identifier: Apache-2.0
#include "remote/controller_messages.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files/input_error.hpp"
#include "remote/line_socket.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::sim;
using nlohmann::json;

/// The lines between the simulator and a controller in another process.

namespace {

/// What is said of it; "taken" where nothing is wrong.
std::string verdict_on(const std::string& line) {
    try {
        static_cast<void>(read_answer(line, 7, firmware::CncParameters<float>{}));
        return "taken";
    } catch (const host::InputError& error) {
        return error.what();
    }
}

std::string verdict_on_ready(const std::string& line) {
    try {
        return read_ready(line);
    } catch (const host::InputError& error) {
        return error.what();
    }
}

}  // namespace

TEST_GROUP(ControllerMessages){};

TEST(ControllerMessages, hello_holds_the_parameters_of_the_files_with_their_names) {
    Scenario scenario = read_scenario(MILLFORCE_SOURCE_DIR "/sim/scenarios/depth_ramp.toml");
    const json hello = json::parse(hello_message(scenario));
    LONGS_EQUAL(1, hello.at("version").get<int>());
    STRCMP_EQUAL("depth_ramp", hello.at("scenario").get<std::string>().c_str());
    DOUBLES_EQUAL(0.70, hello.at("machine").at("spindle").at("K_t1_Nm_per_A").get<double>(), 1e-12);
    DOUBLES_EQUAL(8192, hello.at("machine").at("spindle").at("encoder_counts_per_rev").get<double>(), 0);
    CHECK(hello.at("machine").at("z").contains("gravity_A"));
    DOUBLES_EQUAL(10, hello.at("tool").at("tool").at("diameter_mm").get<double>(), 0);
    STRCMP_EQUAL("down", hello.at("tool").at("tool").at("side").get<std::string>().c_str());
    CHECK_FALSE(hello.at("machine").contains("bus"));
}

TEST(ControllerMessages, what_was_not_measured_is_null) {
    hal::DriveSample sample;
    sample.spindle_current_A = 3.5F;
    sample.axis_current_A[0] = 2.0F;
    hal::set_present(sample, hal::Present::spindle_current);
    const hal::ProgramStatus program;
    const host::ContinuousCounts counts(4096);
    TracePoint estimate;
    estimate.tangential_force_N = 120.5;
    const json message = json::parse(sample_message({7, sample, program, counts, estimate}));
    DOUBLES_EQUAL(3.5, message.at("spindle_current_A").get<double>(), 0);
    for (const char* missing :
         {"spindle_angle_rad", "spindle_index_angle_rad", "x_current_A", "x_velocity_mm_s", "fx_N"}) {
        CHECK_TRUE_TEXT(message.at(missing).is_null(), missing);
    }
    DOUBLES_EQUAL(120.5, message.at("estimate").at("tangential_force_N").get<double>(), 0);
    CHECK(message.at("estimate").at("radial_immersion").is_null());
}

TEST(ControllerMessages, an_answer_may_hold_the_feed_and_bring_estimates_of_its_own) {
    const ControllerAnswer answer = read_answer(
        R"({"sample": 7, "override": 0.8, "hold": true, "axial_depth_mm": 3.5, "radial_immersion": null})", 7, {});
    DOUBLES_EQUAL(0.8, answer.override_ratio, 1e-6);
    CHECK(answer.hold);
    DOUBLES_EQUAL(3.5, answer.estimate->axial_depth_mm, 0);
    CHECK(std::isnan(answer.estimate->radial_immersion));
    CHECK_FALSE(read_answer(R"({"override": 1})", 7, {}).estimate.has_value());
}

TEST(ControllerMessages, an_answer_that_no_cnc_would_take_is_refused_with_what_was_expected) {
    const struct {
        const char* line;
        const char* part;
    } cases[]{
        {R"({"override": 0.05})", "override is 0.05, expected a number from 0.1 to 1.5"},
        {R"({"override": 1.6})", "override is 1.6"},
        {R"({"override": -1})", "override is -1"},
        {R"({"override": null})", "override is null"},
        {R"({"override": "1"})", "override is \"1\""},
        {R"({"override": [1]})", "override is array"},
        {R"({"override": NaN})", "expected a JSON object"},
        {R"({"override": Infinity})", "expected a JSON object"},
        {R"({"override": 1e999})", "expected a JSON object"},
        {R"({"override": 1} {"override": 1})", "expected a JSON object"},
        {R"({"hold": true})", "no key override"},
        {R"({"override": 1, "hold": 1})", "hold is 1, expected true or false"},
        {R"({"override": 1, "sample": 6})", "sample is 6, expected 7"},
        {R"({"override": 1, "overide": 1})", "unknown key overide, did you mean override?"},
        {R"({"override": 1, "axial_depth_mm": "3"})", "axial_depth_mm is \"3\", expected a number or null"},
        {"[]", "expected a JSON object"},
        {"", "expected a JSON object"},
        {"\xff\xfe", "expected a JSON object"},
    };
    for (const auto& [line, part] : cases) {
        const std::string verdict = verdict_on(line);
        STRCMP_CONTAINS(part, verdict.c_str());
        STRCMP_CONTAINS("the answer to sample 7", verdict.c_str());
    }
}

TEST(ControllerMessages, nesting_as_deep_as_a_line_is_long_is_refused) {
    const std::size_t half = LineSocket::longest_line / 2;
    STRCMP_CONTAINS("expected a JSON object", verdict_on(std::string(2 * half, '[')).c_str());
    const std::string deep = std::string(half, '[') + std::string(half, ']');
    STRCMP_CONTAINS("override is array", verdict_on("{\"override\":" + deep + "}").c_str());
}

TEST(ControllerMessages, a_controller_has_a_name_of_its_own_and_the_same_version) {
    STRCMP_EQUAL("mine", verdict_on_ready(R"({"type": "ready", "version": 1, "name": "mine"})").c_str());
    STRCMP_CONTAINS("version is 2, expected 1",
                    verdict_on_ready(R"({"type": "ready", "version": 2, "name": "mine"})").c_str());
    STRCMP_CONTAINS("name is \"constant\"",
                    verdict_on_ready(R"({"type": "ready", "version": 1, "name": "constant"})").c_str());
    STRCMP_CONTAINS("name is \"\"", verdict_on_ready(R"({"type": "ready", "version": 1, "name": ""})").c_str());
    STRCMP_CONTAINS("no key type", verdict_on_ready(R"({"override": 1})").c_str());
}
