// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "mcap/mcap_telemetry.hpp"
#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// The telemetry of a run as an MCAP file, a row each 20 ms. Written every 10 s; what a full disk does not take is
/// reported at once, and ends the file.
class McapFile final : public TelemetrySink {
  public:
    /// Empties the file, or creates it. Throws InputError.
    explicit McapFile(const std::string& name);

    void on_sample(const Telemetry& telemetry) override;
    void on_event(const TelemetryEvent& event) override;
    void on_turn() override;
    void on_end() override;
    [[nodiscard]] std::string failed_file() const override { return has_failed_ ? name_ : std::string(); }

  private:
    void look_for_failure();

    std::string name_;
    std::ofstream file_;
    McapTelemetry telemetry_;
    std::uint64_t next_row_us_ = 0;
    std::uint64_t turns_ = 0;
    bool has_failed_ = false;
};

}  // namespace millforce::host
