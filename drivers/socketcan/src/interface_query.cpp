// SPDX-License-Identifier: Apache-2.0
#include "socketcan/interface_query.hpp"

#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>

namespace millforce::socketcan {

namespace {

struct LinkRequest {
    nlmsghdr header;
    ifinfomsg link;
};

/// Calls `take(type, bytes)` for each attribute in `data`.
template <typename Take>
void for_each_attribute(std::span<const std::uint8_t> data, Take take) {
    while (data.size() >= sizeof(rtattr)) {
        rtattr attribute{};
        std::memcpy(&attribute, data.data(), sizeof attribute);
        if (attribute.rta_len < sizeof attribute || attribute.rta_len > data.size()) {
            return;
        }
        take(static_cast<unsigned>(attribute.rta_type) & static_cast<unsigned>(NLA_TYPE_MASK),
             data.first(attribute.rta_len).subspan(sizeof attribute));
        const std::size_t step = RTA_ALIGN(attribute.rta_len);
        data = step < data.size() ? data.subspan(step) : std::span<const std::uint8_t>{};
    }
}

void take_can_state(std::span<const std::uint8_t> bytes, InterfaceReport& report) {
    std::uint32_t state = 0;
    if (bytes.size() < sizeof state) {
        return;
    }
    std::memcpy(&state, bytes.data(), sizeof state);
    report.has_state = state <= CAN_STATE_BUS_OFF;
    switch (state) {
        case CAN_STATE_ERROR_WARNING:
            report.state = ControllerState::error_warning;
            break;
        case CAN_STATE_ERROR_PASSIVE:
            report.state = ControllerState::error_passive;
            break;
        case CAN_STATE_BUS_OFF:
            report.state = ControllerState::bus_off;
            break;
        default:
            report.state = ControllerState::error_active;
            break;
    }
}

void take_link_info(std::span<const std::uint8_t> info, InterfaceReport& report) {
    bool is_can = false;
    for_each_attribute(info, [&](unsigned type, std::span<const std::uint8_t> bytes) {
        if (type == IFLA_INFO_KIND) {
            is_can = bytes.size() >= 3 && std::memcmp(bytes.data(), "can", 3) == 0;
        } else if (type == IFLA_INFO_DATA && is_can) {
            for_each_attribute(bytes, [&](unsigned inner, std::span<const std::uint8_t> value) {
                if (inner == IFLA_CAN_STATE) {
                    take_can_state(value, report);
                }
            });
        }
    });
}

}  // namespace

InterfaceReport read_link_message(std::span<const std::uint8_t> message) {
    InterfaceReport report;
    report.answered = true;
    LinkRequest fixed{};
    if (message.size() < sizeof fixed) {
        return report;
    }
    std::memcpy(&fixed, message.data(), sizeof fixed);
    if (fixed.header.nlmsg_type != RTM_NEWLINK || fixed.header.nlmsg_len > message.size() ||
        fixed.header.nlmsg_len < sizeof fixed) {
        return report;
    }
    report.found = true;
    report.is_up = (fixed.link.ifi_flags & IFF_UP) != 0;
    for_each_attribute(message.first(fixed.header.nlmsg_len).subspan(sizeof fixed),
                       [&](unsigned type, std::span<const std::uint8_t> bytes) {
                           if (type == IFLA_CARRIER && !bytes.empty()) {
                               report.has_carrier = bytes[0] != 0;
                           } else if (type == IFLA_LINKINFO) {
                               take_link_info(bytes, report);
                           }
                       });
    return report;
}

InterfaceQuery::~InterfaceQuery() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

InterfaceReport InterfaceQuery::ask(int interface_index) {
    if (descriptor_ < 0) {
        descriptor_ = ::socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE);
    }
    LinkRequest request{};
    request.header.nlmsg_len = sizeof request;
    request.header.nlmsg_type = RTM_GETLINK;
    request.header.nlmsg_flags = NLM_F_REQUEST;
    request.link.ifi_index = interface_index;
    // The kernel answers within the call that asks.
    alignas(nlmsghdr) std::array<std::uint8_t, 8192> answer{};
    if (::send(descriptor_, &request, sizeof request, MSG_DONTWAIT) != sizeof request) {
        return {};
    }
    const ssize_t size = ::recv(descriptor_, answer.data(), answer.size(), MSG_DONTWAIT);
    return size > 0 ? read_link_message(std::span(answer).first(static_cast<std::size_t>(size))) : InterfaceReport{};
}

}  // namespace millforce::socketcan
