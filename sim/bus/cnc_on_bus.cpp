// SPDX-License-Identifier: Apache-2.0
#include "bus/cnc_on_bus.hpp"

#include <utility>

namespace millforce::sim {

namespace {

/// F in the steps of the frame: rounding of the same F is not a change.
bool differ(const hal::ProgramStatus& a, const hal::ProgramStatus& b) {
    return a.rapid != b.rapid || a.feed_hold != b.feed_hold || a.programmed_feed_mm_s != b.programmed_feed_mm_s ||
           a.operator_override != b.operator_override;
}

}  // namespace

void CncOnBus::set(const hal::ProgramStatus& program, std::uint64_t time_us) {
    const bool is_news = !has_status_ || differ(program, newest_.program) ||
                         (settings_.reports_position && program.line != newest_.program.line);
    newest_.program = program;
    has_status_ = true;
    if (is_news) {
        send(time_us);
    }
}

void CncOnBus::poll(std::uint64_t time_us) {
    if (has_status_ && time_us >= next_us_) {
        send(time_us);
    }
    if (has_status_ && time_us >= next_speed_us_) {
        send_speed(time_us);
    }
    if (tool_ && time_us >= next_tool_us_) {
        send_tool(time_us);
    }
}

void CncOnBus::set_tool(std::uint32_t number, std::uint64_t time_us) {
    tool_ = number;
    send_tool(time_us);
}

void CncOnBus::send_tool(std::uint64_t time_us) {
    next_tool_us_ = time_us + settings_.number_period_us;
    if (const std::uint32_t id = program_status::tool_frame_id(settings_.program_status_id); id != 0) {
        outgoing_.push_back(program_status::encode_tool(*tool_, id));
    }
}

void CncOnBus::send_speed(std::uint64_t time_us) {
    next_speed_us_ = time_us + settings_.number_period_us;
    const std::uint32_t id = program_status::speed_frame_id(settings_.program_status_id);
    if (id != 0) {
        outgoing_.push_back(program_status::encode_speed(newest_.program.commanded_speed_rad_s, id));
    }
}

void CncOnBus::send(std::uint64_t time_us) {
    next_us_ = time_us + settings_.program_status_period_us;
    if (settings_.program_status_id != 0) {
        ++newest_.counter;
        outgoing_.push_back(program_status::encode(newest_, settings_.program_status_id));
        send_position();
    }
}

void CncOnBus::send_position() {
    const std::uint32_t id = program_status::position_frame_id(settings_.program_status_id);
    if (settings_.reports_position && id != 0) {
        ++positions_sent_;
        outgoing_.push_back(program_status::encode_position(
            {newest_.program.line, newest_.program.distance_to_go_mm, positions_sent_}, id));
    }
}

std::vector<hal::CanFrame> CncOnBus::take_frames() {
    return std::exchange(outgoing_, {});
}

}  // namespace millforce::sim
