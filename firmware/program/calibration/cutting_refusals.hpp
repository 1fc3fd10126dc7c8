// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "calibration/conditions.hpp"
#include "estimation_calibration/cutting_fit.hpp"

#include <string>
#include <string_view>
#include <vector>

/// Cuts from which no law can be fitted, or none that is known well enough.

namespace millforce::host {

/// "linear edge", "power" or "combined".
std::string_view form_name(estimation::CuttingLawForm form);

/// The parameter that the cuts cannot determine, and the cut that is missing; empty where they determine all.
std::string what_the_cuts_lack(const estimation::CuttingFit& fit, estimation::CuttingLawForm form);

/// Throws InputError where there are no more measured values than parameters.
void refuse_too_few_values(const std::string& file, const std::vector<CutRow>& cuts, estimation::CuttingLawForm form);

/// Throws InputError where the fit leaves open what no law can do without, where its forces scatter by more than
/// largest_scatter (cutting_side.hpp), and where they do not scatter at all because the parameters have used them up.
void refuse_vague_law(const std::string& file, const estimation::CuttingFit& fit, estimation::CuttingLawForm form);

}  // namespace millforce::host
