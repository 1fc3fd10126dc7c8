// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "linuxcnc/plant_link.h"
#include "loop/milling_plant.hpp"

namespace millforce::sim {

/// The simulated machine behind LinuxCNC: LinuxCNC's commanded positions move drives, tool and workpiece, one servo
/// cycle per message. A run begins with the spindle's start, from rest and with new stock, and ends with the command
/// that stops the spindle; before and after it the axes are ideal and nothing is cut.
class LinuxCncPlant {
  public:
    explicit LinuxCncPlant(const Scenario& scenario) : scenario_(scenario) {}

    millforce_plant_reply step(const millforce_plant_command& command);
    /// LinuxCNC is gone: a run that has not ended is cut off.
    void disconnect();

    /// The run that has ended, once.
    [[nodiscard]] std::optional<RunResult> take_result();

  private:
    void advance(const millforce_plant_command& command, const Eigen::Vector3d& position_mm);
    void judge(const millforce_plant_command& command);
    void end(bool finished);

    Scenario scenario_;
    std::optional<MillingPlant> plant_;
    std::optional<RunResult> result_;
    std::optional<Eigen::Vector3d> last_mm_;
    double path_mm_ = 0.0;
    double tooth_force_N_ = 0.0;
};

}  // namespace millforce::sim
