// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "socketcan/error_frame.hpp"

namespace millforce::socketcan {

/// What the kernel knows about a CAN interface, by rtnetlink. The interface flags are not enough: they follow a lost
/// carrier with a delay of up to a second.
struct InterfaceReport {
    bool answered = false;  ///< else nothing of this is known
    bool found = false;
    bool is_up = false;
    bool has_carrier = false;  ///< a controller in bus-off has none
    bool has_state = false;    ///< a virtual interface has none
    ControllerState state = ControllerState::error_active;
};

/// An RTM_NEWLINK message; not found where it is anything else or its lengths do not fit.
[[nodiscard]] InterfaceReport read_link_message(std::span<const std::uint8_t> message);

/// No heap; ask() returns at once.
class InterfaceQuery {
  public:
    InterfaceQuery() = default;
    ~InterfaceQuery();
    InterfaceQuery(const InterfaceQuery&) = delete;
    InterfaceQuery& operator=(const InterfaceQuery&) = delete;

    [[nodiscard]] InterfaceReport ask(int interface_index);

  private:
    int descriptor_ = -1;
};

}  // namespace millforce::socketcan
