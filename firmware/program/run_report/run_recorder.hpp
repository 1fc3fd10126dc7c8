// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "run_report/run_history.hpp"
#include "run_report/run_notes.hpp"
#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// Whose time the page of a run has: that of the samples, or of this computer where several runs follow each other.
enum class RunClock : std::uint8_t { samples, monotonic };

/// Fills the history of a run with every tick and note. Ticks that did not reach the hub are counted.
class RunRecorder final : public TelemetrySink {
  public:
    /// Both outlive this. `history` is this object's alone until the hub is finished.
    RunRecorder(RunHistory& history, RunNotes& notes, RunClock clock)
        : history_(history), notes_(notes), clock_(clock) {}

    void on_sample(const Telemetry& telemetry) override;
    void on_turn() override;
    void on_end() override { on_turn(); }

  private:
    RunHistory& history_;
    RunNotes& notes_;
    RunClock clock_;
};

}  // namespace millforce::host
