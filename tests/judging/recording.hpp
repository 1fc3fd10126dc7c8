// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/drive_sample.hpp"
#include "judging/drawn_cut.hpp"

#include <vector>

namespace millforce::judging {

struct Recording {
    std::vector<hal::DriveSample> samples;  ///< one per millisecond
    std::size_t rapid_end = 0;              ///< samples of the rapid
    std::size_t whole_from = 0;             ///< from here on the whole arc is engaged
    hal::ProgramStatus program;             ///< of the feed move
};

/// A rapid, a feed move in air, the entry through a straight face, and the steady cut: at least 1.5 s and 25
/// revolutions of it. Speeds are constant in each part and ramp between them. The drives see forces through a
/// first-order lag of 100 Hz.
Recording record(const DrawnCut& drawn);

}  // namespace millforce::judging
