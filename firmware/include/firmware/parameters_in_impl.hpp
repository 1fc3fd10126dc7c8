// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters_in.hpp"

#include <cstddef>

namespace millforce::firmware {

template <typename Scalar>
Parameters<Scalar> parameters_of(const ParameterValues& values) {
    Parameters<Scalar> parameters;
    std::size_t next = 0;
    for_each_parameter(parameters, [&]<typename Field>(const ParameterName& /*name*/, Field& field, float /*minimum*/,
                                                       float /*maximum*/) { field = field_of<Field>(values[next++]); });
    return parameters;
}

}  // namespace millforce::firmware
