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

WayEvent WayReceiver::on_frame(const hal::CanFrame& frame) {
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
    put_together(found);
    return WayEvent::nothing;
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
    forget_parts();
    state_ = frame.payload.back() != layout_version ? WayState::other_layout
             : tool_checksum != tool_checksum_      ? WayState::other_tool
                                                    : WayState::takes;
    return WayEvent::begun;
}

void WayReceiver::put_together(const WayFrame& frame) {
    const auto ahead = static_cast<std::uint8_t>(frame.number - static_cast<std::uint8_t>(expected_));
    if (state_ != WayState::takes || frame.session != session_ || ahead >= most_in_work) {
        return;
    }
    InWork& record = in_work(expected_ + std::size_t{ahead});
    const bool is_block = frame.kind >= kind_of(WayFrameKind::block);
    const std::size_t part = frame.kind - kind_of(is_block ? WayFrameKind::block : WayFrameKind::stretch);
    const unsigned kept = is_block == record.is_block ? record.parts : 0U;
    record.is_block = is_block;
    record.parts = static_cast<std::uint8_t>(kept | (1U << part));
    std::copy(frame.payload.begin(), frame.payload.end(),
              record.bytes.begin() + static_cast<std::ptrdiff_t>(part * payload_bytes));
}

NextRecord WayReceiver::take_record() {
    InWork& record = in_work(expected_);
    if (state_ != WayState::takes || record.parts != (record.is_block ? whole_block : whole_stretch)) {
        return NextRecord::none;
    }
    record.parts = 0;
    return record.is_block ? take_block(record) : take_stretch(record);
}

NextRecord WayReceiver::take_stretch(const InWork& record) {
    stretch_ = stretch_of(record.bytes);
    if (!is_sound(stretch_)) {
        refuse();
        return NextRecord::none;
    }
    ++expected_;
    digest_ = digest(digest_, record.bytes);
    return NextRecord::stretch;
}

NextRecord WayReceiver::take_block(const InWork& record) {
    BlockBytes bytes{};
    std::copy_n(record.bytes.begin(), bytes.size(), bytes.begin());
    block_ = block_of(bytes);
    if (!is_sound(block_)) {
        refuse();
        return NextRecord::none;
    }
    ++expected_;
    digest_ = digest(digest_, bytes);
    return NextRecord::block;
}

WayAnswer WayReceiver::answer() const {
    return {.ask = ask_, .state = state_, .session = session_, .expected = expected_, .room = 0, .digest = digest_};
}

void WayReceiver::forget() {
    state_ = WayState::waits;
    session_ = 0;
    expected_ = 0;
    forget_parts();
}

void WayReceiver::set_tool(std::uint32_t tool_checksum) {
    tool_checksum_ = tool_checksum;
    forget();
}

}  // namespace millforce::way_window
