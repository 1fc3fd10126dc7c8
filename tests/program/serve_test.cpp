// SPDX-License-Identifier: Apache-2.0
#include "bridge.hpp"
#include "inputs.hpp"
#include "pauses.hpp"
#include "service_manager.hpp"

#include <sys/resource.h>

#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "control/cut_state.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::test;

/// `millforce serve` with a CNC's bridge at its socket: signals that go wrong, and what may happen to a process.

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();
/// Longer than the daemon's loop may take.
constexpr auto pause_length = std::chrono::milliseconds(800);

}  // namespace

TEST_GROUP(Serve) {
    Inputs inputs;
    std::unique_ptr<Program> serve;
    std::unique_ptr<Bridge> cnc;

    [[nodiscard]] std::vector<std::string> words() const {
        return {"serve",  inputs.name("a.sock"),   "--machine", inputs.name("machine.toml"),
                "--tool", inputs.name("tool.toml")};
    }
    void start(const std::string& error_file = {}) {
        serve = std::make_unique<Program>(words(), error_file);
        cnc = std::make_unique<Bridge>(inputs.name("a.sock"));
        cnc->sample.spindle_current_A = 1.4F;
        cnc->sample.axis_current_A[0] = 2.3F;
        cnc->sample.axis_velocity_mm_s[0] = 20.0F;
    }
    /// Two more messages of the daemon.
    void connect_again() {
        cnc.reset();
        cnc = std::make_unique<Bridge>(inputs.name("a.sock"));
    }
    local_link::OverrideMessage ask_often(int count) {
        local_link::OverrideMessage answer;
        for (int k = 0; k < count; ++k) {
            answer = cnc->ask();
        }
        return answer;
    }
    /// The fault by which the feed is held, at the latest after so many samples; until then the override does not rise.
    std::string fault_within(int samples) {
        float highest = ask_often(1).ratio;
        for (int k = 0; k < samples; ++k) {
            const local_link::OverrideMessage answer = cnc->ask();
            if (answer.hold) {
                return control::name(static_cast<control::Fault>(answer.fault));
            }
            CHECK(answer.ratio <= highest);
            highest = answer.ratio;
        }
        return "none";
    }
    void end() {
        cnc.reset();
        serve->interrupt(SIGTERM);
        serve->wait();
        LONGS_EQUAL(0, serve->exit_code());
    }
    template <typename Pause>
    void holds_after() {
        start();
        CHECK_FALSE(ask_often(100).hold);
        {
            const Pause stopped(serve->process());
            for (int k = 0; k < 20; ++k) {
                cnc->send_next();
            }
            std::this_thread::sleep_for(pause_length);
        }
        const local_link::OverrideMessage stale = cnc->take();
        CHECK(stale.hold);
        BYTES_EQUAL(0, stale.fault);
        for (int k = 1; k < 20; ++k) {
            cnc->take();
        }
        bool is_held = true;
        for (int k = 0; k < 10'000 && is_held; ++k) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            is_held = cnc->ask().hold;
        }
        CHECK_FALSE(is_held);
        CHECK(serve->says("was stopped for "));
        end();
    }
};

TEST(Serve, holds_the_feed_where_a_current_an_angle_or_everything_is_missing_or_no_number) {
    struct Case {
        std::uint8_t present;
        float current_A;
        float velocity_mm_s;
    };
    for (const Case& missing : {Case{0x1E, 0.0F, 20.0F}, Case{0x1D, 1.4F, 20.0F}, Case{0x1F, nan_value, 20.0F},
                                Case{0x00, 0.0F, 0.0F}, Case{0x1F, nan_value, nan_value}}) {
        start();
        CHECK_FALSE(ask_often(300).hold);
        cnc->sample.present = missing.present;
        cnc->sample.spindle_current_A = missing.current_A;
        cnc->sample.axis_velocity_mm_s[0] = missing.velocity_mm_s;
        STRCMP_EQUAL("stale_input", fault_within(60).c_str());  // stale_s is 50 ms
        end();
    }
}

TEST(Serve, does_not_raise_the_feed_where_the_encoder_stops_in_air_and_holds_it_at_the_first_cut) {
    start();
    CHECK_FALSE(ask_often(300).hold);
    cnc->counts_per_ms = 0;
    STRCMP_EQUAL("none", fault_within(1000).c_str());  // a spindle that is off, perhaps
    cnc->sample.spindle_current_A = 12.0F;
    STRCMP_EQUAL("spindle_stopped", fault_within(60).c_str());
    end();
}

TEST(Serve, says_hold_in_the_state_hold) {
    start();
    ask_often(10);
    cnc->sample.feed_hold = true;
    CHECK(ask_often(1).hold);
    BYTES_EQUAL(static_cast<int>(control::CutState::hold), ask_often(1).state);
    cnc->sample.feed_hold = false;
    CHECK_FALSE(ask_often(1).hold);
    end();
}

