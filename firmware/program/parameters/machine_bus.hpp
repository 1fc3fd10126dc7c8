// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cia402/drive_settings.hpp"
#include "override_frame/override_sender.hpp"
#include "parameters/local_io.hpp"
#include "program_status/program_status_receiver.hpp"

namespace millforce::host {

/// Who is on a machine's CAN bus, and how they speak: the [bus] tables of machine.toml; and the inputs and outputs of
/// this computer that belong to it.
struct MachineBus {
    cia402::BusSettings drives{};
    bool produces_sync = false;
    override_frame::OverrideSenderSettings feed_override{};
    program_status::ProgramStatusReceiverSettings program{};
    LocalIoKeys local{};
};

}  // namespace millforce::host
