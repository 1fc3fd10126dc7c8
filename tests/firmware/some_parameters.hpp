// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <type_traits>

#include "firmware/parameters_in.hpp"

/// Parameters within their ranges, for tests of what stores and copies them.

namespace millforce::test {

/// The defaults, and something for the keys that a file must give.
inline firmware::Parameters<float> complete_parameters() {
    firmware::Parameters<float> parameters;
    firmware::for_each_parameter(parameters, []<typename Field>(const firmware::ParameterName& /*name*/, Field& field,
                                                                float minimum, float maximum) {
        const auto value = static_cast<float>(field);
        if (value < minimum || value > maximum) {
            field = firmware::field_of<Field>(0.5F * (minimum + maximum));
        }
    });
    return parameters;
}

/// Another value for each field of a table; Fixed holds all of them.
inline firmware::Parameters<float> distinct_parameters() {
    firmware::Parameters<float> parameters;
    float step = 0.0F;
    firmware::for_each_parameter(parameters, [&step]<typename Field>(const firmware::ParameterName& /*name*/,
                                                                     Field& field, float minimum, float maximum) {
        step += 1.0F;
        const float width = std::min(maximum - minimum, 1000.0F);
        const float share = step / static_cast<float>(firmware::parameter_count + 1);
        if constexpr (std::is_same_v<Field, float>) {
            field = minimum + width * share;
        } else {
            const float values = width + 1.0F;
            field = firmware::field_of<Field>(minimum + step -
                                              values * static_cast<float>(static_cast<int>(step / values)));
        }
    });
    return parameters;
}

/// The key of the first field in which two sets differ by more than `relative`; empty where there is none.
inline const char* first_difference(const firmware::ParameterValues& a, const firmware::ParameterValues& b,
                                    float relative = 0.0F) {
    const firmware::Parameters<float> names;
    const char* found = "";
    std::size_t next = 0;
    firmware::for_each_parameter(
        names, [&](const firmware::ParameterName& name, const auto& /*field*/, float /*minimum*/, float /*maximum*/) {
            const float difference = a[next] - b[next];
            const float largest = relative * (a[next] < 0.0F ? -a[next] : a[next]);
            if (*found == '\0' && !(difference <= largest && -difference <= largest)) {
                found = name.key;
            }
            ++next;
        });
    return found;
}

}  // namespace millforce::test
