// SPDX-License-Identifier: Apache-2.0
#include "loop/override_source.hpp"

#include <algorithm>
#include <cmath>

namespace millforce::sim {

firmware::Parameters<float> monitoring(firmware::Parameters<float> parameters) {
    parameters.tool.monitor_only = true;
    return parameters;
}

template <typename Scalar>
hal::FeedOverride TickController<Scalar>::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    tick_.take(sample);
    firmware::finish_estimate(tick_);
    look_ahead(tick_, program);
    output_ = tick_.answer(program);
    firmware::finish_work(tick_);
    return output_;
}

void describe(const firmware::TickRecord& tick, TracePoint& point) {
    const auto in_double = [](float value) { return static_cast<double>(value); };
    point.state = tick.feed_override.state;
    point.limit = tick.limit;
    point.fault = tick.feed_override.fault;
    point.tangential_force_N = in_double(tick.tangential_force_N);
    point.feed_force_N = in_double(tick.feed_force_N);
    point.radial_immersion = in_double(tick.radial_immersion);
    point.radial_immersion_sd = in_double(tick.radial_immersion_sd);
    point.axial_depth_mm = in_double(tick.axial_depth_mm);
    point.axial_depth_sd_mm = in_double(tick.axial_depth_sd_mm);
    point.tooth_force_N = in_double(tick.tooth_force_N);
}

template <typename Scalar>
void TickController<Scalar>::describe(TracePoint& point) const {
    const firmware::TickRecord record = firmware::tick_record(tick_, output_, 0);
    sim::describe(record, point);
    if (record.has_tooth_force()) {
        const auto total = total_force_.of(tick_.estimator().total_force_input());
        point.peak_force_N = static_cast<double>(static_cast<float>(total.peak_N));
        point.force_limit_N = static_cast<double>(static_cast<float>(total.limit_N));
    }
}

template class TickController<float>;
template class TickController<estimation::Fixed>;

MappedController::MappedController(const firmware::Parameters<float>& parameters,
                                   const std::optional<host::PartMap>& map, host::MapLearner* learner)
    : MillforceController(parameters),
      follower_(map ? std::optional<host::MapFollower>(std::in_place, parameters, *map) : std::nullopt),
      way_(follower_ ? &*follower_ : nullptr, learner) {}

ConstantFeed::ConstantFeed(const firmware::Parameters<float>& parameters, double ratio)
    : monitor_(monitoring(parameters)), ratio_(static_cast<float>(ratio)) {}

hal::FeedOverride ConstantFeed::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    hal::FeedOverride output = monitor_.step(sample, program);
    output.ratio = program.rapid ? 1.0F : ratio_;
    output.hold = false;
    return output;
}

ConstantLoad::ConstantLoad(const firmware::Parameters<float>& parameters, double reference_tangential_N)
    : cnc_(parameters.machine.cnc),
      monitor_(monitoring(parameters)),
      reference_N_(static_cast<float>(reference_tangential_N)),
      ratio_(1.0F) {}

hal::FeedOverride ConstantLoad::step(const hal::DriveSample& sample, const hal::ProgramStatus& program) {
    hal::FeedOverride output = monitor_.step(sample, program);
    const auto& e = monitor_.estimate();
    // 200 ms of smoothing and an integrator of 1 s per full-scale error: figures that such products' manuals name.
    const float dt_s = 1.0F / cnc_.sample_rate_hz;
    if (e.tangential_N.valid) {
        filtered_N_ += (e.tangential_N.value - filtered_N_) * std::min(1.0F, dt_s / 0.2F);
    }
    const float error = (reference_N_ - filtered_N_) / reference_N_;
    ratio_ = std::clamp(ratio_ + error * dt_s, cnc_.override_min, std::min(cnc_.override_max, 1.5F));
    output.ratio = program.rapid ? 1.0F : ratio_;
    output.hold = false;
    return output;
}

double constant_load_reference_N(const firmware::Parameters<float>& parameters) {
    const auto settings = firmware::estimator_settings(parameters);
    estimation::PeakFactorSettings<float> peak;
    peak.teeth = settings.teeth;
    peak.cutter_radius_mm = settings.cutter_radius_mm;
    peak.helix_rad = settings.helix_rad;
    peak.nominal_feed_per_tooth_mm = settings.nominal_feed_per_tooth_mm;
    const auto factors =
        estimation::peak_factors(parameters.tool.law, peak, 2.0F, 0.25F * parameters.tool.flute_length_mm);
    return static_cast<double>(parameters.tool.tooth_force_limit_N / factors.tooth);
}

std::vector<std::string> controller_names() {
    return {"millforce", "millforce_fixed", "constant", "constant_load"};
}

std::unique_ptr<OverrideSource> controller_named(const std::string& name, const firmware::Parameters<float>& parameters,
                                                 double constant_ratio) {
    if (name == "constant") {
        return std::make_unique<ConstantFeed>(parameters, constant_ratio);
    }
    if (name == "constant_load") {
        return std::make_unique<ConstantLoad>(parameters, constant_load_reference_N(parameters));
    }
    if (name == "millforce_fixed") {
        return std::make_unique<FixedPointController>(parameters);
    }
    return std::make_unique<MillforceController>(parameters);
}

}  // namespace millforce::sim
