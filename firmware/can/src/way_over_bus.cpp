// SPDX-License-Identifier: Apache-2.0
#include "firmware_can/way_over_bus.hpp"

#include <algorithm>
#include <memory>

namespace millforce::firmware {

namespace {

/// Of a record's whole numbers; by parts, so that a long path keeps its digits.
template <typename Scalar>
Scalar scaled(std::uint32_t value, std::int32_t per_unit) {
    const auto divisor = static_cast<std::uint32_t>(per_unit);
    return Scalar(static_cast<std::int32_t>(value / divisor)) +
           Scalar(static_cast<std::int32_t>(value % divisor)) / Scalar(per_unit);
}

template <typename Scalar>
control::Stretch<Scalar> stretch_of(const way_window::StretchRecord& record) {
    constexpr std::int32_t e2 = 100;
    constexpr std::int32_t e3 = 1000;
    constexpr std::int32_t e4 = 10'000;
    control::Stretch<Scalar> stretch;
    stretch.begin_mm = scaled<Scalar>(record.begin_um, e3);
    stretch.feed_mm_s = scaled<Scalar>(record.feed_um_s, e3);
    stretch.tangential_N = scaled<Scalar>(record.tangential_mN, e3);
    stretch.tooth_per_tangential = scaled<Scalar>(record.tooth_per_tangential_e4, e4);
    stretch.feed_per_tangential = Scalar(std::int32_t{record.feed_per_tangential_e3}) / Scalar(e3);
    stretch.falling_share = scaled<Scalar>(record.falling_share_e4, e4);
    stretch.feed_per_softness = scaled<Scalar>(record.feed_per_softness_e3, e3);
    stretch.is_known = record.least_share_percent != way_window::StretchRecord::unknown_percent;
    stretch.least_share = stretch.is_known ? scaled<Scalar>(record.least_share_percent, e2) : Scalar(1);
    return stretch;
}

template <typename Scalar>
PathBlock<Scalar> block_of(const way_window::BlockRecord& record) {
    constexpr std::int32_t um_per_mm = 1000;
    return {record.line, scaled<Scalar>(record.end_um - record.length_um, um_per_mm),
            scaled<Scalar>(record.end_um, um_per_mm)};
}

}  // namespace

template <typename Scalar>
WayOverBus<Scalar>::WayOverBus(const Parameters<Scalar>& parameters, std::uint32_t checksum, std::uint8_t node_id)
    : node_id_(node_id),
      settings_(feed_ahead_settings(parameters.machine)),
      receiver_(node_id, checksum),
      along_(parameters),
      ahead_(settings_) {}

template <typename Scalar>
void WayOverBus<Scalar>::change_tool(const AlongPath<Scalar>& along, std::uint32_t checksum) {
    receiver_.set_tool(checksum);
    along_ = along;
    begin_again();
}

template <typename Scalar>
void WayOverBus<Scalar>::look_ahead(ForceControlTick<Scalar>& tick, const hal::ProgramStatus& program) {
    look_ahead_of(tick, program);
}

template <typename Scalar>
void WayOverBus<Scalar>::begin_again() {
    receiver_.forget();
    along_.restart();
    position_ = PathPosition<Scalar>();
    blocks_.clear();
    // In its place: 2.5 kB would not fit the stack of a small processor.
    std::destroy_at(&ahead_);
    std::construct_at(&ahead_, settings_);
    run_ = -1;
    was_refuted_ = false;
    is_asked_ = false;
}

template <typename Scalar>
void WayOverBus<Scalar>::on_frame(const hal::CanFrame& frame) {
    using way_window::WayEvent;
    switch (receiver_.on_frame(frame)) {
        case WayEvent::nothing:
            break;
        case WayEvent::begun:
            begin();
            break;
        case WayEvent::asked:
            is_asked_ = true;
            break;
    }
    while (room() > 0 && take_record()) {
    }
    if (!receiver_.has_session()) {
        empty();
    }
}

template <typename Scalar>
void WayOverBus<Scalar>::begin() {
    const bool is_same_run = run_ == receiver_.run();
    run_ = receiver_.run();
    if (is_same_run) {
        blocks_.clear();
        ahead_.empty();
    } else {
        empty();
        was_refuted_ = false;
        position_ = PathPosition<Scalar>();
        along_.restart();
    }
}

template <typename Scalar>
void WayOverBus<Scalar>::empty() {
    was_refuted_ = is_refuted();
    blocks_.clear();
    ahead_.restart();
}

template <typename Scalar>
bool WayOverBus<Scalar>::take_record() {
    using way_window::NextRecord;
    bool goes_on = false;
    switch (receiver_.take_record()) {
        case NextRecord::none:
            return false;
        case NextRecord::stretch:
            goes_on = ahead_.add(stretch_of<Scalar>(receiver_.stretch()));
            break;
        case NextRecord::block:
            goes_on = blocks_.add(block_of<Scalar>(receiver_.block()));
            break;
    }
    if (!goes_on) {
        receiver_.refuse();
    }
    return goes_on;
}

template <typename Scalar>
std::size_t WayOverBus<Scalar>::room() const {
    return std::min(blocks_.room(), ahead_.room());
}

template <typename Scalar>
std::optional<Scalar> WayOverBus<Scalar>::position_mm() const {
    return along_.is_known() ? std::optional(along_.path_mm()) : std::nullopt;
}

template <typename Scalar>
void WayOverBus<Scalar>::go_to(const hal::ProgramStatus& program) {
    constexpr Scalar kept_behind_mm{2};  // a block is not left before its successor is reported
    const std::optional<Scalar> found = position_.find(blocks_, program.line, Scalar(program.distance_to_go_mm));
    if (along_.go_to(found)) {
        receiver_.forget();
        empty();
    } else if (found) {
        blocks_.drop_before(*found - kept_behind_mm);
    }
}

template <typename Scalar>
bool WayOverBus<Scalar>::take_frame(hal::CanFrame& frame) {
    if (!is_asked_) {
        return false;
    }
    is_asked_ = false;
    frame = way_window::encode(answer(), way_window::way_answer_id(node_id_));
    return true;
}

template <typename Scalar>
way_window::WayAnswer WayOverBus<Scalar>::answer() const {
    way_window::WayAnswer answer = receiver_.answer();
    answer.room = static_cast<std::uint8_t>(room());
    if (answer.state == way_window::WayState::takes && is_refuted()) {
        answer.state = way_window::WayState::refuted;
    }
    return answer;
}

template class WayOverBus<float>;
template class WayOverBus<estimation::Fixed>;

}  // namespace millforce::firmware
