// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hal/can_frame.hpp"
#include "way_window/way_frames.hpp"

namespace millforce::way_window {

/// What a frame led to.
enum class WayEvent : std::uint8_t {
    nothing,
    begun,    ///< a session: what came before is to be forgotten
    stretch,  ///< stretch() is the next record
    block,    ///< block() is
    asked,    ///< answer() is to be sent
};

/// The controller's side of the window: puts records together, and takes each once and in its order.
///
/// Only frames of the next record are used. Where one was lost or comes too early or too late, the sender, which learns
/// by answer() what is expected, goes back to it. What is late by 256 records could be taken for another; the digest of
/// what was taken shows the sender that. A session with another tool, or in which a record is out of its range, is
/// refused as a whole.
///
/// No heap. Not thread-safe. RAM: sizeof, some 50 bytes.
class WayReceiver {
  public:
    WayReceiver(std::uint8_t node_id, std::uint32_t tool_checksum)
        : id_(way_frame_id(node_id)), tool_checksum_(tool_checksum) {}

    /// `room`: for so many records; what comes in excess is not taken.
    [[nodiscard]] WayEvent on_frame(const hal::CanFrame& frame, std::size_t room);

    [[nodiscard]] const StretchRecord& stretch() const { return stretch_; }
    [[nodiscard]] const BlockRecord& block() const { return block_; }
    /// To the newest ask; the rest of it is for the caller to fill in.
    [[nodiscard]] WayAnswer answer() const;
    /// Of the session; another number is another run of a program.
    [[nodiscard]] std::uint8_t run() const { return run_; }
    [[nodiscard]] bool has_session() const { return state_ == WayState::takes; }

    /// The record does not go on from the last one.
    void refuse() { state_ = WayState::unsound_record; }
    /// The session has ended: the sender is to begin another.
    void forget();
    /// Another tool is in the spindle.
    void set_tool(std::uint32_t tool_checksum);

  private:
    [[nodiscard]] WayEvent begin(const WayFrame& frame);
    [[nodiscard]] WayEvent put_together(const WayFrame& frame, std::size_t room);
    [[nodiscard]] WayEvent take_stretch();
    [[nodiscard]] WayEvent take_block();

    std::uint32_t id_;
    std::uint32_t tool_checksum_;
    WayState state_ = WayState::waits;
    std::uint8_t session_ = 0;
    std::uint8_t run_ = 0;
    std::uint8_t ask_ = 0;
    std::uint16_t expected_ = 0;
    std::uint16_t digest_ = 0;
    bool is_block_ = false;  // the record in work
    unsigned parts_ = 0;     // of it that have come, a bit each
    StretchBytes bytes_{};
    StretchRecord stretch_{};
    BlockRecord block_{};
};

}  // namespace millforce::way_window
