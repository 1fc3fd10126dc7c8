// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "loop/scenario.hpp"

namespace millforce::sim {

/// By which a blank may lie off, in x and in y. A map is told so much.
inline constexpr double largest_stock_offset_mm = 1.0;

/// How one workpiece on one machine differs from what was drawn and calibrated. A rival and our own tick are told none
/// of it but the latency, which is measured when a machine is put into service.
struct Disturbance {
    double cutting_force_scale = 1.0;  ///< of K_s: 0.7 … 1.3
    double friction_scale = 1.0;       ///< of axes and spindle: 0.8 … 1.2
    double runout_mm = 0.006;          ///< 0 … 20 µm
    double runout_angle_rad = 0.0;
    double current_noise_share = 0.01;  ///< of the rated current, per sample: 0.3 … 3 %
    double override_latency_s = 0.010;  ///< 10 … 100 ms
    double offset_x_mm = 0.0;           ///< of the blank: -1 … 1 mm
    double offset_y_mm = 0.0;
    double oversize = 0.0;  ///< 0 … 10 %: of the deepest cut, by which all tops are higher
};

/// Each uniform in its range. Deterministic in `seed`: all controllers get the same plants.
[[nodiscard]] Disturbance drawn_disturbance(std::uint64_t seed);

/// `deepest_mm`: deepest axial depth of cut. What is cut away down to the part's floor or through it stays so. The true
/// plant's noise is seeded with `seed`.
[[nodiscard]] Scenario disturbed(const Scenario& scenario, const Disturbance& disturbance, double deepest_mm,
                                 std::uint64_t seed);

}  // namespace millforce::sim
