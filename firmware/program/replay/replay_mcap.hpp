// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "files/atomic_file.hpp"
#include "mcap/mcap_telemetry.hpp"
#include "telemetry/event_watch.hpp"

namespace millforce::host {

/// The rows of a replay as an MCAP file, where one is asked for. MCAP has no time before 0: a recording that begins
/// before it is moved to 0 as a whole, and the field time_s keeps the recording's time.
class ReplayMcap {
  public:
    /// Empty: no file. Throws InputError.
    ReplayMcap(const std::string& file, const ToolSet& tools) {
        if (!file.empty()) {
            writing_ = std::make_unique<Writing>(file, tools);
        }
    }

    /// With each row. `sample.tick.time_us` is not used.
    void write(double time_s, TelemetrySample sample) {
        if (writing_ == nullptr) {
            return;
        }
        first_s_ = first_s_.value_or(time_s);
        const double since_s = std::max(0.0, time_s - std::min(0.0, *first_s_));
        sample.monotonic_us = static_cast<std::uint64_t>(std::llround(since_s * 1e6));
        Telemetry telemetry = writing_->maker.of(sample, 0);
        telemetry.time_s = time_s;
        writing_->events.follow(telemetry, [this](const TelemetryEvent& event) { writing_->telemetry.add(event); });
        writing_->telemetry.add(telemetry);
    }
    void commit() {
        if (writing_ != nullptr) {
            writing_->telemetry.finish();
            writing_->file.commit();
        }
    }

  private:
    struct Writing {
        Writing(const std::string& name, const ToolSet& tools)
            : maker(tools, 0), file(name), telemetry(file.stream()) {}

        TelemetryMaker maker;
        EventWatch events{};
        AtomicFile file;
        McapTelemetry telemetry;
    };

    std::unique_ptr<Writing> writing_{};
    std::optional<double> first_s_{};
};

}  // namespace millforce::host
