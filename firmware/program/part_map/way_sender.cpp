// SPDX-License-Identifier: Apache-2.0
#include "part_map/way_sender.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "firmware/tool_checksum.hpp"

namespace millforce::host {

namespace {

using way_window::WayAnswer;
using way_window::WayFrame;
using way_window::WayFrameKind;
using way_window::WayState;

constexpr std::uint64_t ask_period_us = 10'000;
constexpr std::uint64_t silent_after_us = 500'000;
constexpr std::uint64_t refused_patience_us = 1'000'000;  // the tool may change
constexpr std::uint64_t left_behind_patience_us = 50'000;
/// So long a window that has room may take to reach the tool.
constexpr std::uint64_t fill_patience_us = 500'000;
constexpr std::uint64_t most_frames_at_once = 4;
/// Of position frames, each 10 ms.
constexpr int samples_of_jump = 5;
constexpr double begun_again_mm = 2.0;
/// A session begins so far behind the tool: an estimate's window counts, too.
constexpr double kept_behind_mm = 5.0;

std::vector<std::uint8_t> bytes_of(const WayRecord& record) {
    return std::visit(
        [](const auto& of_kind) {
            const auto bytes = way_window::bytes_of(of_kind);
            return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
        },
        record);
}

WayFrameKind kind_of(const WayRecord& record) {
    return std::holds_alternative<way_window::StretchRecord>(record) ? WayFrameKind::stretch : WayFrameKind::block;
}

bool is_refusal(WayState state) {
    return state == WayState::other_tool || state == WayState::other_layout || state == WayState::unsound_record;
}

}  // namespace

WaySender::WaySender(const WaySenderSettings& settings, const PartMap& map,
                     const firmware::Parameters<float>& parameters)
    : settings_(settings),
      records_(way_records(map, parameters)),
      tool_checksum_(firmware::tool_checksum(parameters.tool)),
      position_(map, samples_of_jump),
      position_receiver_(settings.position_id) {}

void WaySender::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    if (position_receiver_.on_frame(frame, time_us)) {
        take_position(time_us);
    }
    WayAnswer answer;
    if (way_window::decode(frame, way_window::way_answer_id(settings_.node_id), answer) ==
        way_window::FrameError::none) {
        take_answer(answer, time_us);
    }
}

void WaySender::take_position(std::uint64_t time_us) {
    const program_status::ProgramPosition reported = position_receiver_.position(time_us, 0.0F);
    position_mm_ = position_.find(reported.line, static_cast<double>(reported.distance_to_go_mm));
    position_us_ = time_us;
    if (position_mm_ && *position_mm_ < reached_mm_ - begun_again_mm) {
        ++run_;
        begin(time_us);
    }
    reached_mm_ = position_mm_.value_or(reached_mm_);
    const bool is_behind = position_mm_ && session_ != 0 && is_left_behind(time_us);
    left_behind_us_ = !is_behind ? 0 : left_behind_us_ == 0 ? time_us : left_behind_us_;
}

bool WaySender::is_left_behind(std::uint64_t now_us) const {
    const bool begins_ahead = first_ > 0 && begin_mm(records_[first_]) > *position_mm_;
    const bool ends_behind = taken_ < records_.size() && known_to_mm() < *position_mm_;
    return begins_ahead || (ends_behind && (room_ == 0 || now_us > begun_us_ + fill_patience_us));
}

double WaySender::known_to_mm() const {
    return taken_ > first_ ? begin_mm(records_[taken_ - 1]) : 0.0;
}

/// Newer than the last one, and to an ask since the sender went back: what was sent before is out of date.
bool WaySender::is_of_use(const WayAnswer& answer) {
    const auto age = static_cast<std::uint8_t>(static_cast<std::uint8_t>(asks_) - answer.ask);
    if (age >= asks_ || asks_ - age <= answered_ask_ || asks_ - age < valid_from_ask_) {
        return false;
    }
    answered_ask_ = asks_ - age;
    return true;
}

void WaySender::take_answer(const WayAnswer& answer, std::uint64_t time_us) {
    answer_us_ = time_us;
    if (!is_of_use(answer)) {
        return;
    }
    answer_ = answer;
    if (is_refused()) {
        return;
    }
    // 16 bits of a count that goes on from the last one.
    const auto last = static_cast<std::uint16_t>(taken_ - first_);
    const std::size_t taken = taken_ + static_cast<std::uint16_t>(answer.expected - last);
    if (answer.state == WayState::waits || answer.session != session_ || taken > next_) {
        begin(time_us);
        return;
    }
    for (; taken_ < taken; ++taken_) {
        digest_ = way_window::digest(digest_, bytes_of(records_[taken_]));
    }
    if (digest_ != answer.digest) {
        begin(time_us);
        return;
    }
    room_ = answer.room;
    if (taken_ < next_at_ask_[answer.ask]) {
        go_back();
    }
}

