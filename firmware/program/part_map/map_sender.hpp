// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "firmware/parameters.hpp"
#include "part_map/part_map.hpp"
#include "part_map/way_sender.hpp"
#include "program_status/tool_frame.hpp"

namespace millforce::host {

/// Hands part maps to a controller whose tool is chosen by its number: that of the tool in the spindle, by the CNC's
/// tool frame. Without a map for it nothing is sent, and the controller goes on without one. With each tool that comes
/// back its map begins anew. Frames and times in and out as with WaySender. Not thread-safe.
class MapSender {
  public:
    /// `program_status_id`: of the bus. There is a tool frame, or there is one map alone.
    MapSender(const WaySenderSettings& settings, std::uint32_t program_status_id)
        : settings_(settings), tool_(program_status::tool_frame_id(program_status_id)) {}

    /// The map of one tool, whatever the CNC says of its number.
    void add(const PartMap& map, const firmware::Parameters<float>& parameters);
    /// False where there is a map for this number already.
    [[nodiscard]] bool add(std::uint32_t number, const PartMap& map, const firmware::Parameters<float>& parameters);

    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    void poll(std::uint64_t now_us);
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);

    /// Of the tool in the spindle; 0: not known. Without numbers 0.
    [[nodiscard]] std::uint32_t tool() const { return number_; }
    /// That hands over its map; null: there is none for this tool.
    [[nodiscard]] const WaySender* sender() const { return active_; }
    [[nodiscard]] std::uint32_t sessions() const;

  private:
    struct Numbered {
        std::uint32_t number;  // 0: any
        WaySender sender;
    };

    void follow_tool(std::uint64_t now_us);

    WaySenderSettings settings_;
    program_status::ToolReceiver tool_;
    std::deque<Numbered> senders_{};
    WaySender* active_ = nullptr;
    std::uint32_t number_ = 0;
};

}  // namespace millforce::host
