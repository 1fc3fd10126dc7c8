// SPDX-License-Identifier: Apache-2.0
#include "commission/tooth_force_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace millforce::host {

namespace {

// Rules of thumb: sim/scenarios/tools/README.md.
constexpr double core_share = 0.65;
constexpr double safety_of_strength = 3.0;  // flutes are notches, and every tooth is one load cycle
constexpr double share_to_begin_with = 2.0 / 3.0;

/// Total force over that of one tooth, in a slot: the teeth in cut share it; 1.2 for the edges of the others.
double total_over_tooth(int teeth) {
    return 1.2 * std::max(1.0, teeth / 4.0);
}

}  // namespace

double straight_tooth_force_N(const estimation::CuttingLaw<double>& law, double chip_mm, double depth_mm) {
    const double K_s = law.k_s_N_per_mm2 * std::pow(chip_mm, law.p_s);
    const double r_1 = law.k_1 * std::pow(chip_mm, law.p_1);
    return std::hypot(K_s * chip_mm + law.K_te_N_per_mm, r_1 * K_s * chip_mm + law.K_re_N_per_mm) * depth_mm;
}

double feed_for_tooth_force_mm(const estimation::CuttingLaw<double>& law, double force_N, double depth_mm,
                               double largest_mm) {
    double low = 0.0;
    double high = largest_mm;
    if (straight_tooth_force_N(law, high, depth_mm) <= force_N) {
        return high;
    }
    for (int step = 0; step < 50; ++step) {  // the force grows with the chip
        const double middle = 0.5 * (low + high);
        (straight_tooth_force_N(law, middle, depth_mm) > force_N ? high : low) = middle;
    }
    return low;
}

double entry_feed_per_tooth_mm(const ToothForceQuestion& question, double limit_N, double runout_mm) {
    const double chip_mm = feed_for_tooth_force_mm(question.law, limit_N / hardest_batch, question.deepest_cut_mm,
                                                   question.largest_feed_per_tooth_mm);
    const double standing_out_mm = runout_mm * std::sin(std::numbers::pi / std::max(question.teeth, 2));
    return std::max(chip_mm - standing_out_mm, chip_mm / 3.0);
}

ToothForceAdvice advise_tooth_force(const ToothForceQuestion& question) {
    ToothForceAdvice advice;
    const double core_mm = core_share * question.diameter_mm;
    const double lever_mm = question.overhang_mm - 0.5 * question.deepest_cut_mm;
    const double allowed = question.strength_N_per_mm2 / safety_of_strength;
    const double total_N = allowed * std::numbers::pi * std::pow(core_mm, 3) / (32.0 * lever_mm);
    advice.bending_N = total_N / total_over_tooth(question.teeth);
    const double slot_mm = 0.5 * question.diameter_mm;
    advice.makers_feed_N = straight_tooth_force_N(question.law, question.largest_feed_per_tooth_mm, slot_mm);
    advice.advised_N = share_to_begin_with * std::min(advice.bending_N, advice.makers_feed_N);
    advice.reasons = {
        fmt::format("bending: {:.0f} N. Cantilever of the core, {:.3g} mm (0.65 D, rule of thumb: 0.6 to 0.7), force "
                    "at {:.3g} mm from the holder, {:.0f} N/mm² allowed (a third of {:.0f}), shared by the teeth of a "
                    "slot ({:.2g})",
                    advice.bending_N, core_mm, lever_mm, allowed, question.strength_N_per_mm2,
                    total_over_tooth(question.teeth)),
        fmt::format("maker's feed: {:.0f} N. A slot {:.3g} mm deep (0.5 D) at {:.3g} mm per tooth, by the file's "
                    "cutting law",
                    advice.makers_feed_N, slot_mm, question.largest_feed_per_tooth_mm),
        fmt::format("advised: {:.0f} N, two thirds of the smaller: a worn edge withstands less", advice.advised_N),
    };
    return advice;
}

}  // namespace millforce::host
