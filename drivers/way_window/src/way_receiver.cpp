// SPDX-License-Identifier: Apache-2.0
#include "way_window/way_receiver.hpp"

#include <algorithm>

namespace millforce::way_window {

namespace {

constexpr auto kind_of(WayFrameKind kind) {
    return static_cast<std::uint8_t>(kind);
}
constexpr unsigned whole_stretch = (1U << stretch_frames) - 1U;
constexpr unsigned whole_block = (1U << block_frames) - 1U;

}  // namespace

WayEvent WayReceiver::on_frame(const hal::CanFrame& frame, std::size_t room) {
    WayFrame found;
    if (decode(frame, id_, found) != FrameError::none) {
        return WayEvent::nothing;
    }
    if (found.kind == kind_of(WayFrameKind::begin)) {
        return begin(found);
    }
    if (found.kind == kind_of(WayFrameKind::ask)) {
        ask_ = found.number;
        return WayEvent::asked;
    }
    return put_together(found, room);
}

/// The same session once more is the same frame once more.
WayEvent WayReceiver::begin(const WayFrame& frame) {
    if (state_ == WayState::takes && frame.session == session_) {
        return WayEvent::nothing;
    }
    std::uint32_t tool_checksum = 0;
    for (std::size_t k = 0; k < sizeof tool_checksum; ++k) {
        tool_checksum |= std::uint32_t{frame.payload[k]} << (8U * k);
    }
    session_ = frame.session;
    run_ = frame.number;
    expected_ = 0;
    digest_ = 0;
    parts_ = 0;
    state_ = frame.payload.back() != layout_version ? WayState::other_layout
             : tool_checksum != tool_checksum_      ? WayState::other_tool
                                                    : WayState::takes;
    return WayEvent::begun;
}

/// Its frames may come in any order; those that have come need not come again.
WayEvent WayReceiver::put_together(const WayFrame& frame, std::size_t room) {
    const bool is_of_next = state_ == WayState::takes && frame.session == session_ &&
                            frame.number == static_cast<std::uint8_t>(expected_) && room > 0;
    if (!is_of_next) {
        return WayEvent::nothing;
    }
    const bool is_of_block = frame.kind >= kind_of(WayFrameKind::block);
    const std::size_t part = frame.kind - kind_of(is_of_block ? WayFrameKind::block : WayFrameKind::stretch);
    parts_ = is_of_block == is_block_ ? parts_ | (1U << part) : 1U << part;
    is_block_ = is_of_block;
    std::copy(frame.payload.begin(), frame.payload.end(),
              bytes_.begin() + static_cast<std::ptrdiff_t>(part * payload_bytes));
    if (parts_ != (is_of_block ? whole_block : whole_stretch)) {
        return WayEvent::nothing;
    }
    parts_ = 0;
    return is_of_block ? take_block() : take_stretch();
}

WayEvent WayReceiver::take_stretch() {
    stretch_ = stretch_of(bytes_);
    if (!is_sound(stretch_)) {
        refuse();
        return WayEvent::nothing;
    }
    ++expected_;
    digest_ = digest(digest_, bytes_);
    return WayEvent::stretch;
}

WayEvent WayReceiver::take_block() {
    BlockBytes bytes{};
    std::copy_n(bytes_.begin(), bytes.size(), bytes.begin());
    block_ = block_of(bytes);
    if (!is_sound(block_)) {
        refuse();
        return WayEvent::nothing;
    }
    ++expected_;
    digest_ = digest(digest_, bytes);
    return WayEvent::block;
}

WayAnswer WayReceiver::answer() const {
    return {.ask = ask_, .state = state_, .session = session_, .expected = expected_, .room = 0, .digest = digest_};
}

void WayReceiver::forget() {
    state_ = WayState::waits;
    session_ = 0;
    expected_ = 0;
    parts_ = 0;
}

void WayReceiver::set_tool(std::uint32_t tool_checksum) {
    tool_checksum_ = tool_checksum;
    forget();
}

}  // namespace millforce::way_window
