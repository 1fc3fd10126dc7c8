// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_refusals.hpp"

#include "calibration/cutting_side.hpp"
#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace millforce::host {

namespace {

using estimation::CuttingFit;
using estimation::CuttingLawForm;

std::size_t parameters_of(CuttingLawForm form) {
    return form == CuttingLawForm::combined ? 6 : 4;
}

/// With as many parameters as values of one kind, the fit can go through all of them.
void refuse_vanished_scatter(const std::string& file, const CuttingFit& fit) {
    constexpr double few_degrees_of_freedom = 10.0;
    constexpr double no_scatter = 5e-4;  // no force is measured so well: the parameters have used up these forces
    const std::array<std::pair<std::string_view, estimation::CuttingScatter>, 3> channels{
        {{"torques", fit.tangential}, {"feed forces", fit.feed}, {"normal forces", fit.normal}}};
    for (const auto& [name, channel] : channels) {
        if (channel.cuts > 0 && channel.robust_sd < no_scatter && fit.degrees_of_freedom < few_degrees_of_freedom) {
            throw InputError(fmt::format(
                "{}: the {} of {} cuts fit without any scatter, so that their errors are not known; expected "
                "more cuts",
                file, name, channel.cuts));
        }
    }
}

void refuse_large_scatter(const std::string& file, const CuttingFit& fit) {
    constexpr double beyond_any_tool = 1.0;
    const double scatter = std::max(fit.tangential.robust_sd, plane_scatter(fit));
    if (scatter > largest_scatter) {
        throw InputError(fmt::format(
            "{}: the {} scatter by {:.1f} % about the law; expected less than {:.0f} %, from cuts "
            "of one tool and material{}",
            file, fit.tangential.robust_sd == scatter ? "torques" : "forces", 100.0 * scatter, 100.0 * largest_scatter,
            scatter > beyond_any_tool
                ? "; do torque and force contradict each other because one is in another unit (daN, kgf)?"
                : ""));
    }
}

void refuse_open_deviations(const std::string& file, const estimation::CuttingLaw<double>& law) {
    for (const double deviation :
         {law.K_s_relative_sd, law.K_s_exponent_sd, law.r_1_relative_sd, law.r_1_exponent_sd}) {
        constexpr double largest_deviation = 2.0;  // that the parameter files allow
        if (!(deviation < largest_deviation)) {
            throw InputError(fmt::format(
                "{}: the cuts leave '{}' open: a standard deviation of {:.2g} in its logarithm; "
                "expected less than {:g}, from cuts at more feeds and widths",
                file, deviation == law.K_s_relative_sd || deviation == law.K_s_exponent_sd ? "k_s_N_per_mm2" : "k_1",
                deviation, largest_deviation));
        }
    }
}

}  // namespace

std::string_view form_name(CuttingLawForm form) {
    switch (form) {
        case CuttingLawForm::linear_edge:
            return "linear edge";
        case CuttingLawForm::power:
            return "power";
        case CuttingLawForm::combined:
            break;
    }
    return "combined";
}

std::string what_the_cuts_lack(const CuttingFit& fit, CuttingLawForm form) {
    const auto lacks = [&](int j) { return !fit.determined(j); };
    if (form != CuttingLawForm::power && fit.maximum_feed_per_tooth_mm <= 1.2 * fit.minimum_feed_per_tooth_mm &&
        lacks(estimation::cutting_K_te)) {
        return fmt::format(
            "'K_te_N_per_mm' cannot be separated from 'k_s_N_per_mm2': all cuts have about {:.4g} mm feed per "
            "tooth; expected cuts at a second feed, larger or smaller by half",
            fit.maximum_feed_per_tooth_mm);
    }
    if (lacks(estimation::cutting_ln_K_s)) {
        return "'k_s_N_per_mm2' cannot be determined: the torques and forces do not grow with the chip; expected cuts "
               "with measured spindle_torque_Nm";
    }
    if (lacks(estimation::cutting_r_1)) {
        return "'k_1' cannot be determined: the forces hold nothing of the radial force (slots have none along the "
               "normal); expected side cuts with normal_force_N, or feed_force_N";
    }
    if (lacks(estimation::cutting_p_s)) {
        return "'p_s' cannot be determined: all chips are equally thick; expected cuts at a second feed";
    }
    return {};
}

void refuse_too_few_values(const std::string& file, const std::vector<CutRow>& cuts, CuttingLawForm form) {
    std::size_t values = 0;
    for (const CutRow& row : cuts) {
        for (const double force : {row.spindle_torque_Nm, row.normal_force_N, row.feed_force_N}) {
            values += std::isfinite(force) ? 1U : 0U;
        }
    }
    const std::size_t parameters = parameters_of(form);
    if (values <= parameters) {
        throw InputError(
            fmt::format("{}: {} cuts with {} measured values for the {} parameters of the {} law; expected at least "
                        "{} values, from cuts at two feeds and several widths",
                        file, cuts.size(), values, parameters, form_name(form), parameters + 1));
    }
}

void refuse_vague_law(const std::string& file, const CuttingFit& fit, CuttingLawForm form) {
    const std::string lack = what_the_cuts_lack(fit, form);
    if (!lack.empty()) {
        throw InputError(fmt::format("{}: {}", file, lack));
    }
    const double r_1 = fit.parameters(estimation::cutting_r_1);
    if (!(fit.standard_error(estimation::cutting_r_1) < std::abs(r_1))) {
        throw InputError(
            fmt::format("{}: 'k_1' cannot be determined: r_1 = {:.3g} ± {:.3g}; expected side cuts at more "
                        "feeds and widths",
                        file, r_1, fit.standard_error(estimation::cutting_r_1)));
    }
    refuse_vanished_scatter(file, fit);
    refuse_large_scatter(file, fit);
    refuse_open_deviations(file, fit.law);
}

}  // namespace millforce::host
