// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemetry/telemetry_hub.hpp"

namespace millforce::host {

/// Sends each sample as one UDP datagram with a JSON object, as PlotJuggler's UDP server takes it:
///
///     {"timestamp":1436509052.249713,"millforce":{"time_s":1.250000,"state":"in_cut",…}}
///
/// `timestamp`: Unix time in s. A field without a value is left out. What cannot be sent is dropped.
class UdpJson final : public TelemetrySink {
  public:
    /// "HOST:PORT", "[ADDRESS]:PORT" for IPv6. Throws InputError: not of this form, or a host that cannot be found.
    explicit UdpJson(const std::string& address);
    ~UdpJson() override;
    UdpJson(const UdpJson&) = delete;
    UdpJson& operator=(const UdpJson&) = delete;

    void on_sample(const Telemetry& telemetry) override;

  private:
    int socket_ = -1;
};

}  // namespace millforce::host
