// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"
#include "estimation_calibration/current_cutting_fit.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace millforce::host {

/// What `millforce calibrate cutting` was called with.
struct CuttingCalibrationOptions {
    std::vector<std::filesystem::path> data;
    std::filesystem::path output;
    /// Not given: combined, and power for recordings of drives.
    std::optional<estimation::CuttingLawForm> asked_form;
    std::filesystem::path cuts;     ///< table of cuts: `data` are then recordings of drives; see recorded_cuts.hpp
    std::filesystem::path machine;  ///< calibrated drives, for recordings
    /// unknown: the side that fits the forces; see cutting_side.hpp.
    estimation::CutSide side = estimation::CutSide::unknown;

    [[nodiscard]] bool from_currents() const { return !cuts.empty(); }
    [[nodiscard]] estimation::CuttingLawForm form() const {
        return asked_form.value_or(from_currents() ? estimation::CuttingLawForm::power
                                                   : estimation::CuttingLawForm::combined);
    }
};

/// Coefficients of a material and tool from cuts with known conditions and measured torque and force; the fit is
/// estimation::fit_cutting_law. Data: conditions (CSV) with spindle_torque_Nm, normal_force_N, or feed_force_N.
///
/// Or recordings of drive currents, with a table of the cuts in them and a calibrated machine: torque and feed force
/// then come from the currents (forces_of_cuts), and the standard errors include the uncertainty of the gains.
///
/// Rows that repeat another one exactly count once. p_s and p_1 of the power law, K_te and K_re of the linear edge law
/// whose standard error is larger than their value are left out: the fit is made without them, and they are not
/// written. The combined law keeps them near their published values.
///
/// Prints coefficients, scatter, odd cuts, and how well forces of held-out cuts are predicted: each width in turn and
/// each feed in turn, with the two classical laws for comparison. The stated bound is that nine of ten held-out values
/// lie within twice their stated standard deviation.
///
/// Writes a [cutting] table to `output`. Returns 0, or 1 where the bound is broken or a unit is asked for. Throws
/// InputError for bad data, for values that only a wrong unit or sign explains, where the forces scatter by more than
/// 30 %, where there are fewer measured values than parameters and one, and where the cuts cannot determine a
/// parameter: it names the parameter and the missing cut.
int calibrate_cutting(const CuttingCalibrationOptions& options, std::ostream& out);

/// How well held-out cuts are foretold: mean absolute errors, and the share within twice the stated deviation.
struct HeldOutErrors {
    double torque = 0.0;          ///< mean |error|, relative
    double normal_force = 0.0;    ///< mean |error|, relative
    double axial_depth_mm = 0.0;  ///< mean |error| of the depth from the torque, width known
    double within_two_sd = 0.0;   ///< share of torques and normal forces
    std::size_t cuts = 0;
};

/// Fits the cuts without those for which `held_out` is true, and predicts these. NaN where the rest cannot be fitted,
/// or nothing was measured.
HeldOutErrors held_out_errors(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                              estimation::CutSide side, const std::function<bool(const CutRow&)>& held_out,
                              unsigned held_at_zero = 0);

/// Each radial width held out in turn; errors over all of them.
HeldOutErrors leave_one_width_out(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                                  estimation::CutSide side, unsigned held_at_zero = 0);

/// All rows of a conditions file.
std::vector<CutRow> read_conditions(const std::filesystem::path& file);

/// The fit of all cuts on one side. `held_at_zero`: see estimation::CuttingFitOptions.
estimation::CuttingFit fit_cuts(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                                estimation::CutSide side, unsigned held_at_zero = 0);

/// The same for forces from currents: their errors are absolute, and the drives' gains are uncertain.
estimation::CuttingFit fit_cuts_from_currents(const std::vector<CutRow>& cuts, estimation::CuttingLawForm form,
                                              estimation::CutSide side, const estimation::DriveGainDoubt& doubt,
                                              unsigned held_at_zero = 0);

}  // namespace millforce::host
