// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/number/measurement.hpp"

/// What goes into the engagement solver and what comes out.

namespace millforce::estimation {

/// The axis of a straight move that stands still. Static friction may carry all of the force on it, and a brake, too;
/// but what its motor carries beyond static friction is force of the cut.
template <typename Scalar>
struct RestingAxis {
    bool is_x = false;
    Measurement<Scalar> least_N{};  ///< the force is at least that, in its direction; not valid: nothing is known
};

/// Average forces as the drives show them, along the machine's axes, acting on the workpiece.
template <typename Scalar>
struct AverageForceMeasurement {
    Measurement<Scalar> tangential_N{};      ///< F_at, from the spindle
    Measurement<Scalar> x_N{};               ///< along machine x; not valid if the x drive is at rest
    Measurement<Scalar> y_N{};               ///< along machine y
    RestingAxis<Scalar> resting{};           ///< the axis whose force is not valid because it is at rest
    Measurement<Scalar> radial_immersion{};  ///< immersion from elsewhere (force drops), if there is one
    Scalar feed_direction_x{1};              ///< unit vector of the tool's travel relative to the workpiece
    Scalar feed_direction_y{0};
};

template <typename Scalar>
struct EngagementEstimate {
    bool solved = false;  ///< there was something to solve: the 95 % intervals below hold, however wide
    bool immersion_valid = false;
    Scalar radial_immersion{0};  ///< R_r = a_e/R, 0…2
    Scalar radial_immersion_sd{0};
    Scalar radial_immersion_low{0};  ///< 95 % interval
    Scalar radial_immersion_high{2};
    Scalar engagement_rad{0};  ///< θ of radial_immersion, R_r = 1 − cos θ, and of the interval's ends
    Scalar engagement_low_rad{0};
    Scalar engagement_high_rad{pi<Scalar>};

    bool depth_valid = false;
    Scalar axial_depth_mm{0};
    Scalar axial_depth_sd_mm{0};
    Scalar axial_depth_force_sd_mm{0};  ///< the part due to the forces, without that due to K_s
    bool depth_is_remembered = false;  ///< the forces alone did not determine immersion and depth: see depth_memory.hpp
    bool declared_depth_is_refuted = false;  ///< depth or K_s is not as declared: the forces alone give the estimate
    Scalar depth_at_low_mm{0};               ///< the depth that goes with radial_immersion_low: both err together
    Scalar depth_at_high_mm{0};              ///< the depth that goes with radial_immersion_high

    CutSide side = CutSide::unknown;
    Scalar misfit{0};              ///< J at the estimate; above 16 the law does not describe these forces: no estimate
    bool law_is_in_doubt = false;  ///< the forces contradicted it for so long that a fit proves little: no estimate
};

}  // namespace millforce::estimation
