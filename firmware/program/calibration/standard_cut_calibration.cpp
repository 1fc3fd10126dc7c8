// SPDX-License-Identifier: Apache-2.0
#include "calibration/standard_cut_calibration.hpp"

#include "calibration/calibration_report.hpp"
#include "calibration/coefficient_library.hpp"
#include "calibration/plausible_drives.hpp"
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/parameter_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace millforce::host {

namespace {

using estimation::DriveGainFit;
using estimation::StandardCutLack;
using Stretch = estimation::StandardCutStretch;

const CalibrationKey K_t1_key = key_of("spindle", "K_t1_Nm_per_A");
const CalibrationKey K_t2_key = key_of("spindle", "K_t2_Nm");
const CalibrationKey K_x4_key = key_of("axis", "K_x4_N_per_A");
const CalibrationKey K_x5_key = key_of("axis", "K_x5_N_m_per_min");
const CalibrationKey spindle_doubt_key = key_of("spindle", "gain_relative_sd");
const CalibrationKey axis_doubt_key = key_of("axis", "gain_relative_sd");

estimation::AverageForces<double> known_forces(const RecordedStretch& stretch,
                                               const estimation::CuttingLaw<double>& law, estimation::CutSide side) {
    const StretchConditions& c = stretch.conditions;
    if (!c.in_cut()) {
        return {};
    }
    const double immersion = c.radial_width_mm / (0.5 * c.tool_diameter_mm);
    return estimation::average_forces<double>(
        law, {stretch.feed_per_tooth_mm(), c.axial_depth_mm, estimation::engagement_angles(side, immersion),
              static_cast<double>(c.flutes)});
}

/// How cold the bearing still is: by the machine's warm-up time, or the share of the recording that is to come.
double drift_of(const RecordedStretch& stretch, double last_s, const MachineParameters& machine) {
    const double tau_s = static_cast<double>(machine.spindle.warm_up_time_s);
    return tau_s > 0.0 ? std::exp(-stretch.middle_s / tau_s) : (last_s - stretch.middle_s) / std::max(last_s, 1.0);
}

Stretch fit_row(const RecordedStretch& stretch, double last_s, const MachineParameters& machine,
                const estimation::CuttingLaw<double>& law, estimation::CutSide side) {
    const auto forces = known_forces(stretch, law, side);
    const auto& axis = machine.axes[stretch.axis];
    const double direction = stretch.feed_mm_s > 0.0 ? 1.0 : -1.0;
    const double per_full_gain =
        static_cast<double>(machine.spindle.K_t1_Nm_per_A) / spindle_gain_Nm_per_A(machine, stretch.spindle_rad_s);
    Stretch row;
    // Above the base speed an ampere gives less torque: the current that would give it below.
    row.spindle_current_A = stretch.spindle_current_A / per_full_gain;
    row.torque_Nm = forces.tangential_N * 0.5e-3 * stretch.conditions.tool_diameter_mm +
                    static_cast<double>(machine.spindle.idle_torque_slope_Nm_s) * stretch.spindle_rad_s;
    row.drift = drift_of(stretch, last_s, machine);
    row.feed_m_per_min = stretch.feed_m_per_min();
    row.friction_current_A = signed_friction_current_A(machine, stretch.axis, row.feed_m_per_min);
    row.feed_current_A = stretch.axis_current_A - static_cast<double>(axis.gravity_A);
    row.feed_force_N = direction * forces.feed_N;
    row.weight = std::sqrt(stretch.duration_s);
    row.in_cut = stretch.conditions.in_cut();
    return row;
}

/// Gains of the recordings so far and of one more, by their standard errors. One that lacks something adds nothing.
void merge(DriveGainFit& all, const DriveGainFit& next) {
    if (all.rows == 0) {
        all = next;
        return;
    }
    if (next.rows == 0) {
        return;
    }
    const double w_all = 1.0 / (all.gain_se * all.gain_se);
    const double w_next = 1.0 / (next.gain_se * next.gain_se);
    DriveGainFit merged = next;
    merged.gain = (w_all * all.gain + w_next * next.gain) / (w_all + w_next);
    merged.gain_se = 1.0 / std::sqrt(w_all + w_next);
    merged.rows = all.rows + next.rows;
    all = merged;
}

std::string missing(StandardCutLack lack, std::string_view gain, std::string_view offset) {
    switch (lack) {
        case StandardCutLack::cut:
            return fmt::format(
                "'{}' cannot be determined: the table has no cut; expected standard cuts of two widths or "
                "feeds, with running in air between them",
                gain);
        case StandardCutLack::air:
            return fmt::format(
                "'{}' cannot be determined: no row in air; expected one at the feed of each cut "
                "(axial_depth_mm 0)",
                offset);
        case StandardCutLack::second_load:
            return fmt::format(
                "'{}' cannot be determined: all cuts have about the same force; expected a cut of twice "
                "the radial width",
                gain);
        case StandardCutLack::second_feed:
            return fmt::format(
                "'{}' cannot be determined: all cuts have about the same feed; expected a cut at twice or "
                "half the feed",
                offset);
        case StandardCutLack::rows:
            return fmt::format("'{}' has no standard error: too few rows; expected one more cut", gain);
        case StandardCutLack::response:
            return fmt::format(
                "'{}' cannot be determined: the current does not follow the force beyond its noise; "
                "expected wider cuts, or longer ones",
                gain);
        case StandardCutLack::nothing:
            break;
    }
    return {};
}

void refuse_what_cuts_lack(const StandardCutOptions& options, const StandardCutGains& gains) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(fmt::format("{}: {}", options.cuts.string(), why));
    };
    if (gains.spindle.lack != StandardCutLack::nothing) {
        refuse(missing(gains.spindle.lack, K_t1_key.name, K_t2_key.name));
    }
    for (std::size_t k = 0; k < gains.axes.size(); ++k) {
        if (gains.axes[k] && gains.axes[k]->lack != StandardCutLack::nothing) {
            refuse(missing(gains.axes[k]->lack, fmt::format("{}.{}", axis_tables[k], K_x4_key.name),
                           fmt::format("{}.{}", axis_tables[k], K_x5_key.name)));
        }
    }
}

