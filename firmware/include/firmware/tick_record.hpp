// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "estimation/number/finite.hpp"
#include "estimation/tooth_force/total_force.hpp"
#include "firmware/parameters.hpp"
#include "hal/feed_override.hpp"

/// One tick for a record: what the tick knows anyway. Everything else (the total force, units and words for a person)
/// is calculated from it by the program that shows it, outside the real-time path.

namespace millforce::firmware {

/// Plain data, float whatever the tick computes in.
struct TickRecord {
    static constexpr float no_estimate = std::numeric_limits<float>::quiet_NaN();

    std::uint64_t time_us = 0;
    hal::FeedOverride feed_override{};  ///< output of the tick
    std::uint8_t limit = 0;             ///< control::Limit

    float tangential_force_N = no_estimate;
    float feed_force_N = no_estimate;
    float runout_um = no_estimate;         ///< by how much the chip of one tooth is thicker than the mean one, at most
    float radial_immersion = no_estimate;  ///< this and all below: in contact only
    float radial_immersion_sd = no_estimate;
    float axial_depth_mm = no_estimate;
    float axial_depth_sd_mm = no_estimate;
    float law_misfit = no_estimate;  ///< J (immersion_profile.hpp): above 16 no law of this tool fits the forces
    estimation::CutSide side = estimation::CutSide::unknown;  ///< that the forces fit better, or the declared one
    float tooth_force_N = no_estimate;                        ///< peak of one tooth, or its upper bound
    estimation::TotalForceInput<float> total_force{};

    [[nodiscard]] bool has_side() const { return estimation::is_finite(law_misfit); }
    [[nodiscard]] bool has_tooth_force() const { return estimation::is_finite(tooth_force_N); }
};

/// Of the newest step of a ForceControlTick. Cost: some 20 copies, no arithmetic.
template <typename Tick>
[[nodiscard]] TickRecord tick_record(const Tick& tick, const hal::FeedOverride& output, std::uint64_t time_us);

template <typename Scalar>
[[nodiscard]] estimation::TotalForce<Scalar> total_force(const Parameters<Scalar>& parameters) {
    return {estimator_settings(parameters), parameters.tool.law};
}

/// Peak and threshold of the total force; NaN for a record without a tooth force.
struct ShownForces {
    float peak_N = TickRecord::no_estimate;
    float limit_N = TickRecord::no_estimate;
};
/// Cost: that of TotalForce::of(), not for the real-time path.
[[nodiscard]] ShownForces shown_forces(const estimation::TotalForce<float>& total, const TickRecord& record);

}  // namespace millforce::firmware
