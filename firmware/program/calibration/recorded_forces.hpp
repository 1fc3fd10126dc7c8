// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "calibration/plausible_units.hpp"
#include "calibration/recorded_cuts.hpp"
#include "firmware/feed_frame_forces.hpp"
#include "firmware/parameters.hpp"

namespace millforce::host {

using FeedForces = firmware::FeedFrameForces<float>::Forces;

/// One sample of a recorded cut in the feed's frame; dt_s is 0 at its beginning.
using ForceTaker = std::function<void(std::size_t cut, float dt_s, const FeedForces& forces)>;

/// What a cut was on average.
struct RecordedCutAverages {
    std::size_t samples = 0;     ///< whose forces are there
    double spindle_rad_s = 0.0;  ///< 0: too short to be known
    double feed_mm_s = 0.0;
    double along_N = 0.0;
    double across_N = 0.0;
    char fastest_axis = 'x';

    [[nodiscard]] double feed_per_tooth_mm(double flutes) const;
};

/// Reads the recordings and hands over the samples within each cut of the table, in the recording's order. Samples that
/// are not valid come too: averages must restart there. Returns the averages in the table's order. Throws InputError,
/// also for an angle in degrees or revolutions.
std::vector<RecordedCutAverages> read_recorded_forces(const std::vector<std::filesystem::path>& recordings,
                                                      const std::vector<StretchConditions>& cuts,
                                                      const firmware::Parameters<float>& parameters,
                                                      const ForceTaker& take);

/// The rows of the table that cut, with the tool of the parameters. Throws InputError where there is none, or a row's
/// diameter or flutes are another tool's.
std::vector<StretchConditions> cuts_of_tool(const std::filesystem::path& table,
                                            const std::vector<std::filesystem::path>& recordings,
                                            const firmware::ToolParameters<float>& tool);

/// Throws InputError where chip or cutting speed of a cut is no tool's (refuse_implausible_cut).
void refuse_implausible_cuts(const std::vector<StretchConditions>& cuts,
                             const std::vector<RecordedCutAverages>& averages);

/// The average force against the tool's law (force_against_law, ask_about_one_force), by the median over the cuts,
/// which are known to cut. Throws InputError.
UnitQuestions look_at_recorded_forces(const std::filesystem::path& table, const std::vector<StretchConditions>& cuts,
                                      const std::vector<RecordedCutAverages>& averages,
                                      const firmware::ToolParameters<float>& tool);

}  // namespace millforce::host
