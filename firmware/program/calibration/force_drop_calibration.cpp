// SPDX-License-Identifier: Apache-2.0
#include "calibration/force_drop_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/calibration_report.hpp"
#include "calibration/plausible_units.hpp"
#include "calibration/recorded_forces.hpp"
#include "estimation/force_drop/force_drop.hpp"
#include "estimation_calibration/force_drop_calibration.hpp"
#include "files/atomic_file.hpp"
#include "files/input_error.hpp"
#include "firmware/parameter_fields.hpp"
#include "firmware/wide_band_settings.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

namespace {

using ForceDrop = estimation::ForceDrop<float>;
using DropCalibration = estimation::ForceDropCalibration;
using estimation::CutSide;

constexpr int revolutions_of_a_cut = 8;
constexpr double widest_immersion = 0.95;

double immersion_of(const StretchConditions& cut) {
    return cut.radial_width_mm / (0.5 * cut.tool_diameter_mm);
}

/// One estimate of a cut whose conditions are known.
struct MeasuredCut {
    estimation::ForceDropMeasurement<float> measured;
    double axial_depth_mm = 0.0;
    double radial_immersion = 0.0;
};

/// One cut while it is read: as many estimates of its jump and averages as it is long.
struct KnownCut {
    ForceDrop drop;
    std::vector<estimation::ForceDropMeasurement<float>> measured;
    double path_mm = 0.0;
    double turned_rev = 0.0;
    std::size_t refused = 0;
};

KnownCut known_cut(const StretchConditions& cut, const firmware::Parameters<float>& parameters) {
    if (immersion_of(cut) >= widest_immersion) {
        throw InputError(fmt::format("{}: immersion {:.2f} (radial_width_mm over the radius), expected less than {}",
                                     cut.place, immersion_of(cut), widest_immersion));
    }
    auto settings = firmware::force_drop_settings(parameters);
    settings.revolutions = revolutions_of_a_cut;
    settings.known_immersion = static_cast<float>(immersion_of(cut));
    return {ForceDrop({}, settings), {}};
}

void take_force(KnownCut& cut, float dt_s, const FeedForces& forces, float teeth) {
    if (!forces.valid || forces.is_new_frame) {
        cut.drop.restart();
        cut.path_mm = cut.turned_rev = 0.0;
        if (!forces.valid) {
            return;
        }
    } else {
        cut.path_mm += static_cast<double>(forces.speed_mm_s * dt_s);
        cut.turned_rev += static_cast<double>(forces.turned_rev);
    }
    if (!cut.drop.collect({forces.angle_rev, dt_s, forces.along_N, forces.across_N})) {
        return;
    }
    const double feed_per_tooth_mm = cut.path_mm / std::max(cut.turned_rev * static_cast<double>(teeth), 1e-9);
    cut.drop.evaluate(static_cast<float>(feed_per_tooth_mm));
    const auto& measured = cut.drop.measurement();
    const bool is_there = measured.tooth_x_N.valid && measured.mean_x_N.valid;
    cut.refused += is_there ? 0 : 1;
    if (is_there) {
        cut.measured.push_back(measured);
    }
    cut.path_mm = cut.turned_rev = 0.0;
}

struct KnownCuts {
    std::vector<MeasuredCut> measured;
    UnitQuestions questions;
};

KnownCuts read_known_cuts(const ForceShapeCalibrationOptions& options, const firmware::Parameters<float>& parameters) {
    const auto cuts = cuts_of_tool(options.cuts, options.data, parameters.tool);
    std::vector<KnownCut> known;
    known.reserve(cuts.size());
    for (const StretchConditions& cut : cuts) {
        known.push_back(known_cut(cut, parameters));
    }
    const auto averages =
        read_recorded_forces(options.data, cuts, parameters, [&](std::size_t k, float dt_s, const FeedForces& forces) {
            take_force(known[k], dt_s, forces, parameters.tool.teeth);
        });
    refuse_implausible_cuts(cuts, averages);
    KnownCuts result;
    for (std::size_t k = 0; k < cuts.size(); ++k) {
        if (known[k].measured.empty()) {
            throw InputError(
                fmt::format("{}: no force drop from {} to {} s in {} revolutions that were whole; expected at least {} "
                            "revolutions of a steady cut whose tooth passing the low-pass lets through, with "
                            "spindle_angle_rad in rad",
                            cuts[k].place, cuts[k].start_s, cuts[k].end_s, known[k].refused * revolutions_of_a_cut,
                            revolutions_of_a_cut));
        }
        for (const auto& m : known[k].measured) {
            result.measured.push_back({m, cuts[k].axial_depth_mm, immersion_of(cuts[k])});
        }
    }
    result.questions = look_at_recorded_forces(options.cuts, cuts, averages, parameters.tool);
    return result;
}

bool is_same_cut(const MeasuredCut& a, const MeasuredCut& b) {
    constexpr float same_feed = 0.05F;  // a measured feed varies from estimate to estimate
    return a.radial_immersion == b.radial_immersion && a.axial_depth_mm == b.axial_depth_mm &&
           std::abs(a.measured.feed_per_tooth_mm / b.measured.feed_per_tooth_mm - 1.0F) < same_feed;
}

DropCalibration::Result law_of(const std::vector<MeasuredCut>& cuts, const MeasuredCut* left_out = nullptr) {
    DropCalibration calibration;
    for (const MeasuredCut& cut : cuts) {
        if (left_out == nullptr || !is_same_cut(cut, *left_out)) {
            calibration.add({estimation::in_double(cut.measured), cut.axial_depth_mm, cut.radial_immersion});
        }
    }
    return calibration.solve();
}

std::size_t different_cuts(const std::vector<MeasuredCut>& cuts) {
    std::vector<MeasuredCut> different;
    for (const MeasuredCut& cut : cuts) {
        if (std::none_of(different.begin(), different.end(),
                         [&](const MeasuredCut& other) { return is_same_cut(cut, other); })) {
            different.push_back(cut);
        }
    }
    return different.size();
}

/// How far jumps and averages are from the edge law, relative to the forces: the rows of the fit are weighted by 2 % of
/// the force and their own noise.
double scatter_about_law(const DropCalibration::Result& result) {
    constexpr double unit_of_weights = 0.02;
    return unit_of_weights * result.coefficients.residual_rms;
}

void refuse_what_cuts_lack(const ForceShapeCalibrationOptions& options, const std::vector<MeasuredCut>& cuts,
                           const DropCalibration::Result& result) {
    constexpr std::size_t fewest_cuts = 4;
    constexpr double largest_scatter = 0.25;
    constexpr float least_feed_ratio = 1.5F;
    const auto refuse = [&](std::string_view why) {
        throw InputError(fmt::format("{}: {}", options.cuts.string(), why));
    };
    const auto [thinnest, thickest] =
        std::minmax_element(cuts.begin(), cuts.end(), [](const MeasuredCut& a, const MeasuredCut& b) {
            return a.measured.feed_per_tooth_mm < b.measured.feed_per_tooth_mm;
        });
    const bool feeds_differ =
        thickest->measured.feed_per_tooth_mm >= least_feed_ratio * thinnest->measured.feed_per_tooth_mm;
    if (!feeds_differ) {
        refuse(
            "'e_t_mm' and 'e_r_mm' cannot be determined: all cuts have about the same feed per tooth; expected cuts "
            "whose feeds differ by a factor of 1.5 or more");
    }
    if (const std::size_t different = different_cuts(cuts); different < fewest_cuts) {
        refuse(
            fmt::format("{} cuts of different width, depth or feed; expected at least {}: two widths at two feeds, "
                        "which differ by a factor of 1.5 or more",
                        different, fewest_cuts));
    }
    if (const double scatter = scatter_about_law(result); scatter > largest_scatter || !result.edges_determined) {
        refuse(fmt::format(
            "the forces scatter by {:.0f} % about any cutting law of {} milling; expected less than {:.0f} % and a "
            "force that grows with the chip; are fx_N and fy_N swapped or reversed, or is the tool's side wrong?",
            100.0 * scatter, name(cuts.front().measured.side), 100.0 * largest_scatter));
    }
    if (!result.law.valid) {
        refuse("'b' cannot be determined: fewer than three cuts show their immersion; expected cuts of several widths");
    }
}

/// Each cut by the law fitted to the other cuts: its immersion by the equations, relative to the true one.
struct LeftOut {
    double mean = 0.0;
    double worst = 0.0;
    std::size_t without = 0;
    std::size_t cuts = 0;
};

void refuse_law_without_estimates(const ForceShapeCalibrationOptions& options, const LeftOut& left_out) {
    if (2 * left_out.without > left_out.cuts) {
        throw InputError(
            fmt::format("{}: the law of the other cuts gives no immersion for {} of {}; expected one for most; "
                        "are fx_N and fy_N swapped or reversed, or is a width wrong?",
                        options.cuts.string(), left_out.without, left_out.cuts));
    }
}

/// No narrower than the narrowest cut: what lies below it was not measured.
void keep_to_measured_widths(const std::vector<MeasuredCut>& cuts, estimation::ForceDropLaw<double>& law) {
    const auto narrowest = std::min_element(cuts.begin(), cuts.end(), [](const MeasuredCut& a, const MeasuredCut& b) {
        return a.radial_immersion < b.radial_immersion;
    });
    law.smallest_immersion = std::max(law.smallest_immersion, narrowest->radial_immersion);
}

LeftOut leave_each_out(const std::vector<MeasuredCut>& cuts) {
    LeftOut result;
    for (const MeasuredCut& cut : cuts) {
        const auto law = estimation::in_float(law_of(cuts, &cut).law);
        const auto estimate = estimation::ForceDropImmersion<float>(law).solve(cut.measured);
        ++result.cuts;
        if (!estimate.valid()) {
            ++result.without;
            continue;
        }
        const double error = std::abs(static_cast<double>(estimate.radial_immersion) / cut.radial_immersion - 1.0);
        result.mean += error;
        result.worst = std::max(result.worst, error);
    }
    const std::size_t estimated = result.cuts - result.without;
    result.mean /= static_cast<double>(std::max<std::size_t>(estimated, 1));
    return result;
}

/// Every key of the table but `revolutions`, which is the user's choice.
void write_law(TomlWriter& toml, const estimation::ForceDropLaw<double>& law) {
    firmware::Parameters<float> holder;
    holder.tool.force_drop.law = estimation::in_float(law);
    toml.table("force_drop");
    const auto write = [&toml](const firmware::ParameterName& name, const auto& field, float minimum, float maximum) {
        if (std::string_view(name.table) != "force_drop" || std::string_view(name.key) == "revolutions") {
            return;
        }
        const auto value = static_cast<float>(field);
        if (value < minimum || value > maximum) {
            throw InputError(fmt::format("'{}' comes out as {:g}, expected {:g} to {:g}: these cuts are no tool's",
                                         name.key, value, minimum, maximum));
        }
        toml.key(name.key, static_cast<double>(value));
    };
    firmware::for_each_parameter(holder, write);
}

void print_law(std::ostream& out, const DropCalibration::Result& result) {
    const auto& law = result.law;
    const auto line = [&](const char* name, double value, double sd, const char* unit) {
        out << fmt::format("  {:<8} {:>9.4f} ± {:.4f} {}\n", name, value, sd, unit);
    };
    line("e_t", law.e_t_mm, law.e_t_sd_mm, "mm");
    line("e_r", law.e_r_mm, law.e_r_sd_mm, "mm");
    line("a", law.a, std::sqrt(law.a_b_covariance(0, 0)), result.a_determined ? "" : "(put)");
    line("b", law.b, std::sqrt(law.a_b_covariance(1, 1)), "");
    for (int k = 0; k < 3; ++k) {
        const bool is_put = k > 0 && !result.c_determined;
        line(fmt::format("c_{}", k).c_str(), law.c(k), std::sqrt(law.c_covariance(k, k)), is_put ? "(put)" : "");
    }
}

}  // namespace

