// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "firmware/parameters.hpp"
#include "hal/drive_sample.hpp"

namespace millforce::host {

/// Recordings of a source that gives less than a sample in 0.45 revolutions, as the trace of a control at 10 to 50 Hz:
/// the tick then cannot tell the direction of the turn. Between two samples the spindle is taken to turn evenly and all
/// else to change evenly; so the averages over revolutions hold, and nothing within a revolution does.

/// The tick cannot tell the direction of a longer turn (estimation/signal/encoder_angle.hpp).
inline constexpr double farthest_rev = 0.45;

/// Samples in a revolution that the tick is given of such a recording.
inline constexpr double filled_samples_per_rev = 20.0;

/// Into how many parts the step between two of its first samples is divided, in the middle; 1: the recording is fast
/// enough. Throws InputError where the spindle turns so far that not even averages over revolutions can be compared: 20
/// revolutions or more.
[[nodiscard]] int parts_of_slow_samples(const std::filesystem::path& log, std::uint32_t encoder_counts_per_rev);

/// Each sample's noise is in all parts of its step: as much as `parts` samples with √parts of the noise show.
[[nodiscard]] firmware::MachineParameters<float> for_slow_samples(firmware::MachineParameters<float> machine,
                                                                  int parts);

/// The share 0…1 of the way from one sample to the next. Both have an encoder.
[[nodiscard]] hal::DriveSample sample_between(const hal::DriveSample& from, const hal::DriveSample& to, double share);

}  // namespace millforce::host
