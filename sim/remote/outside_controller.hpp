// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "loop/override_source.hpp"
#include "loop/scenario.hpp"
#include "recording/continuous_counts.hpp"

namespace millforce::sim {

/// Our side of a controller that is not ours: question and answer as lines of JSON (controller_messages.hpp), however
/// they travel. The project's own tick runs along in monitor mode, and its estimates are in each question.
class OutsideController : public TraceSource {
  public:
    explicit OutsideController(const Scenario& scenario);

    /// The message about this sample. Each is followed by take().
    [[nodiscard]] std::string ask(const hal::DriveSample& sample, const hal::ProgramStatus& program);
    /// Throws InputError for an answer that no CNC would take, and where the feed has been held for so long that the
    /// program would not end.
    [[nodiscard]] hal::FeedOverride take(std::string_view answer);
    /// Of the last question, 1 for the first.
    [[nodiscard]] std::uint64_t sample_number() const { return samples_; }

    /// The controller's own estimates where it sent some, else those of the tick.
    void describe(TracePoint& point) const override;

  private:
    void refuse_standstill(const hal::FeedOverride& output);

    firmware::CncParameters<float> cnc_;
    MillforceController monitor_;
    host::ContinuousCounts counts_;
    std::uint64_t samples_ = 0;
    double stands_since_s_ = 0.0;
    std::optional<TracePoint> own_estimate_;
};

}  // namespace millforce::sim
