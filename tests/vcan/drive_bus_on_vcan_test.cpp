// SPDX-License-Identifier: Apache-2.0
#include "drives_on_vcan.hpp"
#include "sample_checks.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::vcan;
using cia402::Reject;

namespace {

/// `(seconds) vcan0 id#data`
std::string log_line(double time_s, const std::string& frame) {
    std::array<char, 80> line{};
    std::snprintf(line.data(), line.size(), "(%.6f) vcan0 %s", time_s, frame.c_str());
    return line.data();
}

/// Position, current and statusword of a drive at a SYNC, as candump writes it.
std::string pdo(unsigned node, int sync, int per_mille) {
    const unsigned position = static_cast<unsigned>(sync * counts_per_sync);
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%03X#%02X%02X%02X%02X%02X%02X3702", 0x180 + node, position & 0xFFU,
                  (position >> 8U) & 0xFFU, (position >> 16U) & 0xFFU, position >> 24U,
                  static_cast<unsigned>(per_mille) & 0xFFU, (static_cast<unsigned>(per_mille) >> 8U) & 0xFFU);
    return text.data();
}

/// 100 SYNCs, 10 ms apart, with two drives and one fault at every fourth.
void write_recording(const std::string& file) {
    std::ofstream log(file);
    for (int k = 0; k < 100; ++k) {
        const double t = 0.01 * k;
        const int fault = k % 20;
        const auto write = [&](double after_s, const std::string& frame) {
            log << log_line(t + after_s, frame) << "\n";
        };
        write(0.0, "080#");
        if (fault == 2) {
            write(0.0, "080#");  // SYNC twice
        }
        if (fault != 6) {  // a PDO lost
            write(0.002, pdo(1, k, 500));
        }
        if (fault == 10) {
            write(0.002, pdo(1, k, 500));  // twice
        }
        if (fault == 14) {
            write(0.002, "182#112233");  // too short
        } else {
            write(0.002, pdo(2, k, fault == 18 ? 6000 : 500));  // 6 A in mA, where per mille are meant
        }
        write(0.003, "701#05");
        write(0.003, "123#00");
    }
}

cia402::BusSettings listener_settings(std::uint32_t period_us) {
    cia402::BusSettings settings = bus_settings(2, period_us);
    settings.is_master = false;
    for (std::size_t role = 0; role < 2; ++role) {
        settings.drives[role].rated_current_A = 12.0F;
        settings.drives[role].heartbeat_timeout_us = 0;
    }
    return settings;
}

}  // namespace

TEST_GROUP(DriveBusOnVcan){void teardown() override{shell("tc qdisc del dev vcan0 root");
shell("ip link set vcan0 up");
}
}
;

TEST(DriveBusOnVcan, a_bus_too_slow_for_its_frames_is_told_and_recovers) {
    const Child drives([] { run_drives("vcan0", 2); });
    BusOnVcan machine(bus_settings(2, 2000));
    CHECK(machine.run_until([&] { return machine.all_operational(2); }));
    LONGS_EQUAL(0, shell("tc qdisc add dev vcan0 root tbf rate 8kbit burst 100 limit 300"));
    CHECK(machine.run_until(
        [&] { return machine.socket.health().send_failures > 50 && machine.bus.health().samples_incomplete > 50; }));
    LONGS_EQUAL(0, shell("tc qdisc del dev vcan0 root"));
    CHECK(machine.run_until([&] { return machine.all_operational(2) && !machine.socket.health().send_queue_full; }));
    CHECK(machine.run_until([&] { return has_count(machine.samples.back()); }));
}

TEST(DriveBusOnVcan, cangen_with_every_id_and_length_is_counted_and_leaves_a_bus_that_works) {
    BusOnVcan machine(bus_settings(2, 2000));
    Listener everything(on("vcan0"));
    for (const char* options : {"-I i -L i -D i -n 18432", "-e -n 500", "-R -n 200", "-m -n 1000", "-f -n 200"}) {
        Child cangen(std::string("cangen vcan0 -g 0.05 -p 1 ") + options);
        while (!cangen.has_ended()) {
            machine.run_ms(10);
            everything.run_ms(10);
        }
    }
    everything.run_ms(20);
    const auto& health = everything.socket.health();
    std::printf("\n    cangen: %u frames, %u of CAN FD, %u overruns\n", health.received, health.fd_frames,
                health.overruns);
    CHECK(health.received + health.fd_frames + health.overruns >= 18432 + 500 + 200 + 1000 + 200);
    CHECK(health.fd_frames > 300);
    CHECK(machine.bus.rejects().total() > 0);
    UNSIGNED_LONGS_EQUAL(0, machine.bus.rejects()[Reject::foreign_id]);  // the kernel's filters kept them out
    const Child drives([] { run_drives("vcan0", 2); });
    CHECK(machine.run_until([&] { return machine.all_operational(2); }));
}

TEST(DriveBusOnVcan, a_recording_by_canplayer_with_every_fault_of_a_frame_is_read_as_far_as_it_is_sound) {
    const std::string file = temporary_file("recording.log");
    write_recording(file);
    BusOnVcan machine(listener_settings(10'000), false);
    machine.run_ms(20);
    const Child canplayer("canplayer -I " + file);
    machine.run_ms(1500);
    unlink(file.c_str());
    // Each fault is there five times. Where this machine pauses the player, frames bunch, and some count as late.
    const cia402::RejectCounters& rejects = machine.bus.rejects();
    CHECK(rejects[Reject::sync_early] >= 3);
    CHECK(rejects[Reject::pdo_length] >= 1 && rejects[Reject::pdo_length] <= 5);
    CHECK(rejects[Reject::current_range] >= 1 && rejects[Reject::current_range] <= 5);
    CHECK(rejects[Reject::pdo_repeated] + rejects[Reject::pdo_late] >= 3);
    UNSIGNED_LONGS_EQUAL(105, machine.samples.size() + rejects[Reject::sync_early]);
    const auto with_count = std::count_if(machine.samples.begin(), machine.samples.end(), has_count);
    CHECK(with_count >= 50 && with_count <= 95);
    check_counts(machine.samples);
    CHECK(machine.bus.health().sync_lost);
}
