// SPDX-License-Identifier: Apache-2.0
#include "commands/can_interface.hpp"

#include <fmt/format.h>

#include "files/input_error.hpp"

namespace millforce::host {

socketcan::CanSocketSettings socket_on(const std::string& interface) {
    socketcan::CanSocketSettings settings;
    if (!settings.set_interface(interface)) {
        throw InputError(fmt::format("'{}': expected a CAN interface of at most 15 characters, e.g. can0", interface));
    }
    return settings;
}

}  // namespace millforce::host