/// Gains that no drive has.
void refuse_implausible_gains(const StandardCutOptions& options, const StandardCutGains& gains) {
    constexpr double least_Nm_per_A = 0.003;
    constexpr double least_N_per_A = 1.0;
    const auto refuse_small = [&](std::string_view key, double gain, double least, std::string_view column) {
        if (gain < least) {
            throw InputError(
                fmt::format("{}: '{}' = {:.3g}; expected {:g} or more; is {} in mA, or a depth or width in m?",
                            options.cuts.string(), key, gain, least, column));
        }
    };
    refuse_small(K_t1_key.name, gains.spindle.gain, least_Nm_per_A, "spindle_current_A");
    for (std::size_t k = 0; k < gains.axes.size(); ++k) {
        if (gains.axes[k]) {
            refuse_small(fmt::format("{}.{}", axis_tables[k], K_x4_key.name), gains.axes[k]->gain, least_N_per_A,
                         fmt::format("{}_current_A", axis_tables[k]));
        }
    }
}

UnitQuestions questions_about_gains(const MachineParameters& machine, const StandardCutGains& gains) {
    UnitQuestions questions =
        ask_about_gain(K_t1_key.name, gains.spindle.gain, static_cast<double>(machine.spindle.K_t1_Nm_per_A));
    for (std::size_t k = 0; k < gains.axes.size(); ++k) {
        if (gains.axes[k]) {
            append(questions, ask_about_gain(fmt::format("{}.{}", axis_tables[k], K_x4_key.name), gains.axes[k]->gain,
                                             static_cast<double>(machine.axes[k].K_x4_N_per_A)));
        }
    }
    return questions;
}

/// Prints and writes one drive's gain and offset, and the uncertainty of the gain.
void report(std::ostream& out, TomlWriter& toml, const DriveGainFit& fit, std::array<CalibrationKey, 3> keys,
            double database_sd, const std::optional<FittedValue>& left_out = std::nullopt) {
    std::vector<FittedValue> written{{keys[0], fit.gain, fit.gain_se}};
    if (!left_out) {
        written.push_back({keys[1], fit.offset, fit.offset_se});
    }
    for (const FittedValue& fitted : written) {
        print_fitted(out, fitted);
        write_fitted(toml, fitted);
    }
    if (left_out) {
        print_left_out(out, *left_out);
    }
    const double doubt = std::hypot(fit.gain_se / fit.gain, database_sd);
    toml.key(keys[2].name, doubt);
    out << fmt::format("  {} rows, residual {:.3g} A; with the database's doubt the gain is known to {:.1f} %\n",
                       fit.rows, fit.residual_A, 100.0 * doubt);
}

/// Doubt of the forces by the database: of F_at, and of F_ax at its largest over the cuts.
struct DatabaseDoubt {
    double tangential = 0.0;
    double feed = 0.0;
};

DatabaseDoubt database_doubt(const std::vector<RecordedStretch>& stretches, const estimation::CuttingLaw<double>& law,
                             estimation::CutSide side) {
    DatabaseDoubt doubt{law.K_s_relative_sd, law.K_s_relative_sd};
    for (const RecordedStretch& stretch : stretches) {
        const StretchConditions& c = stretch.conditions;
        if (c.in_cut()) {
            const double immersion = c.radial_width_mm / (0.5 * c.tool_diameter_mm);
            const auto forces = estimation::average_forces_with_doubt<double>(
                law, {stretch.feed_per_tooth_mm(), c.axial_depth_mm, estimation::engagement_angles(side, immersion),
                      static_cast<double>(c.flutes)});
            doubt.feed = std::max(doubt.feed, forces.standard_deviation.feed_N / std::abs(forces.mean.feed_N));
        }
    }
    return doubt;
}

}  // namespace

