// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "controller_on_loopback.hpp"

#include "firmware/tool_checksum.hpp"
#include "firmware_can/way_over_bus.hpp"
#include "part_map/way_sender.hpp"

/// Beside a controller that has its map over the bus: the sender of the map.

namespace millforce::test {

inline host::WaySenderSettings way_sender_settings() {
    return {.node_id = override_frame::default_node_id,
            .position_id = program_status::position_frame_id(program_status::default_id)};
}

inline firmware::WayOverBus<float> way_over_bus(const firmware::Parameters<float>& parameters) {
    return {parameters, firmware::tool_checksum(parameters.tool), override_frame::default_node_id};
}

class WaySenderOnLoopback {
  public:
    WaySenderOnLoopback(ControllerOnLoopback& bench, const host::PartMap& map,
                        const firmware::Parameters<float>& parameters)
        : sender(way_sender_settings(), map, parameters) {
        const int place = bench.wire.attach([this](const hal::CanFrame& frame, std::uint64_t time_us) {
            if (lives) {
                sender.on_frame(frame, time_us);
            }
        });
        bench.beside = [this, place, &bench](std::uint64_t now_us) {
            if (lives) {
                turn(bench.wire, place, now_us);
            }
        };
    }
    WaySenderOnLoopback(const WaySenderOnLoopback&) = delete;
    WaySenderOnLoopback& operator=(const WaySenderOnLoopback&) = delete;

    host::WaySender sender;
    bool lives = true;
    std::uint64_t frames = 0;

  private:
    void turn(sim::LoopbackBus& wire, int place, std::uint64_t now_us) {
        sender.poll(now_us);
        hal::CanFrame frame;
        while (sender.take_frame(frame)) {
            wire.send(place, frame, now_us);
            ++frames;
        }
    }
};

}  // namespace millforce::test
