#pragma once

#include "cia402/drive_settings.hpp"
#include "override_frame/override_sender.hpp"
#include "program_status/program_status_receiver.hpp"

namespace millforce::sim {

/// Who is on a machine's CAN bus, and how they speak: the [bus] tables of machine.toml.
struct MachineBus {
    cia402::BusSettings drives{};
    override_frame::OverrideSenderSettings feed_override{};
    program_status::ProgramStatusReceiverSettings program{};
};

}  // namespace millforce::sim
