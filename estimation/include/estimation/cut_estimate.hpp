// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/engagement/engagement_estimate.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>

/// What goes into CutEstimator and what comes out.

namespace millforce::estimation {

/// 1 + p_s of a usual law: cutting force ∝ f^(1+p_s).
template <typename Scalar>
inline constexpr Scalar usual_feed_exponent = literal<Scalar>(0.75L);

/// What the firmware sets from the machine's and the tool's parameters has its default there (parameters.hpp), and is 0
/// here until it is set.
template <typename Scalar>
struct CutEstimatorSettings {
    Scalar teeth{0};
    Scalar cutter_radius_mm{0};
    Scalar helix_rad{0};
    Scalar runout_mm{0};  ///< largest difference of two teeth's radii
    CutSide side = CutSide::unknown;
    Scalar centre_offset_in_radii{0};
    Scalar largest_depth_mm{0};  ///< longest depth of cut of the tool's flutes
    Scalar nominal_feed_per_tooth_mm{0};
    Scalar assumed_immersion{1};  ///< used for peaks (never to speed up) until an immersion is known
    Scalar surge_immersion{0};    ///< see FeedControllerParameters::surge_radial_immersion
    Scalar turn_immersion{0};     ///< see FeedControllerParameters::turn_radial_immersion
    Scalar tooth_force_limit_N{0};
    Scalar declared_depth_mm{0};  ///< axial depth that the program declares; 0: not declared
    Scalar law_relative_sd{0};
    Scalar min_samples{12};
    std::uint32_t encoder_counts_per_rev = 0;
    bool load_is_held = false;  ///< the spindle's current stands for a load that is told seldom: each value is news
};

/// One drive sample, as plain numbers.
template <typename Scalar>
struct DriveSignals {
    static constexpr int spindle_current = 0;  ///< row of the spindle's current in A
    static constexpr int first_current = 1;    ///< rows of the axes' currents in A
    static constexpr int first_velocity = 4;   ///< rows of the axes' velocities in mm/s
    static constexpr int velocities = 3;
    static constexpr int channels = first_velocity + velocities;
    static constexpr std::uint32_t spindle_present = 1U;
    static constexpr std::uint32_t first_axis_present = 2U;  ///< bit of x; y and z follow

    Eigen::Matrix<Scalar, channels, 1> values = Eigen::Matrix<Scalar, channels, 1>::Zero();
    std::uint32_t present = 0;

    struct Velocity {
        Scalar x_mm_s{0};
        Scalar y_mm_s{0};
        Scalar z_mm_s{0};
    };
    [[nodiscard]] Velocity velocity() const {
        return {values[first_velocity], values[first_velocity + 1], values[first_velocity + 2]};
    }
};

template <typename Scalar>
struct CutEstimate {
    int tooth_periods = 0;                     ///< tooth periods since the previous estimate
    Measurement<Scalar> tangential_N{};        ///< F_at over the window (whole revolutions)
    Measurement<Scalar> tooth_tangential_N{};  ///< F_at over the last tooth period alone
    /// F_at averaged over as many revolutions as the cut stays the same (force_memory.hpp); tangential_N where the
    /// load is held.
    Measurement<Scalar> steady_tangential_N{};
    Scalar tangential_gain_doubt{0};  ///< relative deviation of F_at, beyond its variance (SpindleDrive::gain_doubt)
    Scalar uncertain_idle_N{0};       ///< of the idle torque: learnt where it may have been a light cut; ≥ 0
    Measurement<Scalar> x_N{};        ///< mean force on the workpiece along the machine's axes, over the window
    Measurement<Scalar> y_N{};
    Measurement<Scalar> z_N{};
    Measurement<Scalar> feed_N{};      ///< F_ax, along the feed; not valid if a needed axis is at rest
    bool axis_is_implausible = false;  ///< one of x and y shows a current in air that its friction does not explain
    EngagementEstimate<Scalar> engagement{};

    Measurement<Scalar> tooth_force_N{};  ///< peak in-plane force of one tooth; without an immersion its upper bound
    bool tooth_force_is_bound = false;    ///< tooth_force_N is the most that it can be, and may be far above it
    Scalar certain_tooth_force_N{0};      ///< at that end of the immersion's 95 % interval where it is smaller
    Scalar least_tooth_force_N{0};        ///< smallest peak force of one tooth: F_at shared by the widest cut
    Scalar runout_mm{0};                  ///< by how much its chip is thicker, at most: runout_meter.hpp
    Scalar runout_factor{1};              ///< force of the tooth with the largest radius over that of a mean one
    Scalar worst_tooth_force_N{0};        ///< tooth force at the known immersion, or at the last or assumed one
    Scalar tangential_growth_N_per_s{
        0};  ///< growth of F_at over the last revolution beyond that of the feed, where significant; ≥ 0
    Scalar newest_tangential_N{0};  ///< F_at of the window, or more where a tooth carries more than a turn before
    Scalar cutting_share{1};        ///< share of F_at that is not edge force
    Scalar feed_exponent{usual_feed_exponent<Scalar>};  ///< 1 + p_s: cutting force ∝ f^(1+p_s)
    /// The force of a tooth at another immersion, at the same depth and feed.
    struct Change {
        Scalar ratio{1};          ///< its force over its force now
        Scalar cutting_share{1};  ///< share of that force that is not edge force
    };
    Scalar section_mm2{0};        ///< width × depth that corresponds to F_at at the known K_s; 0: no F_at
    Scalar section_noise_mm2{0};  ///< part of the section that differs from one window to the next
    Change surge{};               ///< change to settings.surge_immersion, where that is larger than now
    Change turn{};                ///< change to settings.turn_immersion
    /// The last tooth period against the same tooth one revolution before.
    struct ToothChange {
        Measurement<Scalar> tangential_N{};           ///< force from the spindle's current; its variance is noise alone
        std::array<Measurement<Scalar>, 2> axis_N{};  ///< forces along x and y
        Scalar speed_ratio{1};                        ///< speed of the spindle now over that before
        Scalar feed_growth{0};        ///< (f − f_before)/f of a feed that has risen, by up to a half; ≥ 0
        bool feed_is_steady = false;  ///< the velocities differ by less than a tenth
        bool feed_is_alike = false;   ///< by less than three tenths
        bool feed_is_new = false;     ///< by more than the present one: a sharp turn, or less than half the feed
    };
    ToothChange tooth_change{};
    Scalar feed_mm_s{0};         ///< path speed in the plane over the window
    Scalar axial_speed_mm_s{0};  ///< speed along z
    Scalar feed_per_tooth_mm{0};
    Scalar spindle_speed_rad_s{0};
    Scalar window_s{0};
};

}  // namespace millforce::estimation
