// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "firmware/parameter_fields.hpp"

/// Parameters as a list of floats, and in another scalar. For float and estimation::Fixed; other
/// scalars include parameters_in_impl.hpp.

namespace millforce::firmware {

/// In the order of for_each_parameter. Integers are exact: none is above 2^24.
using ParameterValues = std::array<float, parameter_count>;

ParameterValues values_of(const Parameters<float>& parameters);

/// `values` must be within the ranges of their fields.
template <typename Scalar>
Parameters<Scalar> parameters_of(const ParameterValues& values);

/// The same parameters in another scalar.
template <typename Scalar>
Parameters<Scalar> parameters_in(const Parameters<float>& from) {
    return parameters_of<Scalar>(values_of(from));
}
template <>
inline Parameters<float> parameters_in(const Parameters<float>& from) {
    return from;
}

}  // namespace millforce::firmware
