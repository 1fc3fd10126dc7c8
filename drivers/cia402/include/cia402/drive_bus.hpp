// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cia402/drive_node.hpp"
#include "cia402/drive_settings.hpp"
#include "cia402/rejects.hpp"
#include "cia402/sync_clock.hpp"
#include "hal/can_frame.hpp"
#include "hal/drive_sample.hpp"
#include "hal/drive_source.hpp"

/// The drives of a machine on one CANopen bus: frames in, one hal::DriveSample per SYNC period and frames to send out.
///
///     while (...) {
///         bus.on_frame(frame, frame_time_us);        // each received frame
///         bus.poll(now_us);                          // at least once per SYNC period
///         while (bus.take_frame(frame)) { ... }      // send; what cannot be sent is dropped, the bus repeats itself
///         if (bus.take_sample(sample)) { ... }       // run the tick
///     }
///
/// SYNC comes by on_frame(), whoever produces it: a SyncProducer of this computer, too, by its echo from the bus.
/// What another source knows of a SYNC period (BusSettings::beside_bus) is given by add() once the SYNC is there.
///
/// A pure state machine: no clock, no operating system, no heap, no exceptions. Times are µs of any clock that does not
/// run backwards. Cost per frame: a search over at most 4 drives × 4 PDOs; 0.8 µs for a whole SYNC
/// period of four drives on a desktop processor. 3.2 KB of RAM. One thread.
///
/// PDOs do not say which SYNC they belong to: what arrives belongs to the last one, and of two in one period the second
/// counts. A PDO that was missing may still come in the next period, as if it were timely. So a period after one that
/// lacked a PDO, or had one after its sample, lasts until the next SYNC: by then the drive has answered for itself. A
/// drive that is late by a whole period at every SYNC cannot be told from a timely one.

namespace millforce::cia402 {

struct BusHealth {
    bool sync_lost = false;  ///< no SYNC for three periods, or none yet
    std::uint32_t syncs = 0;
    std::uint32_t samples_untaken = 0;     ///< a sample was overwritten by the next
    std::uint32_t samples_incomplete = 0;  ///< handed over with a PDO missing
};

class DriveBus final : public hal::DriveSource {
  public:
    static constexpr std::size_t filter_capacity = 1 + drive_capacity * (largest_pdo_count + 3);

    /// The settings have passed check(); others make every frame be rejected.
    explicit DriveBus(const BusSettings& settings);

    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us);
    void poll(std::uint64_t time_us) override;
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);
    /// What another source gives for the SYNC period in work; the last one counts. Not used where no period is open.
    void add(const hal::DriveSample& beside_bus);
    /// True once per SYNC period. The sample's time is when the drives latched it: see SyncClock.
    [[nodiscard]] bool take_sample(hal::DriveSample& sample) override;
    /// Of all configured drives, and what is given beside the bus.
    [[nodiscard]] std::uint8_t complete() const override { return complete_; }
    [[nodiscard]] hal::SourceState state() const override;
    /// Drives have not answered the last SYNC yet.
    [[nodiscard]] bool is_collecting() const { return cycle_open_ && !is_complete(); }
    /// When poll() has something to do at the latest: within a SYNC period, or at the end of collection.
    [[nodiscard]] std::uint64_t next_event_us(std::uint64_t now_us) const;

    /// Ids that on_frame() can use, for the controller's or the kernel's filters; returns how many.
    std::size_t filters(std::span<hal::CanFilter, filter_capacity> filters) const;

    [[nodiscard]] const NodeHealth& health(DriveRole role) const;
    [[nodiscard]] const BusHealth& health() const { return health_; }
    [[nodiscard]] const RejectCounters& rejects() const { return rejects_; }
    [[nodiscard]] const DriveNode& node(DriveRole role) const { return nodes_[static_cast<std::size_t>(role)]; }

  private:
    void on_sync(const hal::CanFrame& frame, std::uint64_t time_us);
    void begin_cycle(std::uint64_t time_us);
    [[nodiscard]] bool may_end_before_next_sync() const { return cycle_open_ && !may_be_answers_to_last_; }
    void hand_over_when_complete();
    void hand_over();
    void put(std::size_t role, const DriveReading& reading);
    [[nodiscard]] bool is_sync_pdo(std::size_t role, std::uint32_t id) const;
    [[nodiscard]] bool is_complete() const;
    [[nodiscard]] bool have_all_answered() const;

    BusSettings settings_;
    std::uint8_t complete_ = 0;
    std::array<DriveNode, drive_capacity> nodes_{};
    RejectCounters rejects_{};
    BusHealth health_{};
    SyncClock sync_clock_;
    hal::DriveSample sample_{};
    hal::DriveSample beside_bus_{};  ///< sample of the SYNC period in work
    bool has_beside_bus_ = false;
    bool sample_ready_ = false;
    bool had_sample_ = false;
    bool cycle_open_ = false;
    bool an_answer_is_late_ = false;       ///< of this SYNC: one is missing, or came after the sample
    bool may_be_answers_to_last_ = false;  ///< what comes after this SYNC, until it is repeated
    bool had_sync_ = false;
    std::uint64_t sync_time_us_ = 0;  ///< by its stamp
};

}  // namespace millforce::cia402
