// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemetry/telemetry.hpp"

namespace millforce::host {

/// The telemetry in Prometheus' text format 0.0.4, made of the fields: names `millforce_…` with the unit in words. A
/// word is a gauge for each word that it may be, 1 for the one that it is. A field without a value has no line.
[[nodiscard]] std::string prometheus_text(const Telemetry& telemetry);

}  // namespace millforce::host
