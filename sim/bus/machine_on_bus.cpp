// SPDX-License-Identifier: Apache-2.0
#include "bus/machine_on_bus.hpp"

#include <cmath>

namespace millforce::sim {

namespace {

/// 0x60A9 by CiA 402-2: m/s with a power of ten in the highest byte. A unit that is none has no such number: 0.
std::uint32_t si_unit_of(double unit_mm_s) {
    const double power = std::log10(unit_mm_s * 1e-3);
    const double whole = std::round(power);
    constexpr std::uint32_t metre_per_second = 0x00010300;
    return std::abs(power - whole) < 1e-6
               ? metre_per_second |
                     static_cast<std::uint32_t>(static_cast<std::uint8_t>(static_cast<std::int8_t>(whole))) << 24U
               : 0;
}

}  // namespace

MachineOnBus::MachineOnBus(const MachineOnBusSettings& settings) : settings_(settings) {
    for (const DriveOnBus& wired : settings.drives) {
        CanopenDriveSettings drive;
        drive.node_id = wired.node_id;
        drive.rated_current_A = wired.rated_current_A;
        drive.rated_torque_Nm = wired.rated_torque_Nm;
        drive.heartbeat_ms = settings.heartbeat_ms;
        drive.encoder_counts_per_rev = wired.encoder_counts_per_rev;
        drive.velocity_unit = si_unit_of(wired.velocity_unit_mm_s);
        drives_.emplace_back(drive);
    }
}

void MachineOnBus::set(const hal::DriveSample& sample) {
    const double elapsed_s = has_time_ ? 1e-6 * static_cast<std::uint32_t>(sample.time_us - last_time_us_) : 0.0;
    has_time_ = true;
    last_time_us_ = sample.time_us;
    if ((sample.present & hal::mask(hal::Present::spindle_current)) != 0) {
        set_current(0, sample.spindle_current_A);
    }
    if ((sample.present & hal::mask(hal::Present::spindle_count)) != 0) {
        drives_[0].set_position(count_of(sample.spindle_count));
    }
    if (sample.spindle_index_number != last_index_number_) {
        last_index_number_ = sample.spindle_index_number;
        drives_[0].latch_index(count_of(sample.spindle_index_count));
    }
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        if ((sample.present & hal::axis_mask(axis)) != 0) {
            set_axis(axis, sample, elapsed_s);
        }
    }
}

std::int32_t MachineOnBus::count_of(std::uint32_t count) const {
    return static_cast<std::int32_t>(settings_.drives[0].count_reversed ? 0U - count : count);
}

void MachineOnBus::set_current(std::size_t place, float current_A) {
    const DriveOnBus& wired = settings_.drives[place];
    const double drive_A = static_cast<double>(current_A) * wired.drive_A_per_A;
    drives_[place].set_current_A(drive_A);
    drives_[place].set_torque_Nm(drive_A * wired.torque_Nm_per_A);
}

void MachineOnBus::set_axis(std::size_t axis, const hal::DriveSample& sample, double elapsed_s) {
    const auto velocity_mm_s = static_cast<double>(sample.axis_velocity_mm_s[axis]);
    position_mm_[axis] += velocity_mm_s * elapsed_s;
    CanopenDrive& drive = drives_[1 + axis];
    const DriveOnBus& wired = settings_.drives[1 + axis];
    set_current(1 + axis, sample.axis_current_A[axis]);
    drive.set_velocity(static_cast<std::int32_t>(std::lround(velocity_mm_s / wired.velocity_unit_mm_s)));
    drive.set_position(static_cast<std::int32_t>(std::lround(position_mm_[axis] / wired.position_unit_mm)));
}

void MachineOnBus::on_frame(const hal::CanFrame& frame, std::uint64_t time_us) {
    for (CanopenDrive& drive : drives_) {
        drive.on_frame(frame, time_us);
    }
}

void MachineOnBus::poll(std::uint64_t time_us) {
    for (CanopenDrive& drive : drives_) {
        drive.poll(time_us);
    }
}

std::vector<hal::CanFrame> MachineOnBus::take_frames() {
    std::vector<hal::CanFrame> frames;
    for (CanopenDrive& drive : drives_) {
        const auto more = drive.take_frames();
        frames.insert(frames.end(), more.begin(), more.end());
    }
    return frames;
}

}  // namespace millforce::sim
