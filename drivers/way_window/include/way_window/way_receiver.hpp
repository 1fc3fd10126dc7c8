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
    begun,  ///< a session: what came before is to be forgotten
    asked,  ///< answer() is to be sent
};

/// The next record of a session.
enum class NextRecord : std::uint8_t {
    none,     ///< not all of it has come
    stretch,  ///< stretch() is it
    block,    ///< block() is it
};

/// The controller's side of the window: puts records together, and takes each once and in its order.
///
///     switch (receiver.on_frame(frame)) { ... }
///     while (room > 0 && receiver.take_record() != NextRecord::none) { ... }
///
/// Frames of the next eight records may come in any order. Where one was lost, the sender, which learns by answer()
/// which record is expected, goes back to that; what has come need not come again. What is late by 248 records could be
/// taken for another; the digest of what was taken shows the sender that. A session with another tool, or in which a
/// record is out of its range, is refused as a whole.
///
/// No heap. Not thread-safe. RAM: sizeof, some 240 bytes.
class WayReceiver {
  public:
    WayReceiver(std::uint8_t node_id, std::uint32_t tool_checksum)
        : id_(way_frame_id(node_id)), tool_checksum_(tool_checksum) {}

    [[nodiscard]] WayEvent on_frame(const hal::CanFrame& frame);
    /// Only where there is room for it.
    [[nodiscard]] NextRecord take_record();

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
    /// A record of which frames have come.
    struct InWork {
        bool is_block = false;
        std::uint8_t parts = 0;  // that have come, a bit each
        StretchBytes bytes{};
    };
    static constexpr std::size_t most_in_work = 8;

    [[nodiscard]] WayEvent begin(const WayFrame& frame);
    void put_together(const WayFrame& frame);
    [[nodiscard]] InWork& in_work(std::size_t number) { return in_work_[number % most_in_work]; }
    void forget_parts() { in_work_ = {}; }
    [[nodiscard]] NextRecord take_stretch(const InWork& record);
    [[nodiscard]] NextRecord take_block(const InWork& record);

    std::uint32_t id_;
    std::uint32_t tool_checksum_;
    WayState state_ = WayState::waits;
    std::uint8_t session_ = 0;
    std::uint8_t run_ = 0;
    std::uint8_t ask_ = 0;
    std::uint16_t expected_ = 0;
    std::uint16_t digest_ = 0;
    std::array<InWork, most_in_work> in_work_{};  // by their numbers, from the expected one on
    StretchRecord stretch_{};
    BlockRecord block_{};
};

}  // namespace millforce::way_window
