// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hal/can_frame.hpp"

namespace millforce::host {

/// The frame as `candump -l` writes it, with the line's end.
std::string candump_line(const hal::CanFrame& frame, std::uint64_t unix_us, std::string_view interface);

}  // namespace millforce::host
