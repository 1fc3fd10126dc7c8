// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// Sends the telemetry once a second, and each event, to the Unix datagram socket of `millforce gateway`:
///
///     state {"unix_s":1436509052.249713,"time_s":1.250000,…}
///     event {"unix_s":1436509052.249713,"level":"fault","text":"fault: overload"}
///
/// What nobody takes is dropped: a gateway may come later, or never.
class UnixJson final : public TelemetrySink {
  public:
    /// Throws InputError: a path that is too long.
    explicit UnixJson(std::string path);
    ~UnixJson() override;
    UnixJson(const UnixJson&) = delete;
    UnixJson& operator=(const UnixJson&) = delete;

    void on_sample(const Telemetry& telemetry) override;
    void on_event(const TelemetryEvent& event) override;

  private:
    void send(const std::string& text) const;

    std::string path_;
    int socket_;
    std::uint64_t next_us_ = 0;
};

}  // namespace millforce::host
