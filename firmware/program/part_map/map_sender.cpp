// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_sender.hpp"

#include <algorithm>
#include <numeric>

namespace millforce::host {

void MapSender::add(const PartMap& map, const firmware::Parameters<float>& parameters) {
    senders_.push_back({0, WaySender(settings_, map, parameters)});
    active_ = &senders_.back().sender;
}

bool MapSender::add(std::uint32_t number, const PartMap& map, const firmware::Parameters<float>& parameters) {
    const bool is_new = std::none_of(senders_.begin(), senders_.end(),
                                     [number](const Numbered& other) { return other.number == number; });
    if (is_new) {
        senders_.push_back({number, WaySender(settings_, map, parameters)});
    }
    return is_new;
}

void MapSender::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    tool_.on_frame(frame, time_us);
    follow_tool(time_us);
    if (active_ != nullptr) {
        active_->on_frame(frame, time_us);
    }
}

void MapSender::follow_tool(std::uint64_t now_us) {
    const std::uint32_t number = tool_.number(now_us);
    const bool is_any = senders_.size() == 1 && senders_.front().number == 0;
    if (is_any || number == number_) {
        return;
    }
    number_ = number;
    const auto found = std::find_if(senders_.begin(), senders_.end(), [number](const Numbered& candidate) {
        return number != 0 && candidate.number == number;
    });
    active_ = found != senders_.end() ? &found->sender : nullptr;
    if (active_ != nullptr) {
        active_->begin_again(now_us);
    }
}

void MapSender::poll(std::uint64_t now_us) {
    follow_tool(now_us);
    if (active_ != nullptr) {
        active_->poll(now_us);
    }
}

std::uint32_t MapSender::sessions() const {
    return std::accumulate(senders_.begin(), senders_.end(), std::uint32_t{0},
                           [](std::uint32_t sum, const Numbered& one) { return sum + one.sender.sessions(); });
}

bool MapSender::take_frame(hal::CanFrame& frame) {
    return active_ != nullptr && active_->take_frame(frame);
}

}  // namespace millforce::host
