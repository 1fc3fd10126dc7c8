// SPDX-License-Identifier: Apache-2.0
#include "inputs.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce::test;

namespace {

const std::string bus_text = "[bus]\n" + spindle_and_x_on_bus;

/// machine.toml with a listener's bus, and log.csv as a candump log of a spindle at 4000 rpm with x at 20 mm/s.
class LiveInputs : public Inputs {
  public:
    LiveInputs() {
        write("machine.toml", with(with(machine_text + bus_text, "[spindle]\n", "[spindle]\nrated_current_A = 12\n"),
                                   "[x]\n", "[x]\nrated_current_A = 12\n"));
        write("log.csv", log());
    }

    static std::string log(const std::string& interface = "can0") {
        std::string text = "# recorded on the machine\n";
        for (int k = 0; k < 300; ++k) {
            const auto line = [&](int after_us, const std::string& frame) {
                std::array<char, 100> buffer{};
                std::snprintf(buffer.data(), buffer.size(), "(1700000000.%06d) %s %s\n", 1000 * k + after_us,
                              interface.c_str(), frame.c_str());
                text += buffer.data();
            };
            std::array<char, 40> spindle{};
            const unsigned count = 546U * static_cast<unsigned>(k);
            std::snprintf(spindle.data(), spindle.size(), "181#%02X%02X%02X00A700", count & 0xFFU,
                          (count >> 8U) & 0xFFU, (count >> 16U) & 0xFFU);
            line(0, "080#");
            line(150, spindle.data());
            line(300, "182#204E0000A700");
        }
        return text;
    }
    [[nodiscard]] Ended run(const std::string& interface = "vcan0") const {
        return run_millforce({"run", interface, "--machine", name("machine.toml"), "--tool", name("tool.toml")});
    }
};

void replay_is_refused(const LiveInputs& in, const std::vector<std::string>& more,
                       const std::vector<std::string>& parts) {
    STRCMP_EQUAL("", not_refused(in.replay(more), parts).c_str());
    CHECK_FALSE(std::filesystem::exists(in.path("out.csv")));
}

}  // namespace

TEST_GROUP(LiveBus){};

TEST(LiveBus, a_candump_log_is_known_by_its_content_and_replayed) {
    const LiveInputs in;
    const Ended replay = in.replay({"--interval", "0"});
    STRCMP_EQUAL("", replay.error.c_str());
    LONGS_EQUAL(0, replay.exit_code);
    CHECK(contains(replay.out, "299 rows"));  // the last SYNC's sample ends with the log
    CHECK(contains(replay.out, "as a listener"));
    const std::string csv = text_of(in.path("out.csv"));
    CHECK(csv.starts_with("time_s,state,tangential_force_N"));
    CHECK(contains(csv, "\n1700000000.298,"));
}

TEST(LiveBus, rated_values_that_the_machine_lacks_come_from_the_drives_answers_in_the_log) {
    const LiveInputs in;
    in.write("machine.toml", with(machine_text + bus_text, "[x]\n", "[x]\nrated_current_A = 12\n"));
    replay_is_refused(in, {}, {"machine.toml", "bus.spindle: no rated value, and a listener cannot ask"});
    in.write("machine.toml", with(with(machine_text + bus_text, "[x]\n", "[x]\nrated_current_A = 12\n"), "[bus]\n",
                                  "[bus]\nrole = \"master\"\n"));
    replay_is_refused(in, {}, {"log.csv", "no drive's answer gives the rated value of spindle", "rated_current_A"});
    in.write("log.csv", "(1699999999.0) can0 581#43756000E02E0000\n" + LiveInputs::log());
    LONGS_EQUAL(0, in.replay().exit_code);
}

