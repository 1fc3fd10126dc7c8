// SPDX-License-Identifier: Apache-2.0
#include "calibration/cutting_calibration.hpp"

#include <cmath>
#include <set>

namespace millforce::host {

namespace {

/// Sums over held-out cuts.
struct Sums {
    double torque = 0.0, normal_force = 0.0, depth = 0.0;
    double torques = 0.0, normal_forces = 0.0, within = 0.0;
    std::size_t cuts = 0;
    bool fitted = true;

    HeldOutErrors errors() const {
        if (!fitted || torques + normal_forces == 0.0) {
            return {no_estimate, no_estimate, no_estimate, no_estimate, cuts};
        }
        return {torque / torques, normal_force / normal_forces, depth / torques, within / (torques + normal_forces),
                cuts};
    }
};

void add(Sums& sums, const CutRow& row, const estimation::CuttingLaw<double>& law, estimation::CutSide side) {
    const auto measured = row.measurement(side);
    const auto forces = estimation::average_forces_with_doubt(law, measured.cut);
    if (std::isfinite(measured.tangential_N)) {
        const double error = forces.mean.tangential_N - measured.tangential_N;
        sums.torque += std::abs(error / measured.tangential_N);
        // The force is proportional to the axial depth.
        const double depth_mm = row.axial_depth_mm * measured.tangential_N / forces.mean.tangential_N;
        sums.depth += std::abs(depth_mm - row.axial_depth_mm);
        sums.torques += 1.0;
        sums.within += std::abs(error) <= 2.0 * forces.standard_deviation.tangential_N ? 1.0 : 0.0;
    }
    if (std::isfinite(measured.normal_N)) {
        const double error = forces.mean.normal_N - measured.normal_N;
        sums.normal_force += std::abs(error / measured.normal_N);
        sums.normal_forces += 1.0;
        sums.within += std::abs(error) <= 2.0 * forces.standard_deviation.normal_N ? 1.0 : 0.0;
    }
    ++sums.cuts;
}

std::vector<estimation::CuttingMeasurement> measurements_of(const std::vector<CutRow>& cuts, estimation::CutSide side) {
    std::vector<estimation::CuttingMeasurement> measurements;
    measurements.reserve(cuts.size());
    for (const CutRow& row : cuts) {
        measurements.push_back(row.measurement(side));
    }
    return measurements;
}

void hold_out(Sums& sums, const std::vector<CutRow>& cuts, estimation::CuttingLawForm form, estimation::CutSide side,
              const std::function<bool(const CutRow&)>& held_out, unsigned held_at_zero) {
    std::vector<CutRow> kept;
    for (const CutRow& row : cuts) {
        if (!held_out(row)) {
            kept.push_back(row);
        }
    }
    const auto fit = fit_cuts(kept, form, side, held_at_zero);
    if (fit.undetermined != 0U || !fit.converged) {
        sums.fitted = false;
        return;
    }
    for (const CutRow& row : cuts) {
        if (held_out(row)) {
            add(sums, row, fit.law, side);
        }
    }
}

}  // namespace

std::vector<CutRow> read_conditions(const std::filesystem::path& file) {
    ConditionsReader reader(file);
    std::vector<CutRow> rows;
    CutRow row;
    while (reader.next(row)) {
        rows.push_back(row);
    }
    return rows;
}

estimation::CuttingFit fit_cuts(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                                estimation::CutSide side, unsigned held_at_zero) {
    const auto measurements = measurements_of(cuts, side);
    estimation::CuttingFitOptions options;
    options.form = form;
    options.held_at_zero = held_at_zero;
    return estimation::fit_cutting_law(measurements, options);
}

estimation::CuttingFit fit_cuts_from_currents(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                                              estimation::CutSide side, const estimation::DriveGainDoubt& doubt,
                                              unsigned held_at_zero) {
    const auto measurements = measurements_of(cuts, side);
    estimation::CuttingFitOptions options;
    options.form = form;
    options.held_at_zero = held_at_zero;
    // Noise, idle torque and friction are wrong by newtons, whatever the cut: not by a share of its force.
    options.error_floor = 1.0;
    return estimation::fit_cutting_law_from_currents(measurements, doubt, options);
}

HeldOutErrors held_out_errors(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                              estimation::CutSide side, const std::function<bool(const CutRow&)>& held_out,
                              unsigned held_at_zero) {
    Sums sums;
    hold_out(sums, cuts, form, side, held_out, held_at_zero);
    return sums.errors();
}

HeldOutErrors leave_one_width_out(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                                  estimation::CutSide side, unsigned held_at_zero) {
    std::set<double> widths;
    for (const CutRow& row : cuts) {
        widths.insert(row.radial_width_mm);
    }
    Sums sums;
    for (const double width : widths) {
        hold_out(
            sums, cuts, form, side, [width](const CutRow& row) { return row.radial_width_mm == width; }, held_at_zero);
    }
    return sums.errors();
}

}  // namespace millforce::host
