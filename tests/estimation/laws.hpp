// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cutting_law.hpp"

namespace millforce::tests {

/// Kim & Chung Table 2: carbide, 4 flutes, Ø8 mm, SM45C. Known exactly.
template <typename Scalar>
estimation::CuttingLaw<Scalar> carbide_in_SM45C() {
    estimation::CuttingLaw<Scalar> law;
    law.k_s_N_per_mm2 = Scalar(1007.59L);
    law.p_s = Scalar(-0.2557L);
    law.k_1 = Scalar(0.2242L);
    law.p_1 = Scalar(-0.1546L);
    law.K_s_relative_sd = Scalar(0);
    law.r_1_relative_sd = Scalar(0);
    return law;
}

}  // namespace millforce::tests
