// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimation/depth_shape/flute_profile.hpp"
#include "estimation/depth_shape/flute_profile_estimate.hpp"
#include "estimation/number/fixed_point.hpp"
#include "estimation/number/literal.hpp"

namespace millforce::estimation {

/// Depths of cut from a running force signal: plane forces against the spindle's angle are averaged over whole
/// revolutions (FluteProfile), and each complete profile is fitted (FluteProfileFit).
///
/// add() is for the sampling loop, evaluate() for a slower task: where add() says that a profile is complete, samples
/// are dropped until evaluate() has taken it. The forces may be in any fixed frame (machine or feed), as long as x, y
/// and the spindle's rotation (clockwise from above, φ grows from +y to +x) are the right way round: a turned frame
/// turns the law's complex coefficients and nothing else. It must not turn within a profile.
///
/// Memory: (3·Bins + 20) scalars and the settings; evaluate() needs some 20 kB of stack. No heap. Not thread-safe.
/// Bodies: depth_monitor_impl.hpp.
template <typename Scalar, int Harmonics = 10, int Bins = 180>
class DepthMonitor {
  public:
    using Estimate = FluteProfileEstimate<Scalar>;

    static constexpr Scalar usual_depth_sd = literal<Scalar>(0.005L);  ///< of known depths, relative

    DepthMonitor() = default;
    explicit DepthMonitor(const FluteProfileFitSettings<Scalar>& settings, int revolutions = 20);

    /// One sample, dt_s after the last one; the angle wrapped to any one turn. A sample that is not finite, or a turn
    /// of more than half a pitch since the last one, restarts the profile. True where evaluate() has work to do.
    bool add(Scalar dt_s, Scalar spindle_angle_rad, Scalar fx_N, Scalar fy_N);

    [[nodiscard]] bool complete() const { return profile_.complete(); }

    /// Fits the complete profile and starts the next one. Without a complete profile: no estimate.
    Estimate evaluate();

    /// Learns the angle of the teeth at the encoder's zero from a profile of known depths, for all later profiles with
    /// this tool in this holder. False: no complete profile, or it does not determine the angle.
    bool learn_tip_angle(const DepthsOfCut<Scalar>& known, Scalar relative_sd = usual_depth_sd);

    [[nodiscard]] const Measurement<Scalar>& tip_angle_rad() const { return settings_.tip_angle_rad; }
    void restart();

  private:
    ProfileSpectrum<Scalar, Harmonics> take_spectrum();

    FluteProfileFitSettings<Scalar> settings_{};
    FluteProfile<Scalar, 2, Bins> profile_{};
    Scalar angle_rev_{0};
    bool started_ = false;
};

extern template class DepthMonitor<float>;
extern template class DepthMonitor<Fixed>;

}  // namespace millforce::estimation