TEST(LiveBus, a_log_that_is_none_is_refused_with_its_place) {
    const LiveInputs in;
    in.write("log.csv", LiveInputs::log() + "(1700000001.0) can0 181#1\n");
    replay_is_refused(in, {}, {"log.csv:902:", "'(1700000001.0) can0 181#1', expected"});
    in.write("log.csv", LiveInputs::log() + LiveInputs::log("\x1b[1m"));
    replay_is_refused(in, {}, {"frames of ?[1m, can0; expected one interface, or --interface"});
    in.write("log.csv", LiveInputs::log() + LiveInputs::log("can1"));
    replay_is_refused(in, {}, {"frames of can0, can1; expected one interface, or --interface"});
    replay_is_refused(in, {"--interface", "can2"}, {"'can2' is not in", "expected one of can0, can1"});
    LONGS_EQUAL(0, in.replay({"--interface", "can1"}).exit_code);
    in.write("log.csv", "(1700000000.0) can0 123#00\n");
    std::filesystem::remove(in.path("out.csv"));
    replay_is_refused(in, {}, {"1 frames and no complete sample; expected SYNC and the PDOs"});
    replay_is_refused(in, {"--programmed-feed", "1500"}, {"--programmed-feed", "is a candump log"});
}

TEST(LiveBus, a_log_that_jumps_in_time_ends_all_the_same) {
    const LiveInputs in;
    in.write("log.csv", LiveInputs::log() + "(9999999999.999999) can0 080#\n" + LiveInputs::log());
    const Ended replay = in.replay();
    LONGS_EQUAL(0, replay.exit_code);
    CHECK(contains(text_of(in.path("out.csv")), ",fault,"));
}

TEST(LiveBus, without_a_bus_in_the_machine_each_command_says_what_is_missing) {
    const LiveInputs in;
    in.write("machine.toml", machine_text);
    const std::vector<std::string> parts{"machine.toml: no drive on the bus; expected the tables [bus]"};
    STRCMP_EQUAL("", not_refused(in.run(), parts).c_str());
    replay_is_refused(in, {}, parts);
    STRCMP_EQUAL("",
                 not_refused(run_millforce({"simulate", in.name("scenario.toml"), "--bus", "vcan0"}), parts).c_str());
}

TEST(LiveBus, an_interface_that_none_can_be_and_files_that_cannot_be_written_are_refused) {
    const LiveInputs in;
    STRCMP_EQUAL("", not_refused(in.run("a_name_of_16_chr"), {"'a_name_of_16_chr': expected a CAN interface"}).c_str());
    const Ended run = run_millforce({"run", "vcan0", "--machine", in.name("machine.toml"), "--tool",
                                     in.name("tool.toml"), "--log", in.name("no_folder/run.jsonl")});
    STRCMP_EQUAL("", not_refused(run, {"no_folder/run.jsonl: No such file or directory"}).c_str());
}

TEST(LiveBus, an_output_that_is_an_input_or_the_other_output_is_refused_by_whatever_name) {
    const LiveInputs in;
    const auto run = [&](std::vector<std::string> outputs) {
        outputs.insert(outputs.begin(),
                       {"run", "vcan0", "--machine", in.name("machine.toml"), "--tool", in.name("tool.toml")});
        return run_millforce(outputs);
    };
    const std::string before = in.read("machine.toml");
    std::filesystem::create_symlink(in.path("machine.toml"), in.path("link.toml"));
    for (const char* option : {"--log", "--record"}) {
        for (const char* file : {"machine.toml", "link.toml", "tool.toml"}) {
            STRCMP_EQUAL("", not_refused(run({option, in.name(file)}), {file, "would be overwritten"}).c_str());
        }
    }
    STRCMP_EQUAL(before.c_str(), in.read("machine.toml").c_str());
    in.write("part.ngc", "G1 X10 F600\nM30\n");
    STRCMP_EQUAL("", not_refused(run({"--program", in.name("part.ngc"), "--log", in.name("part.ngc"), "--learn",
                                      in.name("part.map")}),
                                 {"part.ngc", "would be overwritten"})
                         .c_str());
    STRCMP_EQUAL("", not_refused(run({"--log", in.name("a"), "--record", in.name("./a")}),
                                 {"--log, --record: both are", "expected two files"})
                         .c_str());
}
