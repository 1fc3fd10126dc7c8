// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/un.h>

#include <string>

namespace millforce::host {

/// The address of a Unix socket. Throws InputError where the path is empty or too long for one.
sockaddr_un unix_address(const std::string& path);

}  // namespace millforce::host
