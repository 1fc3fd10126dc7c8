// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bus/canopen_drive.hpp"
#include "hal/can_frame.hpp"
#include "hal/drive_sample.hpp"

namespace millforce::sim {

/// How one drive of a simulated machine is wired.
struct DriveOnBus {
    std::uint8_t node_id = 1;
    double rated_current_A = 12.0;  ///< as the drive defines it, rms or peak
    double drive_A_per_A = 1.0;     ///< what the drive calls current over A rms: √2 for peak, negative where reversed
    double rated_torque_Nm = 8.0;
    double torque_Nm_per_A = 0.0;       ///< per ampere as the drive defines it
    double velocity_unit_mm_s = 0.001;  ///< unit of 0x606C
    double position_unit_mm = 0.0001;   ///< unit of 0x6064
    bool count_reversed = false;
    std::uint32_t encoder_counts_per_rev = 8192;
};

/// Spindle, x, y, z.
struct MachineOnBusSettings {
    std::array<DriveOnBus, 1 + hal::axis_count> drives{DriveOnBus{1}, DriveOnBus{2}, DriveOnBus{3}, DriveOnBus{4}};
    std::uint16_t heartbeat_ms = 50;
};

/// A machine's four drives as one participant of a bus: sensor values go in, frames go in and out. By default each
/// sends TPDO 1 with position, current and statusword; velocity (0x606C) and the spindle's index pulse (0x60BA, 0x60D5)
/// can be mapped.
class MachineOnBus {
  public:
    explicit MachineOnBus(const MachineOnBusSettings& settings);

    /// Values that are not present in the sample keep their last value. The positions of the axes are the sum of their
    /// velocities.
    void set(const hal::DriveSample& sample);
    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    void poll(std::uint64_t time_us);
    [[nodiscard]] std::vector<hal::CanFrame> take_frames();

    /// 0: spindle, 1…3: x, y, z.
    [[nodiscard]] CanopenDrive& drive(std::size_t place) { return drives_.at(place); }

  private:
    void set_current(std::size_t place, float current_A);
    void set_axis(std::size_t axis, const hal::DriveSample& sample, double elapsed_s);
    [[nodiscard]] std::int32_t count_of(std::uint32_t count) const;

    MachineOnBusSettings settings_;
    std::vector<CanopenDrive> drives_;
    std::array<double, hal::axis_count> position_mm_{};
    std::uint32_t last_time_us_ = 0;
    std::uint8_t last_index_number_ = 0;
    bool has_time_ = false;
};

}  // namespace millforce::sim
