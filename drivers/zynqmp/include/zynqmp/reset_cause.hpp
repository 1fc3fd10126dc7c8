// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hal/reset_cause.hpp"
#include "zynqmp/registers.hpp"

namespace millforce::zynqmp {

/// Reads RESET_REASON and clears it, so that the next start reports its own cause. A system reset by the error logic
/// counts as the watchdog's: the register does not say which error it was. A power-on reset by the error logic is
/// `unknown`. UG1087 module CRL_APB
hal::ResetCause take_reset_cause(Register& reset_reason);

}  // namespace millforce::zynqmp
