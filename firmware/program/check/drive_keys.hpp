// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters.hpp"
#include "parameters/drive_names.hpp"

#include <string>
#include <string_view>

/// What to look at where a drive's current is wrong: the key of its [bus] table, or the column of the recording where
/// the drive is not on the bus.

namespace millforce::host {

/// `drive`: 0 spindle, 1 x, 2 y, 3 z. `bus_key`: "current_reversed".
std::string key_of_current(const firmware::MachineParameters<float>& machine, std::size_t drive,
                           std::string_view bus_key);

/// The largest current that the controller uses, in A; where the rated current is not known, more than any machine
/// tool's drive carries.
double largest_current_A(const firmware::MachineParameters<float>& machine, std::size_t drive);

double rated_current_A(const firmware::MachineParameters<float>& machine, std::size_t drive);

/// Whether a ratio of currents, recorded over expected, is that of peak to rms amperes, √2, within 6 %; and the words
/// for it. -1: rms where peak is expected.
int peak_for_rms(double ratio);
std::string words_for_peak_and_rms(int direction);

}  // namespace millforce::host