TEST(Serve, samples_that_come_late_are_no_spindle_that_stopped) {
    start();
    for (int k = 0; k < 300; ++k) {
        BYTES_EQUAL(0, cnc->ask(k % 3 == 0 ? 30'000 : 1000).fault);
    }
    BYTES_EQUAL(static_cast<int>(control::Fault::stale_input), cnc->ask(60'000).fault);
    end();
}

TEST(Serve, after_sigstop_answers_with_hold_until_newer_samples_come_and_says_so) {
    holds_after<Stopped>();
}

TEST(Serve, after_a_debuggers_pause_answers_with_hold_until_newer_samples_come_and_says_so) {
    holds_after<Debugged>();
}

TEST(Serve, ends_with_sighup_its_connection_closed_and_its_socket_gone) {
    start();
    ask_often(10);
    serve->interrupt(SIGHUP);
    local_link::OverrideBytes none{};
    UNSIGNED_LONGS_EQUAL(0, cnc->receive(none));
    serve->wait();
    LONGS_EQUAL(0, serve->exit_code());
    CHECK_FALSE(std::filesystem::exists(inputs.path("a.sock")));
}

TEST(Serve, answers_on_where_the_reader_of_its_messages_is_gone) {
    start();
    serve->close_reader_of_error();
    ask_often(1);
    connect_again();
    UNSIGNED_LONGS_EQUAL(10, ask_often(10).heartbeat);
    end();
}

TEST(Serve, answers_on_where_its_messages_are_on_a_full_disk_or_at_a_files_size_limit) {
    start("/dev/full");
    UNSIGNED_LONGS_EQUAL(10, ask_often(10).heartbeat);
    end();
    start(inputs.name("messages"));
    const rlimit nothing{1, 1};
    LONGS_EQUAL(0, ::prlimit(serve->process(), RLIMIT_FSIZE, &nothing, nullptr));
    connect_again();
    UNSIGNED_LONGS_EQUAL(10, ask_often(10).heartbeat);
    end();
}

TEST(Serve, answers_on_where_nobody_takes_its_messages) {
    start();
    serve->narrow_pipe_of_error();
    for (int k = 0; k < 150; ++k) {  // some 70 bytes each
        connect_again();
        UNSIGNED_LONGS_EQUAL(1, ask_often(1).heartbeat);
    }
    UNSIGNED_LONGS_EQUAL(11, ask_often(10).heartbeat);
    end();
}

#ifndef MILLFORCE_SANITIZED
TEST(Serve, answers_on_where_there_is_no_more_memory) {
    start();
    ask_often(1);
    const rlimit nothing{1, 1};
    LONGS_EQUAL(0, ::prlimit(serve->process(), RLIMIT_AS, &nothing, nullptr));
    UNSIGNED_LONGS_EQUAL(2001, ask_often(2000).heartbeat);
    end();
}
#endif

TEST(Serve, a_second_one_at_the_same_socket_is_refused_and_the_first_ones_connection_stays) {
    start();
    UNSIGNED_LONGS_EQUAL(10, ask_often(10).heartbeat);
    STRCMP_EQUAL("", not_refused(run_millforce(words()), {"a.sock: another program serves this socket"}).c_str());
    Bridge other(inputs.name("a.sock"));
    local_link::OverrideBytes none{};
    UNSIGNED_LONGS_EQUAL(0, other.receive(none));
    UNSIGNED_LONGS_EQUAL(20, ask_often(10).heartbeat);
    {
        const Stopped stopped(serve->process());
        STRCMP_EQUAL("", not_refused(run_millforce(words()), {"a.sock: another program serves this socket"}).c_str());
    }
    end();
}

TEST(Serve, a_socket_that_a_killed_one_left_is_taken_over) {
    start();
    serve->interrupt(SIGKILL);
    serve->wait();
    CHECK(std::filesystem::exists(inputs.path("a.sock")));
    start();
    UNSIGNED_LONGS_EQUAL(1, ask_often(1).heartbeat);
    end();
}

TEST(Serve, tells_a_service_manager_that_it_is_ready_alive_and_stopping_and_nothing_while_its_loop_stands) {
    const ServiceManager manager(inputs.name("notify"), 200'000);
    start();
    STRCMP_EQUAL("READY=1", manager.receive().c_str());
    CHECK(manager.hears("STATUS=connected"));
    CHECK(manager.hears("WATCHDOG=1"));
    CHECK(manager.hears("WATCHDOG=1"));
    {
        const Debugged loop_stands(serve->process());
        CHECK(manager.hears_nothing(300));
    }
    CHECK(manager.hears("WATCHDOG=1"));
    end();
    CHECK(manager.hears("STOPPING=1"));
}
