// SPDX-License-Identifier: Apache-2.0
#include "minimum_search.hpp"

#include <limits>
#include <numbers>

namespace millforce::estimation {

double place_of_minimum(const std::function<double(double)>& misfit, double low, double high, int steps) {
    const double step = (high - low) / steps;
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k <= steps; ++k) {
        const double here = misfit(low + step * k);
        if (here < least) {
            least = here;
            best = k;
        }
    }
    double left = low + step * (best > 0 ? best - 1 : 0);
    double right = low + step * (best < steps ? best + 1 : steps);
    constexpr double golden = std::numbers::phi - 1.0;
    constexpr int sections = 40;  // 0.618⁴⁰ = 4e-9
    for (int k = 0; k < sections; ++k) {
        const double a = right - golden * (right - left);
        const double b = left + golden * (right - left);
        if (misfit(a) <= misfit(b)) {
            right = b;
        } else {
            left = a;
        }
    }
    return (left + right) / 2.0;
}

}  // namespace millforce::estimation