StandardCutGains standard_cut_gains(const std::vector<RecordedStretch>& stretches, const MachineParameters& machine,
                                    const estimation::CuttingLaw<double>& law, estimation::CutSide side) {
    std::vector<std::string> recordings;
    std::array<std::vector<Stretch>, 3> by_axis;
    StandardCutGains gains;
    for (const RecordedStretch& stretch : stretches) {
        if (std::find(recordings.begin(), recordings.end(), stretch.conditions.recording) == recordings.end()) {
            recordings.push_back(stretch.conditions.recording);
        }
    }
    for (const std::string& recording : recordings) {
        double last_s = 0.0;
        for (const RecordedStretch& stretch : stretches) {
            last_s = stretch.conditions.recording == recording ? std::max(last_s, stretch.middle_s) : last_s;
        }
        std::vector<Stretch> rows;
        for (const RecordedStretch& stretch : stretches) {
            if (stretch.conditions.recording == recording) {
                rows.push_back(fit_row(stretch, last_s, machine, law, side));
                by_axis[stretch.axis].push_back(rows.back());
            }
        }
        merge(gains.spindle, estimation::fit_spindle_gain(rows));
    }
    for (std::size_t k = 0; k < by_axis.size(); ++k) {
        if (!by_axis[k].empty()) {
            gains.axes[k] = estimation::fit_feed_gain(by_axis[k]);
        }
    }
    return gains;
}

void leave_out_vague_K_x5(StandardCutGains& gains, const std::vector<RecordedStretch>& stretches,
                          const MachineParameters& machine, const estimation::CuttingLaw<double>& law,
                          estimation::CutSide side) {
    for (std::size_t k = 0; k < gains.axes.size(); ++k) {
        auto& fit = gains.axes[k];
        if (!fit || fit->lack != StandardCutLack::nothing || fit->offset_se < std::abs(fit->offset)) {
            continue;
        }
        std::vector<Stretch> rows;
        for (const RecordedStretch& stretch : stretches) {
            if (stretch.axis == k) {
                rows.push_back(fit_row(stretch, stretch.middle_s, machine, law, side));  // drift is the spindle's alone
            }
        }
        gains.left_out_K_x5[k] = FittedValue{K_x5_key, fit->offset, fit->offset_se};
        fit = estimation::fit_feed_gain(rows, {.fits_K_x5 = false});
    }
}

int calibrate_standard_cut(const StandardCutOptions& options, std::ostream& out) {
    if (options.data.empty()) {
        throw InputError("calibrate standard-cut: no data file; expected at least one recording (CSV)");
    }
    const LibraryEntry entry = library_entry(options.database, options.entry);
    const MachineParameters machine = read_machine_parameters(options.machine.string());
    const auto stretches = read_recorded_cuts(options.data, options.cuts);
    for (const RecordedStretch& stretch : stretches) {
        refuse_below_velocity_floor(stretch, machine);
    }
    StandardCutGains gains = standard_cut_gains(stretches, machine, entry.law, options.side);
    leave_out_vague_K_x5(gains, stretches, machine, entry.law, options.side);
    refuse_what_cuts_lack(options, gains);
    refuse_implausible_gains(options, gains);
    const DatabaseDoubt doubt = database_doubt(stretches, entry.law, options.side);

    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Gains of the drives from standard cuts: T = K_t1 I + K_t2, F = K_x4 (I - I_f) + K_x5/w.");
    toml.comment("Fitted from " + list_of_files(options.data));
    toml.comment(fmt::format("Forces by {}: {}", entry.name, entry.source));
    toml.table("spindle");
    out << fmt::format("forces by {} ({})\nspindle: T = K_t1 I + K_t2\n", entry.name, entry.source);
    report(out, toml, gains.spindle, {K_t1_key, K_t2_key, spindle_doubt_key}, doubt.tangential);
    for (std::size_t k = 0; k < gains.axes.size(); ++k) {
        if (gains.axes[k]) {
            toml.table(axis_tables[k]);
            out << fmt::format("{}: F = K_x4 (I − I_f) + K_x5/w, friction {:.3f} ± {:.3f} of the machine file's\n",
                               axis_tables[k], gains.axes[k]->nuisance, gains.axes[k]->nuisance_se);
            report(out, toml, *gains.axes[k], {K_x4_key, K_x5_key, axis_doubt_key}, doubt.feed, gains.left_out_K_x5[k]);
        }
    }
    file.commit();
    return ask(out, questions_about_gains(machine, gains), exit_done);
}

}  // namespace millforce::host
