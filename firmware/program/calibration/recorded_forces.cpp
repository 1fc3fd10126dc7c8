// SPDX-License-Identifier: Apache-2.0
#include "calibration/recorded_forces.hpp"

#include <fmt/format.h>

#include <cmath>

#include "files/input_error.hpp"
#include "files/progress.hpp"
#include "recording/recording.hpp"

namespace millforce::host {

namespace {

/// A cut while its recording is read: each has its own frame, because cuts may overlap.
struct RunningCut {
    std::size_t place = 0;
    StretchConditions conditions;
    firmware::FeedFrameForces<float> forces;
    double last_s = no_estimate;
};

std::vector<RunningCut> cuts_in(const std::filesystem::path& recording, const std::vector<StretchConditions>& cuts,
                                const firmware::Parameters<float>& parameters) {
    std::vector<RunningCut> running;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        if (cuts[k].recording == recording.filename() || cuts[k].recording == recording.string()) {
            running.push_back({k, cuts[k], firmware::FeedFrameForces<float>(parameters), no_estimate});
        }
    }
    return running;
}

}  // namespace

void read_recorded_forces(const std::vector<std::filesystem::path>& recordings,
                          const std::vector<StretchConditions>& cuts, const firmware::Parameters<float>& parameters,
                          const ForceTaker& take) {
    const auto counts_per_rev = parameters.machine.encoder_counts_per_rev;
    for (const auto& path : recordings) {
        std::vector<RunningCut> running = cuts_in(path, cuts, parameters);
        RecordingReader reader(path, counts_per_rev);
        if (firmware::has_force_sensor(parameters.tool) && !reader.has_force_sensor()) {
            throw InputError(
                fmt::format("{}:1: no column 'fx_N' or 'fy_N', expected the force sensor whose low_pass_hz "
                            "the tool's [force_sensor] gives",
                            path.string()));
        }
        Progress progress("reading " + path.filename().string());
        while (reader.next()) {
            progress.update(reader.fraction_read());
            for (RunningCut& cut : running) {
                const double time_s = reader.time_s();
                if (time_s < cut.conditions.start_s || time_s > cut.conditions.end_s) {
                    continue;
                }
                const auto dt_s = static_cast<float>(std::isnan(cut.last_s) ? 0.0 : time_s - cut.last_s);
                cut.last_s = time_s;
                take(cut.place, dt_s, cut.forces.read(dt_s, reader.sample()));
            }
        }
    }
}

std::vector<StretchConditions> cuts_of_tool(const std::filesystem::path& table,
                                            const std::vector<std::filesystem::path>& recordings,
                                            const firmware::ToolParameters<float>& tool) {
    std::vector<StretchConditions> cuts = read_cut_table(table, recordings);
    std::erase_if(cuts, [](const StretchConditions& row) { return !row.in_cut(); });
    if (cuts.empty()) {
        throw InputError(
            fmt::format("{}: no row with a depth and a width, expected cuts of known engagement", table.string()));
    }
    const auto diameter_mm = static_cast<double>(tool.diameter_mm);
    for (const StretchConditions& cut : cuts) {
        if (std::abs(cut.tool_diameter_mm - diameter_mm) > 1e-3 * diameter_mm || cut.flutes != tool.teeth) {
            throw InputError(
                fmt::format("{}: a tool of Ø{:g} mm with {} flutes, expected the tool file's Ø{:g} mm and {}",
                            cut.place, cut.tool_diameter_mm, cut.flutes, diameter_mm, tool.teeth));
        }
    }
    return cuts;
}

}  // namespace millforce::host
