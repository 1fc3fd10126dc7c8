// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstdint>
#include <span>

#include "cia402/drive_bus.hpp"
#include "cia402/sync_producer.hpp"
#include "firmware/tick_record.hpp"
#include "firmware/tool_tick.hpp"
#include "firmware/way_source.hpp"
#include "firmware_can/conditions.hpp"
#include "hal/can_frame.hpp"
#include "override_frame/override_sender.hpp"
#include "program_status/position_frame.hpp"
#include "program_status/program_status_receiver.hpp"
#include "program_status/speed_frame.hpp"
#include "program_status/tool_frame.hpp"

/// The whole controller on a CAN bus, without the bus: frames and times in, frames to send and one tick per SYNC out.
/// The daemon runs it over SocketCAN, the tests over a bus in memory, a replay over a log.
///
///     controller.on_frame(frame, time_us, is_own);     // every frame of the bus, the echo of its own SYNC too
///     controller.add(sample);                          // after a SYNC: what another hal::DriveSource knows of it
///     controller.poll(now_us);                         // at least once per SYNC period; at next_event_us()
///     while (controller.take_frame(frame)) { ... }     // send
///     finish_work(controller);                         // what may take milliseconds, now that the override is out
///
/// What the tick sees depends on the received frames, their times, and the order of frames and added samples alone: the
/// same of these give the same estimates, bit for bit, however late they were fetched and however often poll() came. So
/// that this holds by construction, the clock of poll() decides nothing that the tick sees: time passes with the frames
/// of filters(), which include this controller's own override and heartbeat. What is due before a frame's time is done
/// before the frame is processed. A cycle begins when the controller's SYNC comes back from the bus, at its time, and
/// the run begins, or begins again, when its boot-up comes back; the boot-up is repeated until then.
///
/// If no frame comes at all, not even one of this controller, no override could reach the CNC over the bus either.
/// After `stale_s` by the clock of poll() the override says hold, with a constant counter; when frames come again the
/// tick finds the gap in their times, and its fault is latched.
///
/// Supervision. A sample is complete if every configured drive and every source beside the bus gave all its values.
/// The tick begins with the first complete one and sees complete ones only; what lacks something is left out. After
/// five SYNC periods without a complete one the tick continues without: the feed is not raised then, and after the
/// CNC's `stale_s` it faults and holds the feed. The feed is held while a drive is in fault or quick stop, or while the
/// CNC is silent, and while another node sends this controller's override or heartbeat. A fault is latched until the
/// CNC resets it (program status frame) with all axes at rest.
///
/// A CNC that reports the speed of its spindle (speed_frame.hpp) has it compared with the encoder.
///
/// With a ToolSource the CNC reports which tool is in the spindle (tool_frame.hpp), and the tool's parameters change
/// with it, at rest (tool_tick.hpp).
///
/// With a WaySource the CNC reports where in its program the tool is (position_frame.hpp), and the tick looks ahead. It
/// may have its map over this bus (way_over_bus.hpp).
///
/// No heap, no operating system. One thread. Cost: that of the tick; some 20 kB of RAM.

namespace millforce::firmware {

struct CanControllerSettings {
    cia402::BusSettings drives{};  ///< check(drives) == none
    bool produces_sync = false;    ///< else the CNC or a drive does
    override_frame::OverrideSenderSettings feed_override{};
    program_status::ProgramStatusReceiverSettings program{};
    /// Begin with the first frame: a replay of a log that holds no boot-up.
    bool begins_at_once = false;
};

class CanController;

/// Called after each tick, from within on_frame() and poll().
class TickListener {
  public:
    virtual void on_tick(const CanController& controller) = 0;

  protected:
    ~TickListener() = default;
};

class CanController {
  public:
    static constexpr std::size_t filter_capacity = cia402::DriveBus::filter_capacity + 7;

    /// With `tools`, which outlives this, `parameters.tool` is any tool. `way`: what lies ahead of the tool in the
    /// spindle; it outlives this.
    CanController(const CanControllerSettings& settings, const Parameters<float>& parameters,
                  TickListener* listener = nullptr, const ToolSource* tools = nullptr, WaySource<float>* way = nullptr);

    /// `is_own`: the echo of a frame that this controller's program sent.
    void on_frame(const hal::CanFrame& frame, std::uint64_t time_us, bool is_own);
    /// Of the newest SYNC: what drives.beside_bus names. Its own time is not used.
    void add(const hal::DriveSample& beside_bus);
    void poll(std::uint64_t now_us);
    [[nodiscard]] bool take_frame(hal::CanFrame& frame);
    /// The tick's work beside its steps, in slices. What is not done by then is done before the next sample, so that
    /// the estimates do not depend on when it was done.
    [[nodiscard]] bool work_due() const { return tick_.work_due(); }
    void work() { tick_.work(); }
    /// From the next tick on, and while this is requested, the override says hold. The tick does not see it.
    void hold_from_outside(bool is_held) { is_held_outside_ = is_held; }
    /// No more ticks nor SYNC: the override says hold at once, and the heartbeat `stopped` a little later.
    void stop(std::uint64_t now_us);

