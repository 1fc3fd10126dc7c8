// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cia402/drive_bus.hpp>
#include <cia402/sync_producer.hpp>
#include <cstdint>
#include <memory>
#include <vector>

#include "bus/canopen_drive.hpp"
#include "bus/loopback_bus.hpp"
#include "bus_settings.hpp"
#include "can_frames.hpp"

/// The driver as master or listener and simulated drives on one bus in memory.

namespace millforce::cia402::bench {

inline MappedObject mapped(std::uint16_t index, std::uint8_t bits) {
    return {index, 0, bits};
}

/// As a drive is delivered: position, current, statusword in TPDO 1.
inline PdoMapping first_pdo(std::uint8_t node_id) {
    PdoMapping pdo;
    pdo.id = cob_id::tpdo1 + node_id;
    pdo.object_count = 3;
    pdo.objects = {mapped(object::position_actual, 32), mapped(object::current_actual, 16),
                   mapped(object::statusword, 16)};
    return pdo;
}

inline DriveSettings spindle_drive(std::uint8_t node_id) {
    DriveSettings drive = test::a_drive();
    drive.node_id = node_id;
    drive.pdos[0] = first_pdo(node_id);
    return drive;
}

inline DriveSettings axis_drive(std::uint8_t node_id) {
    DriveSettings drive = spindle_drive(node_id);
    drive.velocity_source = VelocitySource::position;
    drive.position_mm_per_unit = 0.001F;
    return drive;
}

/// Spindle at node 1, x at node 2; the driver is master.
inline BusSettings two_drives() {
    BusSettings settings = test::a_bus();
    settings.is_master = true;
    settings.drives[0] = spindle_drive(1);
    settings.drives[1] = axis_drive(2);
    return settings;
}

/// A SYNC that this side sends; the bus takes it as it goes out.
class OwnSync {
  public:
    explicit OwnSync(const BusSettings& settings) : producer_(settings.sync_id, settings.sync_period_us) {}

    /// True where one goes out, in `frame`.
    bool poll(DriveBus& bus, std::uint64_t now_us, hal::CanFrame& frame) {
        if (!producer_.poll(now_us) || !producer_.take_frame(frame)) {
            return false;
        }
        bus.on_frame(frame, now_us);
        return true;
    }

  private:
    SyncProducer producer_;
};

class BusBench {
  public:
    explicit BusBench(const BusSettings& settings, bool produces_sync = true)
        : bus(settings), produces_sync_(produces_sync), sync_(settings) {
        master_ = wire.attach([this](const hal::CanFrame& frame, std::uint64_t t) { bus.on_frame(frame, t); });
    }

    sim::CanopenDrive& add_drive(const sim::CanopenDriveSettings& settings) {
        drives.push_back(std::make_unique<sim::CanopenDrive>(settings));
        sim::CanopenDrive* drive = drives.back().get();
        places_.push_back(wire.attach([drive](const hal::CanFrame& f, std::uint64_t t) { drive->on_frame(f, t); }));
        return *drive;
    }

    void run_us(std::uint64_t duration_us) {
        for (const std::uint64_t end_us = now_us + duration_us; now_us < end_us; now_us += 20) {
            step();
        }
    }
    void run_ms(std::uint64_t duration_ms) { run_us(1000 * duration_ms); }

    /// A frame by a stranger on the bus.
    void inject(const hal::CanFrame& frame) { wire.send(-1, frame, now_us); }

    sim::LoopbackBus wire{};
    DriveBus bus;
    std::vector<std::unique_ptr<sim::CanopenDrive>> drives{};
    std::vector<hal::DriveSample> samples{};
    std::uint64_t now_us = 1'000'000;

  private:
    void step() {
        bus.poll(now_us);
        hal::CanFrame frame;
        if (produces_sync_ && sync_.poll(bus, now_us, frame)) {
            wire.send(master_, frame, now_us);
        }
        while (bus.take_frame(frame)) {
            wire.send(master_, frame, now_us);
        }
        for (std::size_t k = 0; k < drives.size(); ++k) {
            drives[k]->poll(now_us);
            for (const hal::CanFrame& sent : drives[k]->take_frames()) {
                wire.send(places_[k], sent, now_us);
            }
        }
        wire.advance_to(now_us);
        hal::DriveSample sample;
        if (bus.take_sample(sample)) {
            samples.push_back(sample);
        }
    }

    bool produces_sync_;
    OwnSync sync_;
    int master_ = 0;
    std::vector<int> places_{};
};

/// With both drives powered and heartbeats at 20 ms.
class TwoDrives : public BusBench {
  public:
    explicit TwoDrives(const BusSettings& settings = two_drives(), bool produces_sync = true)
        : BusBench(settings, produces_sync) {
        add_drive({1, 12.0, 8.0, 20});
        add_drive({2, 10.0, 6.0, 20});
    }
    sim::CanopenDrive& spindle() { return *drives[0]; }
    sim::CanopenDrive& x() { return *drives[1]; }
    [[nodiscard]] const NodeHealth& spindle_health() const { return bus.health(DriveRole::spindle); }
    [[nodiscard]] const NodeHealth& x_health() const { return bus.health(DriveRole::x_axis); }
    [[nodiscard]] bool both_operational() const {
        return spindle_health().state == NodeState::operational && x_health().state == NodeState::operational;
    }
};

inline bool has(const hal::DriveSample& sample, hal::Present quantity) {
    return (sample.present & hal::mask(quantity)) != 0;
}

}  // namespace millforce::cia402::bench
