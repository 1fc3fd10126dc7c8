// SPDX-License-Identifier: Apache-2.0
#include "commission/validation.hpp"

#include <cmath>

#include "estimation/cutting/cutting_law.hpp"
#include "parameters/parameter_table.hpp"

namespace millforce::host {

bool ValidatedCut::holds() const {
    return std::abs(torque_error()) <= torque_bound && std::abs(force_error()) <= force_bound;
}

std::vector<ValidatedCut> validate_cuts(const std::vector<std::filesystem::path>& recordings,
                                        const std::filesystem::path& cuts, const MachineParameters& machine,
                                        const LibraryEntry& entry, estimation::CutSide side) {
    constexpr double deviations = 2.0;
    const std::vector<RecordedStretch> stretches = read_recorded_cuts(recordings, cuts);
    const std::vector<CutRow> rows = forces_of_cuts(stretches, machine);
    std::vector<ValidatedCut> result;
    std::size_t row_number = 0;
    for (const RecordedStretch& stretch : stretches) {
        if (!stretch.conditions.in_cut()) {
            continue;
        }
        const CutRow& row = rows.at(row_number++);
        const double immersion = row.radial_width_mm / row.radius_mm();
        const auto expected = estimation::average_forces_with_doubt<double>(
            entry.law,
            {row.feed_per_tooth_mm(), row.axial_depth_mm, estimation::engagement_angles(side, immersion), row.flutes});
        ValidatedCut cut;
        cut.axis = axis_tables.at(stretch.axis);
        cut.feed_mm_min = row.feed_mm_s * 60.0;
        cut.radial_width_mm = row.radial_width_mm;
        cut.torque_Nm = row.spindle_torque_Nm;
        cut.expected_torque_Nm = expected.mean.tangential_N * 1e-3 * row.radius_mm();
        cut.feed_force_N = row.feed_force_N;
        cut.expected_feed_force_N = expected.mean.feed_N;
        cut.torque_bound = deviations * static_cast<double>(machine.spindle.gain_relative_sd);
        cut.force_bound = deviations * static_cast<double>(machine.axes.at(stretch.axis).gain_relative_sd);
        result.push_back(cut);
    }
    return result;
}

}  // namespace millforce::host
