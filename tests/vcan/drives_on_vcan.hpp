// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "bus/canopen_drive.hpp"
#include "bus_peers.hpp"
#include "bus_settings.hpp"
#include "cia402/drive_bus.hpp"
#include "cia402/sync_producer.hpp"

/// Simulated drives in a process of their own, and the driver's bus on a socket.

namespace millforce::vcan {

inline constexpr int counts_per_sync = 137;

/// A plain blocking socket: the drives share nothing with the driver under test.
class PlainSocket {
  public:
    explicit PlainSocket(const std::string& interface) : descriptor_(socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
        sockaddr_can address{};
        address.can_family = AF_CAN;
        address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
        if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
            std::perror("bind");
        }
    }
    ~PlainSocket() { close(descriptor_); }
    PlainSocket(const PlainSocket&) = delete;
    PlainSocket& operator=(const PlainSocket&) = delete;

    [[nodiscard]] bool receive(hal::CanFrame& frame) const {
        pollfd waited{descriptor_, POLLIN, 0};
        can_frame raw{};
        if (poll(&waited, 1, 1) != 1 || read(descriptor_, &raw, sizeof raw) != sizeof raw) {
            return false;
        }
        frame.id = raw.can_id & CAN_EFF_MASK;
        frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
        frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
        frame.length = raw.len;
        std::copy_n(std::begin(raw.data), 8, frame.data.begin());
        return true;
    }
    /// When the kernel got the last frame received, on its own clock.
    [[nodiscard]] std::int64_t time_of_last_us() const {
        timeval time{};
        return ioctl(descriptor_, SIOCGSTAMP, &time) == 0 ? time.tv_sec * 1'000'000 + time.tv_usec : 0;
    }
    bool send(const hal::CanFrame& frame) const {
        can_frame raw{};
        raw.can_id = frame.id;
        raw.len = frame.length;
        std::copy_n(frame.data.begin(), 8, std::begin(raw.data));
        if (write(descriptor_, &raw, sizeof raw) == sizeof raw) {
            return true;
        }
        if (errno != ENOBUFS && errno != ENETDOWN) {
            std::perror("write");
        }
        return false;
    }

  private:
    int descriptor_;
};

/// What passed a process of the bus; in memory that processes share.
struct FrameCounts {
    std::atomic<std::uint64_t> syncs{0};
    std::atomic<std::uint64_t> pdos{0};
    std::atomic<std::uint64_t> overrides{0};
};

inline bool is_sync(const hal::CanFrame& frame) {
    return frame.id == cia402::cob_id::sync;
}
inline bool is_pdo(const hal::CanFrame& frame) {
    return frame.id > 0x180 && frame.id <= 0x180 + cia402::drive_capacity;
}

/// Drives at nodes 1…count, heartbeat 20 ms. At each SYNC every one moves by `counts_per_sync`; node 1 draws 6 A.
/// `counts`: SYNCs that came, PDOs that went out.
inline void run_drives(const std::string& interface, int count, FrameCounts* counts = nullptr) {
    const PlainSocket socket(interface);
    std::vector<std::unique_ptr<sim::CanopenDrive>> drives;
    for (int node = 1; node <= count; ++node) {
        sim::CanopenDriveSettings settings;
        settings.node_id = static_cast<std::uint8_t>(node);
        settings.heartbeat_ms = 20;
        drives.push_back(std::make_unique<sim::CanopenDrive>(settings));
        drives.back()->set_current_A(6.0);
    }
    std::int32_t position = 0;
    for (;;) {
        hal::CanFrame frame;
        const bool received = socket.receive(frame);
        const std::uint64_t now_us = socketcan::monotonic_us();
        if (received && is_sync(frame)) {
            position += counts_per_sync;
            if (counts != nullptr) {
                ++counts->syncs;
            }
        }
        for (const auto& drive : drives) {
            drive->set_position(position);
            if (received) {
                drive->on_frame(frame, now_us);
            }
            drive->poll(now_us);
            for (const hal::CanFrame& sent : drive->take_frames()) {
                if (socket.send(sent) && counts != nullptr && is_pdo(sent)) {
                    ++counts->pdos;
                }
            }
        }
    }
}