    [[nodiscard]] std::uint64_t next_event_us(std::uint64_t now_us) const;
    /// Ids of the frames that on_frame() uses, and that its time passes with; returns how many.
    std::size_t filters(std::span<hal::CanFilter, filter_capacity> filters) const;

    /// The newest tick: its time, what went in and what came out.
    [[nodiscard]] std::uint64_t tick_time_us() const { return tick_time_us_; }
    [[nodiscard]] const hal::DriveSample& sample() const { return sample_; }
    [[nodiscard]] const hal::ProgramStatus& program() const { return program_; }
    [[nodiscard]] const hal::FeedOverride& output() const { return output_; }
    /// The output as it is sent to the CNC: with the holds that do not come from the tick.
    [[nodiscard]] hal::FeedOverride sent_override() const;
    [[nodiscard]] const ForceControlTick<float>& controller() const { return tick_.of_tool(); }
    [[nodiscard]] TickRecord record() const { return tick_record(tick_.of_tool(), output_, tick_time_us_); }
    /// Number of the tool that the override is for; 0: without a source of tools, or not known.
    [[nodiscard]] std::uint32_t tool() const { return tick_.tool(); }
    /// The number that the CNC sends; 0: none.
    [[nodiscard]] std::uint32_t reported_tool() const { return tool_receiver_.number(bus_time_us_); }
    [[nodiscard]] std::uint32_t ticks() const { return output_.heartbeat; }

    [[nodiscard]] const Conditions& conditions() const { return conditions_; }
    [[nodiscard]] const cia402::DriveBus& drives() const { return bus_; }
    [[nodiscard]] std::uint32_t foreign_syncs() const { return foreign_syncs_; }
    [[nodiscard]] std::uint32_t syncs_skipped() const { return sync_.skipped(); }

  private:
    void begin();
    void repeat_boot_up(std::uint64_t now_us);
    void watch_silence(std::uint64_t now_us);
    [[nodiscard]] bool is_used(const hal::CanFrame& frame) const;
    void advance_to(std::uint64_t time_us);
    void run_ticks();
    void tick_on_sample();
    void tick_without_sample();
    void finish(const hal::FeedOverride& output, std::uint64_t time_us);
    [[nodiscard]] hal::ProgramStatus program_at(std::uint64_t time_us) const;
    void reset_fault_where_asked();
    [[nodiscard]] bool is_at_rest() const;
    [[nodiscard]] bool is_any_drive_stopped() const;
    [[nodiscard]] bool has_complete_sample() const;
    [[nodiscard]] bool is_own_output(const hal::CanFrame& frame) const;
    void judge(std::uint64_t now_us);

    CanControllerSettings settings_;
    Parameters<float> parameters_;
    const ToolSource* tools_;
    WaySource<float>* way_;
    std::bitset<hal::largest_standard_can_id + 1> used_ids_{};
    bool is_running_;         ///< this controller's boot-up was on the bus
    bool was_heard_ = false;  ///< a frame came since the last poll()
    bool has_begun_ = false;  ///< a complete sample came
    bool is_silent_ = false;
    bool is_held_outside_ = false;
    bool stopped_ = false;
    std::uint64_t stale_us_;
    std::uint64_t silent_after_us_;
    cia402::DriveBus bus_;
    cia402::SyncProducer sync_;
    program_status::ProgramStatusReceiver program_receiver_;
    program_status::ToolReceiver tool_receiver_;
    program_status::SpeedReceiver speed_receiver_;
    program_status::PositionReceiver position_receiver_;
    override_frame::OverrideSender sender_;
    ToolTick tick_;
    TickListener* listener_;

    std::uint64_t next_boot_up_us_ = 0;
    std::uint64_t heard_us_ = 0;  ///< by the clock of poll()
    std::uint64_t bus_time_us_ = 0;
    std::uint64_t sync_time_us_ = 0;      ///< time of the newest sample
    std::uint64_t complete_time_us_ = 0;  ///< time of the newest complete one
    std::uint64_t next_silent_us_ = 0;
    std::uint64_t tick_time_us_ = 0;
    hal::DriveSample sample_{};
    hal::ProgramStatus program_{};
    hal::FeedOverride output_{};
    Conditions conditions_{};
    std::uint32_t foreign_syncs_ = 0;
    std::uint64_t foreign_sync_us_ = 0;
    bool is_override_foreign_ = false;
    std::uint64_t foreign_override_us_ = 0;
};

}  // namespace millforce::firmware
