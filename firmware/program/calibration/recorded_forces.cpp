// SPDX-License-Identifier: Apache-2.0
#include "calibration/recorded_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "estimation/number/circle.hpp"
#include "files/input_error.hpp"
#include "files/progress.hpp"
#include "recording/recording.hpp"

namespace millforce::host {

namespace {

/// Speed, feed and force of a cut, whether or not its samples are good enough to be handed over.
class AverageOfCut {
  public:
    void add(double time_s, const hal::DriveSample& sample, const FeedForces& forces) {
        if (rows_ == 0) {
            first_s_ = time_s;
        } else {
            turned_counts_ += static_cast<std::int32_t>(sample.spindle_count - last_count_);
        }
        last_s_ = time_s;
        last_count_ = sample.spindle_count;
        ++rows_;
        for (std::size_t k = 0; k < path_mm_s_.size(); ++k) {
            const double velocity_mm_s = static_cast<double>(sample.axis_velocity_mm_s.at(k));
            path_mm_s_.at(k) += std::isfinite(velocity_mm_s) ? velocity_mm_s : 0.0;
        }
        if (forces.valid) {
            ++found_.samples;
            found_.along_N += static_cast<double>(forces.along_N);
            found_.across_N += static_cast<double>(forces.across_N);
        }
    }
    [[nodiscard]] RecordedCutAverages found(std::uint32_t counts_per_rev) const {
        constexpr long fewest = 20;
        RecordedCutAverages result = found_;
        const double duration_s = last_s_ - first_s_;
        if (rows_ < fewest || !(duration_s > 0.0)) {
            return result;
        }
        const auto samples = static_cast<double>(std::max<std::size_t>(found_.samples, 1));
        result.along_N /= samples;
        result.across_N /= samples;
        result.spindle_rad_s = estimation::turn_rad<double> * std::abs(turned_counts_) / counts_per_rev / duration_s;
        result.feed_mm_s = std::hypot(path_mm_s_[0], path_mm_s_[1]) / static_cast<double>(rows_);
        result.fastest_axis = std::abs(path_mm_s_[0]) >= std::abs(path_mm_s_[1]) ? 'x' : 'y';
        return result;
    }

  private:
    RecordedCutAverages found_;
    std::array<double, 2> path_mm_s_{};  ///< velocities added up
    double first_s_ = 0.0;
    double last_s_ = 0.0;
    double turned_counts_ = 0.0;
    std::uint32_t last_count_ = 0;
    long rows_ = 0;
};

/// A cut while its recording is read: each has its own frame, because cuts may overlap.
struct RunningCut {
    std::size_t place = 0;
    StretchConditions conditions;
    firmware::FeedFrameForces<float> forces;
    double last_s = no_estimate;
    AverageOfCut average{};
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

/// By the tool's law. Where its side is not known: as in down milling, with an average that is as large in up milling.
estimation::AverageForcesWithDoubt<float> expected_forces(const StretchConditions& cut, double feed_per_tooth_mm,
                                                          const firmware::ToolParameters<float>& tool) {
    const auto immersion = static_cast<float>(cut.radial_width_mm / (0.5 * cut.tool_diameter_mm));
    const auto side = tool.side == estimation::CutSide::unknown ? estimation::CutSide::down : tool.side;
    return estimation::average_forces_with_doubt<float>(
        tool.law, {static_cast<float>(feed_per_tooth_mm), static_cast<float>(cut.axial_depth_mm),
                   estimation::engagement_angles(side, immersion), static_cast<float>(cut.flutes)});
}

/// Medians over the cuts: measured over expected.
class ForcesOverLaw {
  public:
    void add(const RecordedCutAverages& measured, const estimation::AverageForcesWithDoubt<float>& expected) {
        const auto feed_N = static_cast<double>(expected.mean.feed_N);
        const auto normal_N = static_cast<double>(expected.mean.normal_N);
        const double whole_N = std::hypot(feed_N, normal_N);
        if (measured.samples == 0 || !(whole_N > 0.0)) {
            return;
        }
        constexpr double is_seen = 0.3;  // a smaller component may be anything
        whole_.push_back(std::hypot(measured.along_N, measured.across_N) / whole_N);
        pressures_.push_back(static_cast<double>(expected.coefficients.K_s_N_per_mm2));
        if (std::abs(feed_N) > is_seen * whole_N) {
            along_.push_back(std::abs(measured.along_N / feed_N));
        }
        if (std::abs(normal_N) > is_seen * whole_N) {
            across_.push_back(std::abs(measured.across_N / normal_N));
        }
    }
    [[nodiscard]] UnitQuestions questions(const std::string& table, bool knows_side) const {
        if (whole_.empty()) {
            return {};
        }
        UnitQuestions questions = force_against_law(table, median_of(whole_), median_of(pressures_));
        if (questions.empty() && knows_side && !along_.empty() && !across_.empty()) {
            questions = ask_about_one_force(median_of(along_), median_of(across_));
        }
        return questions;
    }

  private:
    std::vector<double> whole_, along_, across_, pressures_;
};

}  // namespace

double RecordedCutAverages::feed_per_tooth_mm(double flutes) const {
    return feed_mm_s * estimation::turn_rad<double> / (flutes * spindle_rad_s);
}

std::vector<RecordedCutAverages> read_recorded_forces(const std::vector<std::filesystem::path>& recordings,
                                                      const std::vector<StretchConditions>& cuts,
                                                      const firmware::Parameters<float>& parameters,
                                                      const ForceTaker& take) {
    std::vector<RecordedCutAverages> averages(cuts.size());
    const auto counts_per_rev = parameters.machine.encoder_counts_per_rev;
    for (const auto& path : recordings) {
        if (const auto why = angle_in_another_unit(path)) {
            throw InputError(*why);
        }
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
                const FeedForces forces = cut.forces.read(dt_s, reader.sample());
                cut.average.add(time_s, reader.sample(), forces);
                take(cut.place, dt_s, forces);
            }
        }
        for (const RunningCut& cut : running) {
            averages[cut.place] = cut.average.found(counts_per_rev);
        }
    }
    return averages;
}

void refuse_implausible_cuts(const std::vector<StretchConditions>& cuts,
                             const std::vector<RecordedCutAverages>& averages) {
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        const RecordedCutAverages& average = averages[k];
        if (average.spindle_rad_s > 0.0) {
            refuse_implausible_cut(cuts[k].place,
                                   {cuts[k].tool_diameter_mm, average.feed_mm_s,
                                    average.feed_per_tooth_mm(cuts[k].flutes), average.spindle_rad_s},
                                   fmt::format("{}_velocity_mm_s", average.fastest_axis), "spindle_angle_rad");
        }
    }
}

UnitQuestions look_at_recorded_forces(const std::filesystem::path& table, const std::vector<StretchConditions>& cuts,
                                      const std::vector<RecordedCutAverages>& averages,
                                      const firmware::ToolParameters<float>& tool) {
    ForcesOverLaw forces;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        if (averages[k].spindle_rad_s > 0.0) {
            forces.add(averages[k], expected_forces(cuts[k], averages[k].feed_per_tooth_mm(cuts[k].flutes), tool));
        }
    }
    return forces.questions(table.string(), tool.side != estimation::CutSide::unknown);
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
