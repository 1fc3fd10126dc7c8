// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>

#include "loop/override_source.hpp"
#include "recording/recording.hpp"

namespace millforce::sim {

/// Stands before a controller and gives each of its steps to `keep`.
class Recorder : public OverrideSource {
  public:
    Recorder(OverrideSource& controller, std::function<void(const host::RecordedStep&)> keep)
        : controller_(controller), keep_(std::move(keep)) {}
    hal::FeedOverride step(const hal::DriveSample& sample, const hal::ProgramStatus& program) override;
    void describe(TracePoint& point) const override { controller_.describe(point); }

  private:
    OverrideSource& controller_;
    std::function<void(const host::RecordedStep&)> keep_;
};

}  // namespace millforce::sim