int calibrate_force_drop(const ForceShapeCalibrationOptions& options, std::ostream& out) {
    constexpr double largest_error = 0.1;
    auto parameters = read_parameters(options.machine.string(), options.tool.string());
    const CutSide side = parameters.tool.side;
    if (side == CutSide::centred) {
        throw InputError(
            fmt::format("{}: side = \"centred\", expected down, up or unknown: a centred cut has no wall "
                        "whose width the drop shows",
                        options.tool.string()));
    }
    const auto [cuts, questions] = read_known_cuts(options, parameters);
    auto result = law_of(cuts);
    refuse_what_cuts_lack(options, cuts, result);
    const LeftOut left_out = leave_each_out(cuts);
    refuse_law_without_estimates(options, left_out);
    keep_to_measured_widths(cuts, result.law);
    AtomicFile file(options.output);
    TomlWriter toml(file.stream());
    toml.comment("Immersion from force drops: r = a r_av + b, ln(K/K_av) = c_0 + c_1 (1 - R_r) + c_2 ln(f_z/0.15 mm).");
    toml.comment("Fitted from " + list_of_files(options.data));
    write_law(toml, result.law);
    file.commit();
    out << fmt::format("force drops of {} times {} revolutions, {} milling\n", cuts.size(), revolutions_of_a_cut,
                       name(cuts.front().measured.side));
    print_law(out, result);
    out << fmt::format(
        "  jumps and averages scatter by {:.1f} % about the edge law; immersions from {:.3g} to {:.3g}\n",
        100.0 * scatter_about_law(result), result.law.smallest_immersion, result.law.largest_immersion);
    out << fmt::format(
        "  each cut, estimated by the law fitted to the other cuts: immersion off by {:.1f} % on average, {:.1f} % at "
        "most; no "
        "estimate for {} of {}\n",
        100.0 * left_out.mean, 100.0 * left_out.worst, left_out.without, left_out.cuts);
    return ask(out, questions, left_out.worst > largest_error ? exit_bound_broken : exit_done);
}

}  // namespace millforce::host
