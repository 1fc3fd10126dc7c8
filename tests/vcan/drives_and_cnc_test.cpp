// SPDX-License-Identifier: Apache-2.0
#include "drives_on_vcan.hpp"
#include "override_peers.hpp"
#include "sample_checks.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;
using cia402::NodeState;

/// On any kind of interface: run on vcan0, and on two SJA1000 controllers of one bus.
TEST_GROUP(DrivesAndCnc){void teardown() override{shell("ip link set " + controller_interface() + " up");
}
}
;

TEST(DrivesAndCnc, four_drives_are_started_and_sampled_without_a_lost_count) {
    for (const std::uint32_t period_us : {5000U * slower(), 1000U * slower()}) {
        const Child drives([] { run_drives(peer_interface(), 4); });
        BusOnVcan machine(bus_settings(4, period_us));
        CHECK(machine.run_until([&] { return machine.all_operational(4); }));
        machine.run_ms(50);
        machine.samples.clear();
        // How many are complete is this machine's affair: a virtual kernel on a busy host pauses for milliseconds.
        CHECK(machine.run_until([&] { return samples_with_everything(machine.samples) >= 200; }));
        const int all = static_cast<int>(machine.samples.size());
        const int complete = samples_with_everything(machine.samples);
        std::printf("\n    four drives, SYNC every %u us: %d of %d samples complete, %u SYNCs skipped", period_us,
                    complete, all, machine.sync.skipped());
        CHECK(complete > all / 4);
        check_counts(machine.samples);
        UNSIGNED_LONGS_EQUAL(0, machine.socket.health().overruns);
        UNSIGNED_LONGS_EQUAL(0, machine.socket.health().send_failures);
    }
}

TEST(DrivesAndCnc, drives_that_vanish_are_lost_and_come_back_by_themselves) {
    const Child drives([] { run_drives(peer_interface(), 2); });
    BusOnVcan machine(bus_settings(2, 2000 * slower()));
    CHECK(machine.run_until([&] { return machine.all_operational(2); }));
    drives.send_signal(SIGSTOP);
    CHECK(machine.run_until([&] { return machine.all_are(2, NodeState::lost); }));
    machine.samples.clear();
    CHECK(machine.run_until([&] { return machine.samples.size() >= 5; }));
    UNSIGNED_LONGS_EQUAL(0, machine.samples.back().present);
    drives.send_signal(SIGCONT);
    CHECK(machine.run_until([&] { return machine.all_operational(2); }));
    CHECK(machine.run_until([&] { return has_count(machine.samples.back()); }));
}

TEST(DrivesAndCnc, an_interface_that_goes_down_stops_the_samples_contents_and_not_the_program) {
    const Child drives([] { run_drives(peer_interface(), 2); });
    BusOnVcan machine(bus_settings(2, 2000 * slower()));
    CHECK(machine.run_until([&] { return machine.all_operational(2); }));
    LONGS_EQUAL(0, shell("ip link set " + controller_interface() + " down"));
    CHECK(machine.run_until([&] { return machine.all_are(2, NodeState::lost); }));
    CHECK(machine.socket.health().state == socketcan::LinkState::down);
    LONGS_EQUAL(0, shell("ip link set " + controller_interface() + " up"));
    CHECK(machine.run_until([&] { return machine.all_operational(2); }));
}

TEST(DrivesAndCnc, reaches_a_cnc_and_a_controller_that_stops_is_a_hold) {
    const Child controller(run_controller);
    Cnc cnc;
    CHECK(cnc.run_until_alive(true));
    DOUBLES_EQUAL(0.8, cnc.last().ratio, 1e-4);
    CHECK_FALSE(cnc.last().hold);
    controller.send_signal(SIGSTOP);
    CHECK(cnc.run_until_alive(false));
    CHECK(cnc.last().hold);
    controller.send_signal(SIGCONT);
    CHECK(cnc.run_until_alive(true));
}
