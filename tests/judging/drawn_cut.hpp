// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameters.hpp"
#include "judging/true_cut.hpp"

#include <array>
#include <cstdint>

/// Straight cuts drawn at random, on a machine whose true values differ from its files by what the files state, and
/// with one assumption of them wrong.

namespace millforce::judging {

/// What the tick is given, or what a signal says, against the truth.
enum class Wrong : std::uint8_t {
    nothing,            ///< the side is declared
    nothing_stated,     ///< the side is not declared
    side,               ///< the other side is declared
    x_friction,         ///< 360 N more friction on x, from contact on
    x_reversed,         ///< x's current with the other sign
    x_dead,             ///< x's current is 0
    x_tenfold,          ///< x's current × 10
    axes_swapped,       ///< the currents of x and y
    spindle_weak,       ///< the spindle's current × 0.3
    spindle_frozen,     ///< the spindle's current stays as it was in air
    spindle_saturated,  ///< the spindle's current never above 1.5 times its idle value
    edge_forces,        ///< the tool's file has none
    material,           ///< twice as hard at a chip of 0.05 mm, harder at thinner ones, and r_1 × 1.5
};
inline constexpr std::array all_wrongs{Wrong::nothing,        Wrong::nothing_stated,    Wrong::side,
                                       Wrong::x_friction,     Wrong::x_reversed,        Wrong::x_dead,
                                       Wrong::x_tenfold,      Wrong::axes_swapped,      Wrong::spindle_weak,
                                       Wrong::spindle_frozen, Wrong::spindle_saturated, Wrong::edge_forces,
                                       Wrong::material};
const char* name_of(Wrong wrong);

struct TrueSpindle {
    double K_t1_Nm_per_A = 0.0;
    double idle_torque_Nm = 0.0;  ///< of the warm spindle
    double warm_up_torque_Nm = 0.0;
    double warm_up_time_s = 1.0;
};

struct TrueAxis {
    double K_x4_N_per_A = 0.0;
    double mass_kg = 0.0;
    double gravity_A = 0.0;
    double K_x3_A = 0.0;
    std::array<double, 2> K_x2_A_min_per_m{};  ///< travelling in − and in + direction
    std::array<double, 2> friction_scale{};
    double ripple_A = 0.0;  ///< rms of what depends on the position
};

struct DrawnCut {
    TrueCut cut;
    TrueSpindle spindle;
    std::array<TrueAxis, 2> axes;
    double direction_rad = 0.0;  ///< of the travel, from machine +x to +y
    double turns_per_s = 50.0;
    double noise_A = 0.1;   ///< of a sample
    double override = 0.6;  ///< at which the cut was recorded
    Wrong wrong = Wrong::nothing;
    firmware::Parameters<float> stated;
    std::uint64_t seed = 0;
};

/// `files`: what machine and tool are stated to be, of a tool with the linear edge law. The cut's peak is 0.2 to 0.9 of
/// the tooth's limit.
DrawnCut draw_cut(const firmware::Parameters<float>& files, Wrong wrong, std::uint64_t seed);

}  // namespace millforce::judging