void WaySender::go_back() {
    next_ = taken_;
    frames_.clear();
    valid_from_ask_ = asks_ + 1;
}

void WaySender::begin_again(std::uint64_t now_us) {
    ++run_;
    position_mm_.reset();
    reached_mm_ = 0.0;
    answer_.reset();
    begin(now_us);
}

void WaySender::begin(std::uint64_t now_us) {
    session_ = static_cast<std::uint8_t>(session_ % way_window::last_session + 1);
    ++sessions_;
    first_ = position_mm_ ? first_record_at(*position_mm_ - kept_behind_mm) : 0;
    taken_ = first_;
    digest_ = 0;
    room_ = way_window::largest_window;
    left_behind_us_ = 0;
    begun_us_ = now_us;
    go_back();
    push(way_window::begin_frame(session_, run_, tool_checksum_));
    ask(now_us);
}

/// The stretch and the block at the place belong to it: they began before.
std::size_t WaySender::first_record_at(double path_mm) const {
    std::size_t stretch = 0;
    std::size_t block = 0;
    for (std::size_t i = 0; i < records_.size() && begin_mm(records_[i]) <= path_mm; ++i) {
        (kind_of(records_[i]) == WayFrameKind::stretch ? stretch : block) = i;
    }
    return std::min(stretch, block);
}

void WaySender::poll(std::uint64_t now_us) {
    if (records_.empty()) {
        return;
    }
    if (now_us > position_us_ + program_status::PositionReceiver::timeout_us) {
        position_mm_.reset();
    }
    const bool is_left = left_behind_us_ != 0 && now_us > left_behind_us_ + left_behind_patience_us;
    if (session_ == 0 || is_left || (is_refused() && now_us > begun_us_ + refused_patience_us)) {
        begin(now_us);
    }
    send_next(now_us);
    const std::uint64_t periods = (now_us - paced_us_) / settings_.frame_period_us;
    paced_us_ += periods * settings_.frame_period_us;
    frames_due_ = std::min(frames_due_ + periods, most_frames_at_once);
}

bool WaySender::is_refused() const {
    return answer_ && answer_->session == session_ && is_refusal(answer_->state);
}

/// Until then no record is sent: where no controller hears them they would only load the bus.
bool WaySender::is_accepted() const {
    return answer_ && answer_->session == session_ && !is_refusal(answer_->state);
}

void WaySender::send_next(std::uint64_t now_us) {
    const bool is_full = next_ >= records_.size() || next_ - taken_ >= room_;
    if (frames_.empty() && now_us >= ask_us_ + ask_period_us) {
        ask(now_us);
    } else if (frames_.empty() && !is_full && is_accepted()) {
        send_record();
    }
}

void WaySender::send_record() {
    const WayRecord& record = records_[next_];
    const std::vector<std::uint8_t> bytes = bytes_of(record);
    WayFrame frame;
    frame.number = static_cast<std::uint8_t>(next_ - first_);
    frame.session = session_;
    frame.kind = static_cast<std::uint8_t>(kind_of(record));
    for (std::size_t place = 0; place < bytes.size(); place += way_window::payload_bytes) {
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(place), way_window::payload_bytes,
                    frame.payload.begin());
        push(frame);
        ++frame.kind;
    }
    ++next_;
}

void WaySender::ask(std::uint64_t now_us) {
    ++asks_;
    ask_us_ = now_us;
    WayFrame frame;
    frame.number = static_cast<std::uint8_t>(asks_);
    frame.kind = static_cast<std::uint8_t>(WayFrameKind::ask);
    frame.session = session_;
    next_at_ask_[frame.number] = next_;
    push(frame);
}

void WaySender::push(const WayFrame& frame) {
    frames_.push_back(way_window::encode(frame, way_window::way_frame_id(settings_.node_id)));
}

bool WaySender::take_frame(hal::CanFrame& frame) {
    if (frames_.empty() || frames_due_ == 0) {
        return false;
    }
    --frames_due_;
    frame = frames_.front();
    frames_.pop_front();
    return true;
}

std::optional<WayState> WaySender::controller_state(std::uint64_t now_us) const {
    return answer_ && now_us <= answer_us_ + silent_after_us ? std::optional(answer_->state) : std::nullopt;
}

}  // namespace millforce::host
