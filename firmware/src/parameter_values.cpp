// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in.hpp"

#include <cstddef>

namespace millforce::firmware {

ParameterValues values_of(const Parameters<float>& parameters) {
    ParameterValues values{};
    std::size_t next = 0;
    for_each_parameter(parameters, [&](const ParameterName& /*name*/, const auto& field, float /*minimum*/,
                                       float /*maximum*/) { values[next++] = static_cast<float>(field); });
    return values;
}

template <typename Scalar>
Parameters<Scalar> parameters_of(const ParameterValues& values) {
    Parameters<Scalar> parameters;
    std::size_t next = 0;
    for_each_parameter(parameters, [&]<typename Field>(const ParameterName& /*name*/, Field& field, float /*minimum*/,
                                                       float /*maximum*/) { field = field_of<Field>(values[next++]); });
    return parameters;
}

template Parameters<float> parameters_of(const ParameterValues&);
template Parameters<estimation::Fixed> parameters_of(const ParameterValues&);

}  // namespace millforce::firmware
