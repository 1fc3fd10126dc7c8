// SPDX-License-Identifier: Apache-2.0
#include "live_bench.hpp"
#include "program/pauses.hpp"
#include "program/service_manager.hpp"

#include <sys/resource.h>

#include <cstdint>
#include <cstdio>
#include <ctime>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;

/// `millforce run` on a bus with its machine, and what happens to a process of a computer: it is stopped, its disk is
/// full, its files are renamed, its clock is set, its memory is at its end, it is there twice.

namespace {

constexpr int pause_ms = 1000;  // stale_s of the machine here is 0.4 s

/// An override frame's bytes as candump writes them.
bool says_hold(const std::string& frame) {
    return frame.substr(8, 2) == "01";
}
bool is_override(const std::string& frame) {
    return frame.starts_with("1FE#");
}

const std::string listeners_bus = "[bus]\nsync_period_ms = 20.0\ncollect_time_ms = 20.0\n" + test::spindle_and_x_on_bus;

/// A CNC's SYNC with the answers of its drives: a spindle at 400 rpm, x at 20 mm/s, idle currents.
void send_samples_for_ever() {
    Listener bus(on("vcan0"));
    for (std::uint32_t count = 0;; count += 1092) {
        bus.socket.send(frame_of(0x080, {}));
        bus.socket.send(
            frame_of(0x181, {count & 0xFFU, count >> 8U & 0xFFU, count >> 16U & 0xFFU, count >> 24U, 0x75, 0}));
        bus.socket.send(frame_of(0x182, {0x20, 0x4E, 0, 0, 0xA7, 0}));
        bus.run_ms(20);
    }
}

/// This kernel is a guest of its own: its clock may be set.
bool is_clock_ours() {
    return test::text_of("/proc/cpuinfo").find("User Mode Linux") != std::string::npos;
}

void move_clock(double seconds) {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    const auto whole = static_cast<time_t>(seconds);
    now.tv_sec += whole;
    now.tv_nsec += static_cast<long>((seconds - static_cast<double>(whole)) * 1e9);
    now.tv_sec += now.tv_nsec < 0 ? -1 : now.tv_nsec / 1'000'000'000;
    now.tv_nsec = (now.tv_nsec + 1'000'000'000) % 1'000'000'000;
    CHECK(::clock_settime(CLOCK_REALTIME, &now) == 0);
}

std::uintmax_t size_of(const std::string& file) {
    std::error_code none_yet;
    const std::uintmax_t size = std::filesystem::file_size(file, none_yet);
    return none_yet ? 0 : size;
}

std::size_t line_count(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

/// With the machine on the bus, from its first estimate on.
TEST_GROUP(RunDisturbed) {
    const LiveFolder folder{};
    std::unique_ptr<Candump> candump;
    std::unique_ptr<test::Program> controller;
    std::unique_ptr<test::Program> plant;

    void start() {
        candump.reset();
        candump = std::make_unique<Candump>("vcan0", folder.file("candump.log"));
        controller = std::make_unique<test::Program>(folder.run_words());
        plant = std::make_unique<test::Program>(folder.plant_words());
        CHECK(folder.logged("\"type\":\"estimate\""));
    }
    /// The bus of send_samples_for_ever().
    void be_beside_a_master() {
        const std::string machine =
            test::with(folder.text("machine.toml"), "sample_rate_hz = 250", "sample_rate_hz = 50");
        folder.write("machine.toml", machine.substr(0, machine.find("[bus]")) + listeners_bus);
        candump = std::make_unique<Candump>("vcan0", folder.file("candump.log"));
    }
    void end(int exit_code = 0) {
        controller->interrupt(SIGTERM);
        controller->wait();
        LONGS_EQUAL(exit_code, controller->exit_code());
        plant->interrupt(SIGTERM);
        plant->wait();
    }
    /// Every tick of the run, bit for bit.
    void replays() const {
        const test::Ended replay = test::run_millforce(
            {"replay", folder.file("run.log"), "--machine", folder.file("machine.toml"), "--tool",
             folder.file("tool.toml"), "--verify", folder.file("run.jsonl"), "-o", folder.file("replay.csv")});
        STRCMP_EQUAL("", replay.error.c_str());
        LONGS_EQUAL(0, replay.exit_code);
    }
    [[nodiscard]] std::vector<std::string> overrides() const {
        std::vector<std::string> frames = candump->frames();
        std::erase_if(frames, [](const std::string& frame) { return !is_override(frame); });
        return frames;
    }
    [[nodiscard]] std::string last_heartbeat() const {
        std::vector<std::string> frames = candump->frames();
        std::erase_if(frames, [](const std::string& frame) { return !frame.starts_with("77E#"); });
        return frames.empty() ? "" : frames.back();
    }
    /// Those after half a pause or more without one, by the kernel's stamps.
    [[nodiscard]] std::vector<std::string> overrides_after_pause() const {
        std::vector<std::string> frames;
        double last_s = 0.0;
        for (const std::string& line : lines_of(folder.file("candump.log"))) {
            const std::string frame = line.substr(line.rfind(' ') + 1);
            if (is_override(frame)) {
                const double time_s = std::stod(line.substr(1));
                const bool is_after_pause = last_s > 0.0 && time_s > last_s + 0.5e-3 * pause_ms;
                last_s = time_s;
                if (is_after_pause || !frames.empty()) {
                    frames.push_back(frame);
                }
            }
        }
        return frames;
    }
    /// So many more override frames.
    [[nodiscard]] bool goes_on(std::size_t count) const {
        const std::size_t before = overrides().size();
        return wait_until([&] { return overrides().size() >= before + count; });
    }
    [[nodiscard]] bool estimates_go_on(std::size_t count) const {
        const std::size_t before = estimates_of(folder.text("run.jsonl")).size();
        return wait_until([&] { return estimates_of(folder.text("run.jsonl")).size() >= before + count; });
    }
    template <typename Pause>
    void holds_after() {
        const test::ServiceManager manager(folder.file("notify"), 400'000);
        start();
        {
            const Pause stopped(controller->process());
            CHECK(manager.hears_nothing(pause_ms));
        }
        CHECK(controller->says("process_paused ("));
        CHECK(wait_until([&] { return overrides_after_pause().size() > 20; }));
        for (const std::string& frame : overrides_after_pause()) {
            CHECK(says_hold(frame));
        }
        CHECK(folder.logged("\"fault\":\"stale_input\""));
        CHECK(manager.hears("WATCHDOG=1"));
        end();
    }
};

TEST(RunDisturbed, after_sigstop_holds_and_says_so_and_is_not_reported_alive_meanwhile) {
    holds_after<test::Stopped>();
}

TEST(RunDisturbed, after_a_debuggers_pause_of_its_loop_too) {
    holds_after<test::Debugged>();
}

/// The drives are the CNC's and go on: no sample is missing, and the tick finds no gap.
TEST(RunDisturbed, after_sigstop_beside_a_cnc_that_is_the_master_holds_until_a_newer_sample_without_a_fault) {
    be_beside_a_master();
    const Child drives([] { send_samples_for_ever(); });
    controller = std::make_unique<test::Program>(folder.run_words());
    CHECK(wait_until([&] { return !overrides().empty() && !says_hold(overrides().back()); }));
    {
        const test::Stopped stopped(controller->process());
        sleep_ms(pause_ms);
        candump = std::make_unique<Candump>("vcan0", folder.file("after.log"));
    }
    CHECK(wait_until([&] { return !overrides().empty(); }));
    CHECK(says_hold(overrides().front()));
    CHECK(controller->says("process_paused ("));
    CHECK(wait_until([&] { return !says_hold(overrides().back()); }));
    controller->interrupt(SIGTERM);
    controller->wait();
    LONGS_EQUAL(0, controller->exit_code());
    CHECK(folder.text("run.jsonl").find("\"fault\":\"stale_input\"") == std::string::npos);
}

TEST(RunDisturbed, a_full_disk_is_told_at_once_and_costs_whole_lines_and_no_override) {
    start();
    CHECK(estimates_go_on(5));
    const rlim_t full = size_of(folder.file("run.jsonl")) + 100;
    const rlimit limited{full, RLIM_INFINITY};
    LONGS_EQUAL(0, ::prlimit(controller->process(), RLIMIT_FSIZE, &limited, nullptr));
    CHECK(controller->says("run.jsonl: File too large: lines are missing"));
    CHECK(goes_on(50));
    CHECK(folder.text("run.jsonl").ends_with("}\n"));
    CHECK(folder.text("run.log").ends_with("\n"));
    const rlimit free{RLIM_INFINITY, RLIM_INFINITY};
    LONGS_EQUAL(0, ::prlimit(controller->process(), RLIMIT_FSIZE, &free, nullptr));
    CHECK(folder.logged("{\"type\":\"missing\",\"lines\":"));
    CHECK(wait_until([&] { return folder.text("run.log").find("# ") != std::string::npos; }));
    CHECK(estimates_go_on(5));
    end(1);
    CHECK(controller->error().find("a write failed; the file is incomplete") != std::string::npos);
}

TEST(RunDisturbed, messages_that_nobody_takes_cost_no_override_and_no_farewell) {
    start();
    controller->narrow_pipe_of_error();
    std::filesystem::rename(folder.file("run.jsonl"), folder.file("run.jsonl.1"));
    std::filesystem::create_directory(folder.file("run.jsonl"));
    for (int k = 0; k < 60; ++k) {  // a message of some 80 bytes each
        controller->interrupt(SIGUSR1);
        sleep_ms(25);
    }
    CHECK(goes_on(50));
    controller->interrupt(SIGTERM);
    controller->wait();
    CHECK(wait_until([&] { return last_heartbeat() == "77E#04"; }));
    CHECK(says_hold(overrides().back()));
    CHECK(controller->error().find("run.jsonl: Is a directory: the old file is written on") != std::string::npos);
    plant->interrupt(SIGTERM);
    plant->wait();
}

TEST(RunDisturbed, logs_that_are_renamed_go_on_in_new_files_after_sigusr1_without_a_line_lost) {
    start();
    CHECK(estimates_go_on(40));
    for (const char* file : {"run.jsonl", "run.log"}) {
        std::filesystem::rename(folder.file(file), folder.file(std::string(file) + ".1"));
    }
    CHECK(wait_until([&, size = size_of(folder.file("run.log.1"))] {
        return size_of(folder.file("run.log.1")) > size + 1000;  // still the old one
    }));
    controller->interrupt(SIGUSR1);
    CHECK(estimates_go_on(40));
    end();
    for (const char* file : {"run.jsonl", "run.log"}) {
        const std::string old = folder.text(std::string(file) + ".1");
        const std::string next = folder.text(file);
        CHECK(old.ends_with("\n") && line_count(old) > 20 && line_count(next) > 20);
        folder.write(file, old + next);
    }
    replays();
}

TEST(RunDisturbed, a_log_that_is_emptied_by_who_copied_it_goes_on_at_its_begin) {
    start();
    CHECK(estimates_go_on(5));
    std::filesystem::resize_file(folder.file("run.jsonl"), 0);
    CHECK(estimates_go_on(5));
    STRCMP_EQUAL("{", folder.text("run.jsonl").substr(0, 1).c_str());
    end();
}

TEST(RunDisturbed, a_clock_that_is_set_is_neither_a_fault_nor_a_gap_and_the_recording_replays) {
    if (!is_clock_ours()) {
        std::printf("skipped: the clock of this machine is not to be set\n");
        return;
    }
    start();
    for (const double step_s : {3600.0, -3600.0, -0.3, 0.3}) {
        move_clock(step_s);
        CHECK(estimates_go_on(10));
    }
    end();
    CHECK(folder.text("run.jsonl").find("\"fault\":\"stale_input\"") == std::string::npos);
    replays();
}

TEST(RunDisturbed, goes_on_where_there_is_no_more_memory) {
    start();
    const rlimit nothing{1, RLIM_INFINITY};
    LONGS_EQUAL(0, ::prlimit(controller->process(), RLIMIT_AS, &nothing, nullptr));
    CHECK(estimates_go_on(50));
    end();
}

TEST(RunDisturbed, two_on_one_bus_both_hold_and_say_so_until_one_has_ended) {
    be_beside_a_master();
    const Child drives([] { send_samples_for_ever(); });
    controller = std::make_unique<test::Program>(folder.run_words());
    CHECK(wait_until([&] { return !overrides().empty() && !says_hold(overrides().back()); }));
    std::vector<std::string> words = folder.run_words();
    words.resize(6);  // without its files
    test::Program second(words);
    CHECK(controller->says("override_foreign"));
    CHECK(second.says("override_foreign"));
    CHECK(wait_until([&] {
        const std::vector<std::string> frames = overrides();
        return frames.size() > 40 && std::all_of(frames.end() - 40, frames.end(), says_hold);
    }));
    second.interrupt(SIGTERM);
    second.wait();
    CHECK(wait_until([&] {
        const std::vector<std::string> lines = lines_of(folder.file("run.jsonl"));
        const auto last = std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) {
            return line.find("\"conditions\":[") != std::string::npos;
        });
        return last != lines.rend() && last->find("override_foreign") == std::string::npos;
    }));
    controller->interrupt(SIGTERM);
    controller->wait();
    LONGS_EQUAL(0, controller->exit_code());
}

TEST(RunDisturbed, a_log_that_another_one_writes_is_refused_and_stays_as_it_is) {
    start();
    CHECK(estimates_go_on(5));
    STRCMP_EQUAL("", test::not_refused(test::run_millforce(folder.run_words()),
                                       {"run.log: is being written by a running program"})
                         .c_str());
    CHECK(estimates_of(folder.text("run.jsonl")).size() > 5);
    end();
}

TEST(RunDisturbed, an_sdo_write_to_the_controller_is_not_answered_and_changes_no_tick) {
    start();
    const std::string node_126 = "67E#";
    for (const char* request : {"2F00200001000000", "2300200101000000",
                                "23101001"
                                "73617665",
                                "4018100100000000"}) {
        LONGS_EQUAL(0, shell("cansend vcan0 " + node_126 + request));
    }
    CHECK(candump->has(node_126, 4));
    CHECK(estimates_go_on(20));
    end();
    for (const std::string& frame : candump->frames()) {
        CHECK_FALSE(frame.starts_with("5FE#"));
    }
    replays();
}
