// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "socketcan/can_socket.hpp"

namespace millforce::host {

/// Settings of a socket on the interface that a command line names. Throws InputError where the name is none.
[[nodiscard]] socketcan::CanSocketSettings socket_on(const std::string& interface);

}  // namespace millforce::host
