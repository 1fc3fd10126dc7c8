// SPDX-License-Identifier: Apache-2.0
#include <valgrind/callgrind.h>

#include <cstdint>
#include <cstdio>

#include "can_frames.hpp"
#include "cia402/drive_bus.hpp"
#include "override_frame/override_receiver.hpp"

/// Feeds received frames to the drivers and lets callgrind write down the instructions of each, one dump per frame with
/// the name of its kind: `pdo` into the drive bus, `override` into the CNC's receiver, `foreign` a frame of strangers
/// that the kernel did not keep out. To be run by count_instructions.
/// Exit code 1: frames were not used, so the count would be that of something else.

namespace {

namespace hal = millforce::hal;
using millforce::frame_of_length;
using millforce::cia402::BusSettings;
using millforce::cia402::DriveBus;
using millforce::cia402::MappedObject;
using millforce::cia402::Reject;
using millforce::override_frame::OverrideReceiver;

constexpr std::uint32_t drives = 4;
constexpr std::uint64_t syncs = 250;

/// A listener to four drives with position, current and statusword in TPDO 1.
BusSettings listener() {
    namespace object = millforce::cia402::object;
    BusSettings settings;
    for (std::uint32_t role = 0; role < drives; ++role) {
        auto& drive = settings.drives[role];
        drive.node_id = static_cast<std::uint8_t>(role + 1);
        drive.rated_current_A = 12.0F;
        drive.velocity_source = millforce::cia402::VelocitySource::position_difference;
        drive.position_mm_per_unit = 0.001F;
        drive.pdos[0].id = 0x181 + role;
        drive.pdos[0].object_count = 3;
        drive.pdos[0].objects = {MappedObject{object::position_actual, 0, 32},
                                 MappedObject{object::current_actual, 0, 16}, MappedObject{object::statusword, 0, 16}};
    }
    return settings;
}

struct Receivers {
    DriveBus bus{listener()};
    OverrideReceiver cnc{millforce::override_frame::OverrideReceiverSettings{}};
};

}  // namespace

/// What callgrind counts: its --toggle-collect names this function. With a PDO goes its share of the sample.
extern "C" [[gnu::noipa]] bool counted_step(Receivers& receivers, bool by_bus, const hal::CanFrame& frame,
                                            std::uint64_t time_us, hal::DriveSample& sample) {
    if (by_bus) {
        receivers.bus.on_frame(frame, time_us);
        return receivers.bus.take_sample(sample);
    }
    receivers.cnc.on_frame(frame, time_us);
    return receivers.cnc.current(time_us).is_alive;
}

int main() {
    Receivers receivers;
    DriveBus& bus = receivers.bus;
    hal::DriveSample sample;
    std::uint64_t time_us = 0;
    for (std::uint32_t role = 0; role < drives; ++role) {
        bus.on_frame(frame_of_length(0x701 + role, 1, 0x05), time_us);
    }
    std::uint64_t complete = 0;
    std::uint64_t alive = 0;
    for (std::uint64_t k = 0; k < syncs; ++k) {
        time_us += 1000;
        bus.poll(time_us);
        bus.on_frame(frame_of_length(0x080, 0), time_us);
        for (std::uint32_t role = 0; role < drives; ++role) {
            const hal::CanFrame pdo = frame_of_length(0x181 + role, 8, static_cast<std::uint8_t>(k));
            CALLGRIND_ZERO_STATS;
            complete += counted_step(receivers, true, pdo, time_us + 100 * (role + 1), sample) ? 1U : 0U;
            CALLGRIND_DUMP_STATS_AT("pdo");
        }
        CALLGRIND_ZERO_STATS;
        counted_step(receivers, true, frame_of_length(0x3A5, 8), time_us + 600, sample);
        CALLGRIND_DUMP_STATS_AT("foreign");
        const hal::CanFrame out = millforce::override_frame::encode({0.8F, false, 3, 0, static_cast<std::uint32_t>(k)},
                                                                    millforce::override_frame::default_id);
        CALLGRIND_ZERO_STATS;
        alive += counted_step(receivers, false, out, time_us, sample) ? 1U : 0U;
        CALLGRIND_DUMP_STATS_AT("override");
    }
    if (complete != syncs || sample.present == 0 || alive + 2 != syncs || bus.rejects().total() != 0 ||
        bus.rejects()[Reject::foreign_id] != syncs) {
        std::fprintf(stderr, "frame_instructions: %llu of %llu samples, %llu overrides alive\n",
                     static_cast<unsigned long long>(complete), static_cast<unsigned long long>(syncs),
                     static_cast<unsigned long long>(alive));
        return 1;
    }
    return 0;
}
