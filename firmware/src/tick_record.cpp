// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick_record.hpp"

#include "estimation/number/fixed_point.hpp"
#include "firmware/tick.hpp"

namespace millforce::firmware {

namespace {

constexpr float um_per_mm = 1000.0F;

template <typename Scalar>
float value_or_none(const estimation::Measurement<Scalar>& measurement) {
    return measurement.valid ? static_cast<float>(measurement.value) : TickRecord::no_estimate;
}

template <typename Scalar>
estimation::TotalForceInput<float> in_float(const estimation::TotalForceInput<Scalar>& cut) {
    return {static_cast<float>(cut.tooth_force_N), static_cast<float>(cut.radial_immersion),
            static_cast<float>(cut.axial_depth_mm), cut.side};
}

}  // namespace

template <typename Tick>
TickRecord tick_record(const Tick& tick, const hal::FeedOverride& output, std::uint64_t time_us) {
    const auto& estimate = tick.estimate();
    const auto& control = tick.control();
    TickRecord record;
    record.time_us = time_us;
    record.feed_override = output;
    record.limit = static_cast<std::uint8_t>(control.limit);
    record.tangential_force_N = value_or_none(estimate.tangential_N);
    record.feed_force_N = value_or_none(estimate.feed_N);
    if (estimate.tooth_periods > 0) {
        record.runout_um = um_per_mm * static_cast<float>(estimate.runout_mm);
    }
    if (control.state == control::CutState::air || control.state == control::CutState::exit) {
        return record;
    }
    const auto engagement = tick.engagement();
    if (engagement.immersion_valid) {
        record.radial_immersion = static_cast<float>(engagement.radial_immersion);
        record.radial_immersion_sd = static_cast<float>(engagement.radial_immersion_sd);
    }
    if (engagement.depth_valid) {
        record.axial_depth_mm = static_cast<float>(engagement.axial_depth_mm);
        record.axial_depth_sd_mm = static_cast<float>(engagement.axial_depth_sd_mm);
    }
    if (engagement.solved) {
        record.law_misfit = static_cast<float>(engagement.misfit);
        record.side = engagement.side;
    }
    record.tooth_force_N = value_or_none(estimate.tooth_force_N);
    record.total_force = in_float(tick.estimator().total_force_input());
    return record;
}

template TickRecord tick_record(const ForceControlTick<float>& tick, const hal::FeedOverride& output,
                                std::uint64_t time_us);
template TickRecord tick_record(const ForceControlTick<estimation::Fixed>& tick, const hal::FeedOverride& output,
                                std::uint64_t time_us);

ShownForces shown_forces(const estimation::TotalForce<float>& total, const TickRecord& record) {
    if (!record.has_tooth_force()) {
        return {};
    }
    const auto forces = total.of(record.total_force);
    return {forces.peak_N, forces.limit_N};
}

}  // namespace millforce::firmware
