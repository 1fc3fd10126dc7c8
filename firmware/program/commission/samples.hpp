// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/drive_sample.hpp"

namespace millforce::host {

/// A sample with a time that does not wrap.
struct TimedSample {
    double time_s = 0.0;
    hal::DriveSample sample{};
};

/// What a step of a commissioning looks for in the samples of a machine. A bus, a recording or a test feeds it; it
/// knows nothing of where they come from. Not thread-safe.
class StepWatch {
  public:
    StepWatch() = default;
    virtual ~StepWatch() = default;
    StepWatch(const StepWatch&) = delete;
    StepWatch& operator=(const StepWatch&) = delete;

    /// The next sample. A step back in time, or forward by more than half a second, is a gap.
    void take(const TimedSample& timed) {
        constexpr double gap_s = 0.5;
        if (last_s_ && (timed.time_s < *last_s_ || timed.time_s > *last_s_ + gap_s)) {
            end();
        }
        last_s_ = timed.time_s;
        add(timed);
    }
    virtual void add(const TimedSample& timed) = 0;
    /// The samples end here, or there is a gap.
    virtual void end() = 0;
    /// Whether the step has all that its fit takes.
    [[nodiscard]] virtual bool is_enough() const = 0;
    /// What is still missing, in words for the operator; empty where nothing is.
    [[nodiscard]] virtual std::string lacks() const = 0;
    /// Says in the news what is still missing.
    void remind() { tell("  still missing: " + lacks() + "; run the program again"); }
    /// Lines since the last call: what was found, and the fit as it forms.
    std::vector<std::string> take_news() { return std::exchange(news_, {}); }

  protected:
    void tell(std::string line) { news_.push_back(std::move(line)); }

  private:
    std::vector<std::string> news_;
    std::optional<double> last_s_{};
};

}  // namespace millforce::host
