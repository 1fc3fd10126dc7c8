// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "cia402/drive_settings.hpp"
#include "cia402/sdo_client.hpp"

namespace millforce::cia402 {

/// The `step`-th SDO transfer that prepares a drive: rated values read, heartbeat time and PDO mapping written, as far
/// as the settings ask for it. False: there is no such step. CiA 301: while its mapping changes, a PDO is switched off
/// (bit 31 of its id) and its number of mapped objects is 0.
[[nodiscard]] bool preparation_step(const DriveSettings& settings, std::uint8_t step, SdoRequest& request);

}  // namespace millforce::cia402
