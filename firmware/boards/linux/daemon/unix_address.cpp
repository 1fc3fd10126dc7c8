// SPDX-License-Identifier: Apache-2.0
#include "daemon/unix_address.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <cstring>

#include "files/input_error.hpp"

namespace millforce::host {

sockaddr_un unix_address(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.empty() || path.size() >= sizeof address.sun_path) {
        throw InputError(fmt::format("'{}': expected the path of a socket, at most {} characters", path,
                                     sizeof address.sun_path - 1));
    }
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    return address;
}

}  // namespace millforce::host
