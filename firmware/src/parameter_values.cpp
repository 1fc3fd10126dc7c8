// SPDX-License-Identifier: Apache-2.0
#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in_impl.hpp"

#include <cstddef>

namespace millforce::firmware {

ParameterValues values_of(const Parameters<float>& parameters) {
    ParameterValues values{};
    std::size_t next = 0;
    for_each_parameter(parameters, [&](const ParameterName& /*name*/, const auto& field, float /*minimum*/,
                                       float /*maximum*/) { values[next++] = static_cast<float>(field); });
    return values;
}

template Parameters<float> parameters_of(const ParameterValues&);
template Parameters<estimation::Fixed> parameters_of(const ParameterValues&);

}  // namespace millforce::firmware
