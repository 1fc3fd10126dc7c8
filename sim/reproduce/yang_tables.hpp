// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

/// Published conditions and results of Yang, DeVor & Kapoor (Tables 2–7).

namespace millforce::sim {

struct YangMill {
    std::size_t flutes;
    double helix_deg;
    double diameter_mm;
    double feed_per_tooth_mm;
    std::array<double, 3> nominal_axial_mm;  ///< by type I, II, III (Table 3)
    std::array<double, 3> nominal_radial_mm;
    std::array<double, 5> axial_variation_percent;  ///< by test (Table 4)
    std::array<double, 5> radial_variation_percent;
};

inline constexpr std::array<YangMill, 2> yang_mills = {{
    {4, 30.0, 19.05, 0.0381, {7.62, 20.32, 2.54}, {7.62, 2.54, 15.24}, {-20, 20, -20, 20, -20}, {0, 5, 10, 15, 20}},
    {3, 50.0, 9.525, 0.0254, {3.81, 10.16, 1.27}, {3.81, 1.27, 7.62}, {0, -5, -10, -15, -20}, {20, -20, 20, -20, 20}},
}};

struct YangEstimate {
    double axial_percent;   ///< estimated δADOC
    double radial_percent;  ///< estimated δRDOC
};

/// [type][mill][test], Tables 5, 6 and 7.
inline constexpr std::array<std::array<std::array<YangEstimate, 5>, 2>, 3> yang_estimates = {{
    {{{{{-18.14, -2.40}, {17.86, 6.22}, {-17.46, 8.24}, {22.72, 12.64}, {-17.13, 18.16}}},
      {{{2.44, 18.36}, {-2.65, -22.52}, {-7.98, 17.17}, {-16.11, -18.78}, {-17.66, 17.00}}}}},
    {{{{{-17.93, -1.40}, {22.19, 3.45}, {-17.13, 7.35}, {18.21, 16.08}, {-17.63, 17.77}}},
      {{{0.68, 17.53}, {-2.41, -22.34}, {-8.31, 18.49}, {-12.80, -21.84}, {-17.86, 18.71}}}}},
    {{{{{-17.45, -2.21}, {23.06, 2.27}, {-17.00, 7.51}, {22.86, 11.02}, {-16.12, 17.01}}},
      {{{2.01, 18.28}, {-2.25, -22.03}, {-7.06, 16.31}, {-13.40, -22.82}, {-17.23, 17.39}}}}},
}};

}  // namespace millforce::sim
