// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ostream>

#include "mcap/mcap_writer.hpp"
#include "telemetry/event_watch.hpp"
#include "telemetry/telemetry.hpp"

namespace millforce::host {

/// Telemetry as MCAP: its fields on the topic `/millforce`, events on `/log` as Foxglove's log panel shows them.
class McapTelemetry {
  public:
    explicit McapTelemetry(std::ostream& out);

    void add(const Telemetry& telemetry);
    void add(const TelemetryEvent& event);
    /// To the stream, whole up to now.
    void flush() { writer_.end_chunk(); }
    void finish() { writer_.finish(); }

  private:
    McapWriter writer_;
    McapWriter::Channel fields_;
    McapWriter::Channel log_;
};

}  // namespace millforce::host
