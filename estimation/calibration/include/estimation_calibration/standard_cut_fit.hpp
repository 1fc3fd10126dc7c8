// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

/// Gains of the spindle and of one feed drive from standard cuts: cuts whose forces are known from a database of
/// coefficients, with running in air between them (Kim & Chung, section 3.2).
///
///   T + k ω = K_t1 I + K_t2                              their Eq. 8 times the cutter radius
///   F_ax = K_x4 (I − I_g − κ I_f(w)) + K_x5/w            their Eq. 10; w in m/min, with its sign
///
/// Their Table 3 prints for K_x4 and K_x5 the two numbers of Eq. 8 once more; they cannot be the feed drive's. Both are
/// fitted here. K_x5/w is singular at rest: every stretch must be faster than the drive's velocity floor.
///
/// The currents are noisy and the forces are known. So the current is the left side of the fit,
///   I = (T + k ω)/K_t1 − K_t2/K_t1 + d · drift           drift: how cold the bearing still is, 0 when warm
///   I − I_g = κ I_f(w) + F_ax/K_x4 − (K_x5/K_x4)/w       in air F_ax = 0
/// and the standard errors of K_t1 = 1/a, K_t2 = −b/a and so on follow by first-order propagation. κ is the ratio of
/// today's friction to that of the air cuts which gave I_f: a nuisance parameter here.
///
/// A relative error of the database is one of K_t1 and K_x4 alike; it is not in these standard errors.

namespace millforce::estimation {

/// One stretch of steady feed and speed, in air or in a standard cut.
struct StandardCutStretch {
    double spindle_current_A = 0.0;
    double torque_Nm = 0.0;           ///< T + k ω: of the cut by the database, 0 in air, plus the idle slope's share
    double drift = 0.0;               ///< e^(−t/τ), or the share of the recording that is still to come
    double feed_current_A = 0.0;      ///< current of the axis that feeds, without I_g
    double friction_current_A = 0.0;  ///< I_f(w) by the air cuts, with the sign of w
    double feed_m_per_min = 0.0;      ///< w, with its sign
    double feed_force_N = 0.0;        ///< F_ax by the database along the axis' + direction, 0 in air
    double weight = 1.0;              ///< 1/sd of the mean currents, up to a common factor: √duration
    bool in_cut = false;
};

/// What the stretches lack for a fit.
enum class StandardCutLack : unsigned char {
    nothing,
    cut,          ///< no standard cut at all
    air,          ///< no running in air: idle current and cutting current cannot be separated
    second_load,  ///< all cuts load the drive alike
    second_feed,  ///< all cuts have the same feed: K_x5/w cannot be separated from the other terms
    rows,         ///< no degree of freedom is left for a standard error
    response,     ///< the current does not follow the load beyond its noise
};

struct DriveGainFit {
    StandardCutLack lack = StandardCutLack::nothing;  ///< unless `nothing`, the values must not be used
    double gain = 0.0;                                ///< K_t1 in N·m/A, or K_x4 in N/A
    double gain_se = 0.0;
    double offset = 0.0;  ///< K_t2 in N·m with the bearing warm, or K_x5 in N·m/min
    double offset_se = 0.0;
    double nuisance = 0.0;  ///< excess of the cold idle current in A, or κ
    double nuisance_se = 0.0;
    double residual_A = 0.0;  ///< standard deviation of the mean currents about the fit
    int rows = 0;
};

/// Largest over smallest load (torque or force) of the cuts, and of their feeds. Cuts that are more alike than this
/// hardly separate the gain from the offset.
struct StandardCutRules {
    double least_load_ratio = 1.2;
    double least_feed_ratio = 1.5;
    bool fits_K_x5 = true;  ///< false: K_x5 is 0
};

/// K_t1 (gain) and K_t2 (offset) of the spindle. Where all stretches have the same drift, d is 0.
[[nodiscard]] DriveGainFit fit_spindle_gain(std::span<const StandardCutStretch> stretches,
                                            const StandardCutRules& rules = {});

/// K_x4 (gain) and K_x5 (offset) of the axis that feeds.
[[nodiscard]] DriveGainFit fit_feed_gain(std::span<const StandardCutStretch> stretches,
                                         const StandardCutRules& rules = {});

}  // namespace millforce::estimation
