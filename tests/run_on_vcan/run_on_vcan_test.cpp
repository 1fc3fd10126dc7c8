// SPDX-License-Identifier: Apache-2.0
#include "live_bench.hpp"
#include "program/service_manager.hpp"

#include <CppUTest/TestHarness.h>

#include <chrono>
#include <cstdlib>
#include <thread>

using namespace millforce;
using namespace millforce::vcan;

namespace {

constexpr const char* stopped_heartbeat = "77E#04";  // the controller's last frame

/// Of the first run in the summary.
double peak_over_limit(const LiveFolder& folder) {
    return std::stod(member(folder.text("out/summary.json"), "peak_over_limit"));
}

/// Every tick of the run, by its digest.
void replays_every_tick_of_the_run(const LiveFolder& folder, const std::string& log, const Words& pace) {
    const test::Ended replay = test::run_millforce(
        with({"replay", log, "--machine", folder.file("machine.toml"), "--tool", folder.file("tool.toml"), "--verify",
              folder.file("run.jsonl"), "-o", folder.file("replay.csv")},
             pace));
    STRCMP_EQUAL("", replay.error.c_str());
    LONGS_EQUAL(0, replay.exit_code);
}

/// And the replay's rows but for the last ones, which see the bus after the run had ended.
void replays_to_the_estimates_of_the_run(const LiveFolder& folder, const std::string& log) {
    replays_every_tick_of_the_run(folder, log, {});
    const std::vector<std::string> run = estimates_of(folder.text("run.jsonl"));
    const std::vector<std::string> again = rows_of(folder.text("replay.csv"));
    CHECK(run.size() > 100);
    CHECK(again.size() >= run.size());
    for (std::size_t k = 0; k < run.size(); ++k) {
        STRCMP_EQUAL(run[k].c_str(), again[k].c_str());
    }
}

/// A busy computer would lose samples, and then hold or fault.
const Words slow_motion{"--slow-motion", "4"};

void ends_with_hold_and_complete_files(int signal) {
    const LiveFolder folder;
    const Candump candump("vcan0");
    test::Program controller(with(with(folder.run_words(), {"--report", folder.file("page")}), slow_motion));
    test::Program plant(with(folder.plant_words(), slow_motion));
    CHECK(folder.logged("\"state\":\"in_cut\""));
    controller.interrupt(signal);
    controller.wait();
    LONGS_EQUAL(0, controller.exit_code());
    plant.interrupt(SIGTERM);
    plant.wait();
    CHECK(candump.has(stopped_heartbeat));
    const std::vector<std::string> frames = candump.frames();
    std::string last_override;
    std::string last_heartbeat;
    for (const std::string& frame : frames) {
        last_override = frame.starts_with("1FE#") ? frame : last_override;
        last_heartbeat = frame.starts_with("77E#") ? frame : last_heartbeat;
    }
    STRCMP_EQUAL(stopped_heartbeat, last_heartbeat.c_str());
    STRCMP_EQUAL("01", last_override.substr(8, 2).c_str());  // hold
    CHECK(folder.text("run.jsonl").ends_with("}\n"));
    CHECK(folder.text("run.log").ends_with("\n"));
    const std::string page = folder.text("page/report.html");
    CHECK(page.ends_with("</html>\n"));
    CHECK(has(page, "Run on vcan0"));
    CHECK(has(page, "drive_preparing (spindle, x, y, z): waiting for a drive to answer"));
    CHECK(has(page, "The tool was in the cut for "));
}

}  // namespace

TEST_GROUP(RunOnVcan){void teardown() override{shell("ip link set vcan0 up");
}
}
;

TEST(RunOnVcan, in_real_time_what_candump_recorded_replays_bit_for_bit_with_each_pause_of_this_machine) {
    const LiveFolder folder;
    const Candump candump("vcan0", folder.file("candump.log"));
    test::Program controller(folder.run_words());
    test::Program plant(folder.plant_words());
    CHECK(wait_until([&] { return estimates_of(folder.text("run.jsonl")).size() > 500; }));
    controller.interrupt(SIGTERM);
    controller.wait();
    plant.interrupt(SIGTERM);
    plant.wait();
    CHECK(candump.is_quiet());
    LONGS_EQUAL(0, controller.exit_code());
    CHECK(has(controller.out(), " 0 not sent, 0 lost"));
    std::printf("\n    %s", controller.out().c_str());
    replays_to_the_estimates_of_the_run(folder, folder.file("run.log"));
    replays_to_the_estimates_of_the_run(folder, folder.file("candump.log"));
}

