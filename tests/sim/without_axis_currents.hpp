// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters.hpp"

namespace millforce::test {

/// The controller's files on a machine whose axes' currents nobody reads.
inline firmware::Parameters<float> without_axis_currents(firmware::Parameters<float> parameters) {
    for (auto& axis : parameters.machine.axes) {
        axis.K_x4_N_per_A = 0.0F;
    }
    return parameters;
}

}  // namespace millforce::test