inline cia402::DriveSettings drive_settings(std::size_t role) {
    using namespace cia402;
    DriveSettings drive = test::a_drive();
    drive.node_id = static_cast<std::uint8_t>(role + 1);
    drive.heartbeat_timeout_us = 200'000;
    drive.pdos[0].id = 0x181 + static_cast<std::uint32_t>(role);
    drive.pdos[0].object_count = 3;
    drive.pdos[0].objects = {MappedObject{object::position_actual, 0, 32}, MappedObject{object::current_actual, 0, 16},
                             MappedObject{object::statusword, 0, 16}};
    drive.velocity_source = VelocitySource::position;
    drive.position_mm_per_unit = 0.0001F;
    return drive;
}

inline cia402::BusSettings bus_settings(std::size_t drives, std::uint32_t period_us) {
    cia402::BusSettings settings = test::a_bus();
    settings.is_master = true;
    settings.sync_period_us = period_us;
    settings.collect_us = period_us;
    for (std::size_t role = 0; role < drives; ++role) {
        settings.drives[role] = drive_settings(role);
    }
    return settings;
}

/// The driver's whole way: socket, bus, samples.
class BusOnVcan {
  public:
    explicit BusOnVcan(const cia402::BusSettings& settings, bool produces_sync = true)
        : bus(settings),
          socket(socket_settings(bus)),
          sync(settings.sync_id, settings.sync_period_us),
          produces_sync_(produces_sync) {}

    void run_ms(int duration_ms) {
        const std::uint64_t end_us = socketcan::monotonic_us() + 1000ULL * static_cast<unsigned>(duration_ms);
        while (socketcan::monotonic_us() < end_us) {
            step();
        }
    }
    bool run_until(const std::function<bool()>& holds) {
        return step_until(holds, [this] { step(); });
    }
    [[nodiscard]] bool all_operational(std::size_t drives) const {
        return all_are(drives, cia402::NodeState::operational);
    }
    [[nodiscard]] bool all_are(std::size_t drives, cia402::NodeState state) const {
        for (std::size_t role = 0; role < drives; ++role) {
            if (bus.health(static_cast<cia402::DriveRole>(role)).state != state) {
                return false;
            }
        }
        return true;
    }

    cia402::DriveBus bus;
    socketcan::CanSocket socket;
    std::vector<hal::DriveSample> samples{};
    std::function<void(const hal::DriveSample&)> on_sample = [this](const auto& sample) { samples.push_back(sample); };
    FrameCounts counts{};  ///< SYNCs that went out, PDOs that came
    cia402::SyncProducer sync;

    /// Fetches what is there, and sends nothing.
    void drain() {
        hal::CanFrame frame;
        std::uint64_t time_us = 0;
        while (socket.receive(frame, time_us)) {
            counts.pdos += is_pdo(frame) ? 1U : 0U;
            bus.on_frame(frame, time_us);
            take_sample();
        }
    }

  private:
    static socketcan::CanSocketSettings socket_settings(const cia402::DriveBus& bus) {
        auto settings = on(controller_interface());
        std::array<hal::CanFilter, cia402::DriveBus::filter_capacity> filters{};
        settings.filter_count = bus.filters(filters);
        std::copy_n(filters.begin(), settings.filter_count, settings.filters.begin());
        return settings;
    }
    void step() {
        std::uint64_t now_us = socketcan::monotonic_us();
        socket.wait(next_event_us(now_us) - now_us);
        now_us = socketcan::monotonic_us();
        socket.poll(now_us);
        drain();
        now_us = socketcan::monotonic_us();
        bus.poll(now_us);
        hal::CanFrame frame;
        const bool sends_sync = produces_sync_ && sync.poll(now_us) && sync.take_frame(frame);
        if (sends_sync) {
            bus.on_frame(frame, now_us);
        }
        take_sample();
        counts.syncs += sends_sync && socket.send(frame) ? 1U : 0U;
        while (bus.take_frame(frame)) {
            socket.send(frame);
        }
    }
    [[nodiscard]] std::uint64_t next_event_us(std::uint64_t now_us) const {
        const std::uint64_t of_bus_us = bus.next_event_us(now_us);
        const bool has_begun = produces_sync_ && sync.next_us() != 0;
        return has_begun ? std::max(now_us, std::min(of_bus_us, sync.next_us())) : of_bus_us;
    }
    void take_sample() {
        hal::DriveSample sample;
        if (bus.take_sample(sample)) {
            on_sample(sample);
        }
    }

    bool produces_sync_;
};

}  // namespace millforce::vcan