TEST(RunOnVcan, in_lock_step_a_part_at_1_kHz_has_the_figures_of_one_process_and_every_tick_replays_whatever_the_load) {
    const LiveFolder folder;
    folder.write("machine.toml", test::text_of(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml"));
    const Words lock_step{"--lock-step"};
    const Candump candump("vcan0", folder.file("candump.log"));
    LockStep run(folder.run_words(), folder);
    run.mill();
    CHECK(candump.is_quiet());
    STRCMP_EQUAL("", run.plant().error().c_str());
    LONGS_EQUAL(0, run.plant().exit_code());  // the bounds hold, the program finished
    LONGS_EQUAL(0, run.controller().exit_code());
    CHECK(has(run.controller().out(), " 0 not sent, 0 lost"));
    CHECK(has(folder.text("run.jsonl"), "\"state\":\"in_cut\""));
    const double peak_over_bus = peak_over_limit(folder);
    const test::Ended in_process =
        test::run_millforce({"simulate", folder.file("scenario.toml"), "--out", folder.file("out")});
    LONGS_EQUAL(0, in_process.exit_code);
    DOUBLES_EQUAL(peak_over_limit(folder), peak_over_bus, 0.03);
    replays_every_tick_of_the_run(folder, folder.file("run.log"), lock_step);
    replays_every_tick_of_the_run(folder, folder.file("candump.log"), lock_step);
}

/// SIGHUP: the terminal or the session behind it is gone.
TEST(RunOnVcan, sigterm_and_sighup_end_with_hold_a_stopped_heartbeat_and_complete_files) {
    for (const int signal : {SIGTERM, SIGHUP}) {
        ends_with_hold_and_complete_files(signal);
    }
}

TEST(RunOnVcan, a_plant_that_vanishes_is_stale_input_and_lost_by_name_and_comes_back) {
    const LiveFolder folder;
    test::Program controller(folder.run_words());
    {
        test::Program plant(folder.plant_words());
        CHECK(folder.logged("\"type\":\"estimate\""));
        plant.interrupt(SIGSTOP);
        CHECK(folder.logged("\"fault\":\"stale_input\""));
        CHECK(folder.logged("\"drive_lost\""));
        plant.interrupt(SIGKILL);
        plant.wait();
    }
    folder.write("run.jsonl", "");
    test::Program plant(folder.plant_words());
    CHECK(folder.logged("\"spindle\":{\"state\":\"operational\""));
    controller.interrupt(SIGINT);
    controller.wait();
    plant.interrupt(SIGTERM);
    plant.wait();
    LONGS_EQUAL(0, controller.exit_code());
    CHECK(has(controller.error(), "drive_lost ("));
}

TEST(RunOnVcan, an_interface_that_goes_down_is_told_and_waited_for) {
    const LiveFolder folder;
    test::Program controller(with(folder.run_words(), slow_motion));
    test::Program plant(with(folder.plant_words(), slow_motion));
    CHECK(folder.logged("\"type\":\"estimate\""));
    LONGS_EQUAL(0, shell("ip link set vcan0 down"));
    CHECK(folder.logged("\"interface_down\""));
    CHECK(folder.logged("\"input_stale\""));
    LONGS_EQUAL(0, shell("ip link set vcan0 up"));
    CHECK(folder.logged("\"fault\":\"stale_input\""));
    controller.interrupt(SIGTERM);
    controller.wait();
    LONGS_EQUAL(0, controller.exit_code());
    CHECK(has(controller.error(), "vcan0: interface_down"));
    plant.interrupt(SIGTERM);
    plant.wait();
}

TEST(RunOnVcan, an_interface_that_is_not_there_is_told_and_waited_for) {
    const LiveFolder folder;
    std::vector<std::string> words = folder.run_words();
    words[1] = "nocan0";
    test::Program controller(words);
    CHECK(folder.logged("\"interface_absent\""));
    controller.interrupt(SIGTERM);
    controller.wait();
    LONGS_EQUAL(0, controller.exit_code());
}

TEST(RunOnVcan, a_status_that_nobody_can_read_ends_nothing) {
    const LiveFolder folder;
    const std::string run = std::string("timeout --preserve-status -s TERM 2 ") + MILLFORCE_PROGRAM +
                            " run nocan0 --machine " + folder.file("machine.toml") + " --tool " +
                            folder.file("tool.toml");
    for (const std::string& unread : {run + " >/dev/full 2>/dev/full; ended=$?", "{ " + run + " 2>&1; ended=$?; }"}) {
        shell("{ " + unread + "; echo $ended > " + folder.file("ended") + "; } | true");
        CHECK(wait_until([&] { return has(folder.text("ended"), "\n"); }));
        CHECK(has("0\n2\n", folder.text("ended")));  // 2: its summary could not be written
        folder.write("ended", "");
    }
}

TEST(RunOnVcan, a_log_that_cannot_be_written_is_told_by_its_name) {
    const LiveFolder folder;
    Words words = folder.run_words();
    words[1] = "nocan0";
    words[7] = "/dev/full";
    test::Program controller(words);
    CHECK(controller.says("interface_absent"));
    controller.interrupt(SIGTERM);
    controller.wait();
    LONGS_EQUAL(1, controller.exit_code());
    CHECK(has(controller.error(), "/dev/full: a write failed"));
}

TEST(RunOnVcan, a_service_manager_hears_that_it_is_ready_alive_and_stopping) {
    const LiveFolder folder;
    const test::ServiceManager manager(folder.file("notify"), 1'000'000);
    Words words = folder.run_words();
    words[1] = "nocan0";
    test::Program controller(words);
    STRCMP_EQUAL("READY=1", manager.receive().c_str());
    CHECK(manager.hears("STATUS=interface_absent, sync_lost, input_incomplete, program_unknown"));
    CHECK(manager.hears("WATCHDOG=1"));
    CHECK(manager.hears("WATCHDOG=1"));
    controller.interrupt(SIGTERM);
    controller.wait();
    CHECK(manager.hears("STOPPING=1"));
}
