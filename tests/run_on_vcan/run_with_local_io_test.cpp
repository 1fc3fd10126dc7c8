// SPDX-License-Identifier: Apache-2.0
#include "drivers/iio/fake_iio.hpp"
#include "live_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;

namespace {

/// No drive on the bus: the spindle's and x's currents by a converter, their encoders by counters, the override as a
/// voltage, all files of a made-up tree.
class LocalFolder : public LiveFolder {
  public:
    LocalFolder() {
        tree.write("adc/in_voltage0_raw", "1000\n");
        tree.write("adc/in_voltage1_raw", "1000\n");
        tree.write("adc/in_voltage_scale", "2.0\n");
        tree.write("count_spindle", "0\n");
        tree.write("count_x", "0\n");
        tree.write("dac/out_voltage0_raw", "7\n");
        tree.write("dac/out_voltage0_scale", "2.5\n");
        const std::string usual = text("machine.toml");
        write("machine.toml", usual.substr(0, usual.find("[bus]")) + R"([bus]
role = "master"
produces_sync = true
sync_period_ms = 4.0
collect_time_ms = 4.0
[bus.spindle]
node_id = 1
[bus.x]
node_id = 2
[iio]
mode = "polled"
stale_ms = 200
device = ")" + tree.name("adc") + R"("
[iio.spindle]
current_channel = "voltage0"
A_per_V = 1
count_file = ")" + tree.name("count_spindle") +
                                  R"("
[iio.x]
current_channel = "voltage1"
A_per_V = 1
mm_per_count = 0.001
count_file = ")" + tree.name("count_x") +
                                  R"("
[override_voltage]
channel = "voltage0"
device = ")" + tree.name("dac") + R"("
)");
    }
    /// Waits for the voltage to be the safe one, or another.
    [[nodiscard]] bool is_out(bool is_safe) const {
        return wait_until([&] {
            const std::string raw = tree.read("dac/out_voltage0_raw");
            return !raw.empty() && (raw == "0") == is_safe;
        });
    }

    iio::test::FakeTree tree{};
};

}  // namespace

TEST_GROUP(RunWithLocalIo){};

TEST(RunWithLocalIo, currents_by_a_converter_are_ticks_and_a_voltage_and_their_fault_is_a_safe_voltage_and_replays) {
    const LocalFolder folder;
    test::Program controller(folder.run_words());
    CHECK(folder.logged("\"type\":\"estimate\""));
    CHECK(folder.is_out(false));
    folder.tree.write("adc/in_voltage1_raw", "broken\n");
    CHECK(folder.logged("\"fault\":\"stale_input\""));
    CHECK(folder.is_out(true));
    controller.interrupt(SIGTERM);
    controller.wait();
    LONGS_EQUAL(0, controller.exit_code());
    const test::Ended replay = test::run_millforce({"replay", folder.file("run.log"), "--machine",
                                                    folder.file("machine.toml"), "--tool", folder.file("tool.toml"),
                                                    "--verify", folder.file("run.jsonl"), "-o", folder.file("r.csv")});
    LONGS_EQUAL(0, replay.exit_code);
    STRCMP_EQUAL("", replay.error.c_str());
}

TEST(RunWithLocalIo, sighup_ends_with_the_safe_voltage) {
    const LocalFolder folder;
    test::Program controller(folder.run_words());
    CHECK(folder.logged("\"type\":\"estimate\""));
    CHECK(folder.is_out(false));
    controller.interrupt(SIGHUP);
    controller.wait();
    LONGS_EQUAL(0, controller.exit_code());
    STRCMP_EQUAL("0", folder.tree.read("dac/out_voltage0_raw").c_str());
}

TEST(RunWithLocalIo, a_killed_one_leaves_its_voltage_and_the_next_one_sets_the_safe_one_before_its_first_sample) {
    const LocalFolder folder;
    test::Program controller(folder.run_words());
    CHECK(folder.logged("\"type\":\"estimate\""));
    CHECK(folder.is_out(false));
    controller.interrupt(SIGKILL);
    controller.wait();
    CHECK(folder.tree.read("dac/out_voltage0_raw") != "0");
    folder.tree.remove("adc");
    test::Program next(folder.run_words());
    CHECK(folder.is_out(true));
}

TEST(RunWithLocalIo, a_converter_that_is_not_there_is_told_with_its_file_and_no_override_goes_out) {
    const LocalFolder folder;
    folder.tree.remove("adc");
    test::Program controller(folder.run_words());
    CHECK(folder.logged("\"local_input_failed\""));
    CHECK(folder.is_out(true));
    controller.interrupt(SIGTERM);
    controller.wait();
    STRCMP_CONTAINS("local_input_failed (absent: ", controller.error().c_str());
    STRCMP_CONTAINS(folder.tree.name("adc").c_str(), controller.error().c_str());
    CHECK(folder.text("run.jsonl").find("\"type\":\"estimate\"") == std::string::npos);
}

TEST(RunWithLocalIo, a_voltage_that_cannot_be_written_is_told_and_holds_the_other_ways_out) {
    const LocalFolder folder;
    folder.tree.remove("dac");
    const Candump candump("vcan0");
    test::Program controller(folder.run_words());
    CHECK(folder.logged("\"local_output_failed\""));
    CHECK(folder.logged("\"type\":\"estimate\""));
    CHECK(candump.has("1FE#", 10));
    controller.interrupt(SIGTERM);
    controller.wait();
    for (const std::string& frame : candump.frames()) {
        if (frame.starts_with("1FE#")) {
            STRCMP_EQUAL("01", frame.substr(8, 2).c_str());  // hold
        }
    }
}
