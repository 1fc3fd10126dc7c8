// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/cutting/cut_geometry.hpp"
#include "estimation/depth_shape/cut_category.hpp"
#include "estimation/number/literal.hpp"
#include "estimation/number/measurement.hpp"
#include "estimation/signal/low_pass.hpp"

/// What the fit of a flute profile (flute_profile_fit.hpp) takes and gives.

namespace millforce::estimation {

/// Depths that are searched.
template <typename Scalar>
struct DepthRange {
    Scalar low_mm{0};
    Scalar high_mm{0};
};

template <typename Scalar>
struct FluteProfileFitSettings {
    FluteGeometry<Scalar> cutter{};
    Scalar feed_per_tooth_mm{
        0};  ///< feed, for the trochoid's part of the chip's shape (some f_z/R); 0: chips of circles
    CutSide side = CutSide::down;  ///< down, up, or unknown: both are fitted, and the clearly better one is taken
    DepthRange<Scalar> axial{};    ///< range of the search; a solution at its end is rejected
    DepthRange<Scalar> radial{};
    LowPass<Scalar> low_pass{};
    /// Angle of a tooth's tip at the encoder's zero, 0…2π/N; not valid: unknown, then found with the depths.
    Measurement<Scalar> tip_angle_rad{};
    Scalar line_error = literal<Scalar>(0.003L);         ///< assumed error of a Fourier line, as a share of the line
    Scalar floor_error = literal<Scalar>(0.001L);        ///< assumed error of any line, as a share of the profile's rms
    Scalar largest_relative_sd = literal<Scalar>(0.1L);  ///< largest deviation of a depth; above: no estimate of it
    Scalar largest_tip_angle_sd_rad =
        literal<Scalar>(0.05L);  ///< largest deviation of a learnt angle; above: nothing learnt
    Scalar smallest_ripple =
        literal<Scalar>(0.002L);  ///< least share of the whole profile; below it there is no shape to fit
};

template <typename Scalar>
struct FluteProfileEstimate {
    Measurement<Scalar> axial_depth_mm{};
    Measurement<Scalar> radial_depth_mm{};
    Measurement<Scalar> tip_angle_rad{};
    CutSide side = CutSide::unknown;
    CutCategory category{};
    Scalar ripple{0};  ///< rms of the profile about its mean, over the rms of the whole profile
    Scalar misfit{1};  ///< share of the weighted profile that is not explained
    Scalar residual_variance{
        0};  ///< residual variance over the assumed one; far above 1 the cut is not what the model takes it for
};

}  // namespace millforce::estimation
