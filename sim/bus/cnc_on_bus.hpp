// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/can_frame.hpp"
#include "hal/drive_sample.hpp"
#include "override_frame/override_receiver.hpp"
#include "program_status/position_frame.hpp"
#include "program_status/program_status_frame.hpp"
#include "program_status/speed_frame.hpp"
#include "program_status/tool_frame.hpp"

namespace millforce::sim {

struct CncOnBusSettings {
    override_frame::OverrideReceiverSettings feed_override{};
    std::uint32_t program_status_id = program_status::default_id;  ///< 0: it reports nothing
    std::uint32_t program_status_period_us = 10'000;
    std::uint32_t number_period_us = 100'000;  ///< of the tool and of the spindle's speed
    bool reports_position = false;             ///< line and distance to go, beside each program status
};

/// A CNC's side of the bus: it takes the feed override and reports F, rapid and hold, at once when one of them changes.
class CncOnBus {
  public:
    explicit CncOnBus(const CncOnBusSettings& settings) : settings_(settings), receiver_(settings.feed_override) {}

    void set(const hal::ProgramStatus& program, std::uint64_t time_us);
    /// The tool in the spindle, in a frame of its own from now on.
    void set_tool(std::uint32_t number, std::uint64_t time_us);
    /// The operator's acknowledgement of a latched fault, in the status frames from now on.
    void press_reset(bool pressed) { newest_.reset_fault = pressed; }
    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us) { receiver_.on_frame(frame, time_us); }
    void poll(std::uint64_t time_us);
    [[nodiscard]] std::vector<hal::CanFrame> take_frames();
    [[nodiscard]] override_frame::ReceivedOverride feed_override(std::uint64_t now_us) const {
        return receiver_.current(now_us);
    }

  private:
    void send(std::uint64_t time_us);
    void send_position();
    void send_tool(std::uint64_t time_us);
    void send_speed(std::uint64_t time_us);

    CncOnBusSettings settings_;
    override_frame::OverrideReceiver receiver_;
    program_status::ProgramStatusFrame newest_{};
    bool has_status_ = false;
    std::uint8_t positions_sent_ = 0;
    std::uint64_t next_us_ = 0;
    std::optional<std::uint32_t> tool_{};
    std::uint64_t next_tool_us_ = 0;
    std::uint64_t next_speed_us_ = 0;
    std::vector<hal::CanFrame> outgoing_;
};

}  // namespace millforce::sim
