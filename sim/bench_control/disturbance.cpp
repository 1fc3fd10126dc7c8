// SPDX-License-Identifier: Apache-2.0
#include "bench_control/disturbance.hpp"

#include <numbers>
#include <random>

#include "bench_control/drawn_within.hpp"

namespace millforce::sim {

namespace {

void raise(double& top_mm, double deepest_mm, double oversize) {
    if (top_mm > -deepest_mm + 1e-9) {
        top_mm += oversize * deepest_mm;
    }
}

}  // namespace

Disturbance drawn_disturbance(std::uint64_t seed) {
    std::seed_seq mixed{seed, std::uint64_t{0x51ed270b}};
    std::mt19937_64 random(mixed);
    const auto within = [&](double low, double high) { return drawn_within(low, high, random); };
    Disturbance d;
    d.cutting_force_scale = within(0.7, 1.3);
    d.friction_scale = within(0.8, 1.2);
    d.runout_mm = within(0.0, 0.020);
    d.runout_angle_rad = within(0.0, 2.0 * std::numbers::pi);
    d.current_noise_share = within(0.003, 0.03);
    d.override_latency_s = within(0.010, 0.100);
    d.offset_x_mm = within(-largest_stock_offset_mm, largest_stock_offset_mm);
    d.offset_y_mm = within(-largest_stock_offset_mm, largest_stock_offset_mm);
    d.oversize = within(0.0, 0.1);
    return d;
}

Scenario disturbed(const Scenario& scenario, const Disturbance& d, double deepest_mm, std::uint64_t seed) {
    Scenario result = scenario;
    result.seed = seed;
    result.deviation.cutting_force_scale = d.cutting_force_scale;
    result.deviation.friction_scale = d.friction_scale;
    result.deviation.current_noise_share = d.current_noise_share;
    result.cutter.runout_mm = d.runout_mm;
    result.cutter.runout_angle_rad = d.runout_angle_rad;
    result.parameters.machine.cnc.override_latency_s = static_cast<float>(d.override_latency_s);
    StockSettings& stock = result.stock;
    stock.move_by(d.offset_x_mm, d.offset_y_mm);
    raise(stock.block.top_start_mm, deepest_mm, d.oversize);
    raise(stock.block.top_end_mm, deepest_mm, d.oversize);
    for (StockBox& box : stock.boxes) {
        raise(box.top_start_mm, deepest_mm, d.oversize);
        raise(box.top_end_mm, deepest_mm, d.oversize);
    }
    return result;
}

}  // namespace millforce::sim
