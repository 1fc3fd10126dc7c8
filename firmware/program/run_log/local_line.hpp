// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "hal/drive_sample.hpp"

/// What a source beside the bus gave for a SYNC, as a line of a recording. Comments to candump's tools, and behind the
/// line of the SYNC that it belongs to:
///
///     #local (1436509052.249713) spindle_current_A=20.1 spindle_count=546 x_current_A=0.8 x_velocity_mm_s=10
///
/// A quantity that did not come is left out. Each number is the shortest that reads back as the same float, so that a
/// replay has the run's bits. The time is for the reader's eye: the value's place in the file is what counts.

namespace millforce::host {

/// With the line's end.
[[nodiscard]] std::string local_line(const hal::DriveSample& sample, std::uint64_t unix_us);

[[nodiscard]] bool is_local_line(std::string_view line);

/// False where it is not such a line as local_line() writes.
[[nodiscard]] bool read_local_line(std::string_view line, hal::DriveSample& sample);

}  // namespace millforce::host
