// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "files/toml_reader.hpp"
#include "loop/scenario.hpp"

/// A kind of machine: how its currents reach the controller, and what the controller knows about them. The same part
/// can be milled on machines of every kind.

namespace millforce::sim {

struct MachineKind {
    std::string title;
    firmware::MachineParameters<float> machine{};
    CurrentChannel channel = CurrentChannel::per_mille_int16;
    double current_noise_share = 0.01;  ///< of rated current, per sample
    LoadMeterSettings load_meter{};
    bool has_part_map = false;  ///< the controller looks ahead
};

/// Reads kinds/NAME.toml: a machine file (relative to its own folder), whether there is a part map, [currents] and
/// [load_meter]. What [currents] says about noise and gain holds for the plant and for what the controller is given.
/// Throws InputError.
MachineKind read_machine_kind(const std::string& path);

/// The scenario's part, tool and material on a machine of this kind.
Scenario on_machine(Scenario scenario, const MachineKind& kind);

/// The table [load_meter] of a kind or a scenario.
void read_load_meter(host::TomlFile::Table& root, LoadMeterSettings& meter);

}  // namespace millforce::sim
