// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "commission/commission.hpp"
#include "run_log/bus_clock.hpp"

namespace millforce::host {

/// A machine on a CAN interface, for a commissioning: the daemon of `millforce run`, with a watcher. The override that
/// it sends is 1: the operator's.
class MachineOnInterface final : public LiveMachine {
  public:
    /// Throws InputError where the name is none.
    MachineOnInterface(const std::string& interface, const BusPace& pace);

    std::vector<FoundDrive> find_drives() override;
    bool record(const std::filesystem::path& machine, const std::filesystem::path& tool, StepRecorder& recorder,
                StepWatch& watch) override;

  private:
    std::string interface_;
    BusPace pace_;
};

}  // namespace millforce::host
