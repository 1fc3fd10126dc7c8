// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calibration/axis_motion.hpp"
#include "commission/commission.hpp"
#include "commission/idle_watch.hpp"
#include "commission/session.hpp"
#include "commission/validation.hpp"
#include "report/page_origin.hpp"

namespace millforce::host {

/// What the page of a commissioning shows.
struct CommissionPage {
    Facts facts;
    std::vector<StepVerdict> verdicts;
    std::vector<IdlePlateau> idle;
    std::optional<IdleFit> idle_fit;
    std::vector<std::pair<std::string, std::vector<SteadyFeed>>> air;  ///< by axis
    std::optional<MachineParameters> machine;                          ///< with the fitted friction
    std::vector<ValidatedCut> validated;
    std::vector<std::string> files;  ///< of the session: fits with their standard errors
};

/// One self-contained page without a script: each step with its verdict, every fitted value with its standard error,
/// the measured points, and the cuts that validated them.
std::string page_text(const CommissionPage& page, const Session& session);

}  // namespace millforce::host
