// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>

#include "firmware/parameter_table.hpp"

namespace millforce::firmware {

/// The same parameters in another scalar, by the parameter table.
template <typename Scalar>
Parameters<Scalar> parameters_in(Parameters<float> from) {
    if constexpr (std::is_same_v<Scalar, float>) {
        return from;
    } else {
        Parameters<Scalar> to;
        for (std::size_t row = 0; row < parameter_table<float>.size(); ++row) {
            for (std::size_t axis = 0; axis < axis_tables.size(); ++axis) {
                parameter_table<Scalar>[row].field(to, axis) = Scalar(parameter_table<float>[row].field(from, axis));
            }
        }
        return to;
    }
}

}  // namespace millforce::firmware
