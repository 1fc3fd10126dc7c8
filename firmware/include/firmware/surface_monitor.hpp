// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/feed_controller_data.hpp"
#include "estimation/cut_estimate.hpp"
#include "estimation/surface/roughness.hpp"
#include "firmware/parameters.hpp"

namespace millforce::firmware {

/// The roughness of the surface in work, and the feed at which it would meet its limit.
///
/// From F_x/F_z, F_z by the z drive's current: while z is at rest its force hides in static friction, and there is no
/// prediction. F_x is the force along the feed.
template <typename Scalar>
class SurfaceMonitor {
  public:
    explicit SurfaceMonitor(const ToolParameters<Scalar>& tool);

    /// Once per estimate. Without a model nothing is predicted.
    void update(const estimation::CutEstimate<Scalar>& estimate);

    [[nodiscard]] const estimation::RoughnessPrediction<Scalar>& prediction() const { return prediction_; }
    [[nodiscard]] const control::SurfaceForControl<Scalar>& for_control() const { return for_control_; }

  private:
    void set_ceiling(const estimation::CutEstimate<Scalar>& estimate,
                     const estimation::RoughnessConditions<Scalar>& cut, Scalar turns_per_s);

    estimation::RoughnessPredictor<Scalar> model_;
    Scalar tool_diameter_mm_;
    Scalar declared_depth_mm_;
    Scalar Ra_limit_um_;
    estimation::RoughnessPrediction<Scalar> prediction_{};
    control::SurfaceForControl<Scalar> for_control_{};
};

}  // namespace millforce::firmware
