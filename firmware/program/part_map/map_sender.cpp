// SPDX-License-Identifier: Apache-2.0
#include "part_map/map_sender.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "files/input_error.hpp"

namespace millforce::host {

namespace {

std::string names_of(const std::vector<std::uint32_t>& numbers) {
    std::string text;
    for (const std::uint32_t number : numbers) {
        text += fmt::format("{}T{}", text.empty() ? "" : ", ", number);
    }
    return text;
}

}  // namespace

std::uint32_t number_of_map(const std::string& map_file, const MapOrigin& origin, const std::string& folder,
                            const std::vector<firmware::NumberedTool>& tools) {
    std::vector<std::uint32_t> of_geometry;
    for (const firmware::NumberedTool& tool : tools) {
        if (origin_of({}, {}, tool.parameters).tool_crc32 == origin.tool_crc32) {
            of_geometry.push_back(tool.number);
        }
    }
    const auto named = std::find_if(of_geometry.begin(), of_geometry.end(),
                                    [&](std::uint32_t number) { return origin.tool == fmt::format("T{}", number); });
    if (named != of_geometry.end()) {
        return *named;
    }
    if (of_geometry.empty()) {
        throw InputError(
            fmt::format("{}: made for another tool ('{}') than those of {}", map_file, origin.tool, folder));
    }
    if (of_geometry.size() > 1) {
        throw InputError(
            fmt::format("{}: made for '{}', which may be {} of {}; make it again with 'millforce preview' "
                        "and the tool's file of that folder",
                        map_file, origin.tool, names_of(of_geometry), folder));
    }
    return of_geometry.front();
}

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
