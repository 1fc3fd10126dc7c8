// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimation/number/fixed_point.hpp"
#include "firmware/parameters_in.hpp"
#include "firmware/tick.hpp"
#include "firmware/tick_record.hpp"
#include "hal/drive_sample.hpp"
#include "hal/feed_override.hpp"
#include "part_map/way_along_map.hpp"
#include "report/run_result.hpp"

namespace millforce::sim {

/// Who can say what a controller knew.
class TraceSource {
  public:
    virtual ~TraceSource() = default;
    /// Writes the estimates of this moment into a trace point.
    virtual void describe(TracePoint& point) const = 0;
};

/// Who sets the feed override: the project's own tick, or a baseline to compare it with. It sees what a controller on
/// the machine sees, drive samples and the program's status, and nothing of the plant.
class OverrideSource : public TraceSource {
  public:
    virtual hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) = 0;

    /// Before it is, the spindle turns and the program waits.
    [[nodiscard]] virtual bool is_ready() const { return true; }
    /// How the plant is to step until the next sample: as usual, but where a bus sets the time.
    struct PlantSteps {
        int count = 0;
        double step_s = 0.0;
    };
    [[nodiscard]] virtual PlantSteps plant_steps(const PlantSteps& usual) { return usual; }
};

/// The parameters with which a tick only watches.
[[nodiscard]] firmware::Parameters<float> monitoring(firmware::Parameters<float> parameters);

/// What a tick knew. Its total force, that a trace shows as well, is left to the caller.
void describe(const firmware::TickRecord& tick, TracePoint& point);

/// The real tick, the same class that runs on a drive controller: in float, or in fixed point as on a processor without
/// a floating-point unit.
template <typename Scalar>
class TickController : public OverrideSource {
  public:
    explicit TickController(const firmware::Parameters<float>& parameters)
        : tick_(firmware::parameters_in<Scalar>(parameters)),
          total_force_(firmware::total_force(firmware::parameters_in<Scalar>(parameters))) {}
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(TracePoint& point) const override;
    /// The operator's acknowledgement of a latched fault.
    void reset_fault() { tick_.reset_fault(); }
    [[nodiscard]] const estimation::CutEstimate<Scalar>& estimate() const { return tick_.estimate(); }
    [[nodiscard]] const estimation::RoughnessPrediction<Scalar>& roughness() const { return tick_.roughness(); }
    [[nodiscard]] const firmware::WideBandEstimate<Scalar>& wide_band() const { return tick_.wide_band(); }

  protected:
    /// Between the tick's estimate and its answer.
    virtual void look_ahead(firmware::ForceControlTick<Scalar>&, const hal::ProgramStatus&) {}

  private:
    firmware::ForceControlTick<Scalar> tick_;
    estimation::TotalForce<Scalar> total_force_;
    hal::FeedOverride output_{};
};
using MillforceController = TickController<float>;
using FixedPointController = TickController<estimation::Fixed>;

/// The tick with a part map, or with one that learns, or both.
class MappedController : public MillforceController {
  public:
    /// `learner` outlives this.
    MappedController(const firmware::Parameters<float>& parameters, const std::optional<host::PartMap>& map,
                     host::MapLearner* learner = nullptr);

    [[nodiscard]] bool is_refuted() const { return follower_ && follower_->is_refuted(); }
    /// With a map.
    [[nodiscard]] const control::FeedAhead<float>& ahead() const { return follower_->ahead(); }

  protected:
    void look_ahead(firmware::ForceControlTick<float>& tick, const hal::ProgramStatus& program) override {
        way_.look_ahead(tick, program);
    }

  private:
    std::optional<host::MapFollower> follower_;
    host::WayAlongMap way_;
};

/// The feed as programmed, times a constant: what is done today, with a feed that is safe everywhere. It estimates all
/// the same, in monitor mode, so that its report shows what it met.
class ConstantFeed : public OverrideSource {
  public:
    ConstantFeed(const firmware::Parameters<float>& parameters, double ratio);
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(TracePoint& point) const override { monitor_.describe(point); }

  private:
    MillforceController monitor_;
    float ratio_;
};

/// The controllers by name: "millforce", "millforce_fixed", "constant".
std::vector<std::string> controller_names();
/// One of them. `constant_ratio`: the override of "constant".
std::unique_ptr<OverrideSource> controller_named(const std::string& name, const firmware::Parameters<float>& parameters,
                                                 double constant_ratio);

}  // namespace millforce::sim
