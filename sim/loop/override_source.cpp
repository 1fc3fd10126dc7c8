// SPDX-License-Identifier: Apache-2.0
#include "loop/override_source.hpp"

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
    point.runout_um = in_double(tick.runout_um);
    point.law_misfit = in_double(tick.law_misfit);
    point.side = static_cast<std::uint8_t>(tick.side);
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

std::vector<std::string> controller_names() {
    return {"millforce", "millforce_fixed", "constant"};
}

std::unique_ptr<OverrideSource> controller_named(const std::string& name, const firmware::Parameters<float>& parameters,
                                                 double constant_ratio) {
    if (name == "constant") {
        return std::make_unique<ConstantFeed>(parameters, constant_ratio);
    }
    if (name == "millforce_fixed") {
        return std::make_unique<FixedPointController>(parameters);
    }
    return std::make_unique<MillforceController>(parameters);
}

}  // namespace millforce::sim
