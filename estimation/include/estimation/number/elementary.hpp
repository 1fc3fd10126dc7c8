// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>

/// Elementary functions in float that give the same bits on every processor.
///
/// C libraries differ in the last bit of sin or exp, and a controller that is proven on a host by its traces must do
/// the same on the chip. These are made of +, −, ×, ÷ and √ alone, each rounded once (the build forbids contraction).
/// They also have no double-precision steps, which a Cortex-M4F would emulate.
///
/// Use in a template as `using elementary::sin; sin(x)`: float comes here, fixed point to its own functions by ADL, and
/// any other floating-point type to the C library.
///
/// Error in units in the last place, and range: sin, cos 1.5 for |x| ≤ 100 rad (absolute beyond: 1e-7 per 100 rad),
/// tan 4, acos 2, exp 1.5 (0 below −87, infinite above 88.7), log 1.5. NaN gives NaN. Cost on a Cortex-M4F: 25…50
/// instructions. Bodies: src/elementary.cpp.

namespace millforce::estimation::elementary {

float sin(float x);
float cos(float x);
float tan(float x);
float acos(float x);  ///< NaN outside −1…1
float exp(float x);
float log(float x);  ///< −infinity for 0, NaN below

// Other types are a host's, which asks for accuracy and not for the same bits everywhere.
template <std::floating_point Other>
Other sin(Other x) {
    return std::sin(x);
}
template <std::floating_point Other>
Other cos(Other x) {
    return std::cos(x);
}
template <std::floating_point Other>
Other tan(Other x) {
    return std::tan(x);
}
template <std::floating_point Other>
Other acos(Other x) {
    return std::acos(x);
}
template <std::floating_point Other>
Other exp(Other x) {
    return std::exp(x);
}
template <std::floating_point Other>
Other log(Other x) {
    return std::log(x);
}

}  // namespace millforce::estimation::elementary
