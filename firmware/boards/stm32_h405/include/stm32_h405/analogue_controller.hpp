// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "emergency/emergencies.hpp"
#include "firmware/parameter_block.hpp"
#include "firmware/tool_tick.hpp"
#include "firmware/tools_in_block.hpp"
#include "firmware_can/way_over_bus.hpp"
#include "hal/drive_sample.hpp"
#include "hal/reset_cause.hpp"
#include "override_frame/override_sender.hpp"
#include "program_status/position_frame.hpp"
#include "program_status/program_status_receiver.hpp"
#include "program_status/speed_frame.hpp"
#include "program_status/tool_frame.hpp"
#include "stm32/clock.hpp"
#include "stm32/watchdog.hpp"
#include "stm32_h405/analogue_drives.hpp"
#include "stm32_h405/wiring.hpp"

/// The controller on one chip: currents and encoders in, the override out on CAN. No interrupt: poll() in a loop.
///
/// What each event leads to:
///
/// | what happens | override | on the bus |
/// |---|---|---|
/// | start | hold until the first tick | boot-up, EMCY with the reset's cause |
/// | no parameters, or refused | hold, fault `bad_configuration` | EMCY 0x6300 with the reason |
/// | an input is missing or implausible | not raised; after `stale_s` hold, fault `stale_input` | EMCY 0x5000, fault |
/// | supply below 2.9 V | hold at once; its samples are not used | EMCY 0x3200 |
/// | fault of the tick | hold | the frame's fault, EMCY 0xFF00 |
/// | CNC falls silent | the tick holds the feed | the frame's hold bit |
/// | the CNC tells a tool that is not in the block, or none | the operator's (tool_tick.hpp) | EMCY 0xFF01 with the
/// number | | bus-off | silence: the CNC stops the feed after 20 ms | EMCY 0x8140 when the bus is back | | fault of the
/// processor | hold, heartbeat `stopped`, then reset | EMCY 0x6100 with the program counter, twice | | a tick that
/// hangs, or answers nonsense | silence, then the watchdog's reset | EMCY 0x6010 after it | | supply fails | silence,
/// reset by the brown-out circuit | EMCY 0x3200 after it |
///
/// A change of the tool, at rest, builds its tick: some 0.15 s without a frame, in which the CNC stops the feed by
/// itself. The tick of the new tool begins with the sample after it.
///
/// Where the CNC reports its position in the program (position_frame.hpp), a sender on the bus may hand over the part
/// map, a window at a time (way_over_bus.hpp). Without one, nothing is known of the way ahead.
///
/// A tick is healthy if its heartbeat went on by one and its ratio is within the limits; nothing else feeds the
/// watchdog. A missing input is no reason for a reset, which would not bring it back.
///
/// No heap. One thread. RAM: sizeof.

namespace millforce::stm32_h405 {

/// What is known before the controller starts.
struct StartReport {
    hal::ResetCause cause = hal::ResetCause::unknown;
    firmware::BlockError parameters = firmware::BlockError::none;
    bool had_processor_fault = false;
    std::uint32_t fault_program_counter = 0;
};

class AnalogueController {
  public:
    using Tick = firmware::SmallTick<float>;
    using Tools = firmware::ToolsInBlock<Tick>;

    AnalogueController(const Peripherals& peripherals, const Wiring& wiring);

    /// `parameters` are used where the report says that there are some, and outlive this. With `tools`, which outlive
    /// this and whose parameters these are, the CNC tells which of them is in the spindle.
    void start(const StartReport& report, const firmware::Parameters<float>& parameters, std::uint64_t now_us,
               const Tools* tools = nullptr);
    /// As often as possible, at least once per sample period.
    void poll(std::uint64_t now_us);
    /// Final frames: the feed held and why, by what CAN can still send; false where it could not. `has_patience()` is
    /// asked while frames are on their way, and says when to wait no longer.
    template <typename Patience>
    bool give_up(emergency::Reason reason, std::uint32_t detail, Patience has_patience) {
        can_.abort_all();
        while (!can_.is_all_sent() && has_patience()) {
        }
        const bool was_taken = send_final_frames(reason, detail);
        while (!can_.is_all_sent() && has_patience()) {
        }
        return was_taken && can_.is_all_sent();
    }
    /// Where the clock is no longer the crystal's: no frame at all.
    void fall_silent() { can_.leave_bus(); }

    [[nodiscard]] const hal::FeedOverride& output() const { return output_; }
    [[nodiscard]] const hal::DriveSample& sample() const { return sample_; }
    [[nodiscard]] const stm32::CanController& can() const { return can_; }
    [[nodiscard]] stm32::CurrentScan& currents() { return drives_.currents(); }
    [[nodiscard]] std::uint32_t late_ticks() const { return late_ticks_; }
    /// Number of the tool that the override is for; 0: without tools by number, or not known.
    [[nodiscard]] std::uint32_t tool() const { return tick_ ? tick_->tool() : 0; }

  private:
    void report_start(const StartReport& report);
    [[nodiscard]] bool has_position() const;
    void receive_frames(std::uint64_t now_us);
    void send_frames();
    bool send_final_frames(emergency::Reason reason, std::uint32_t detail);
    void run_tick(std::uint64_t now_us);
    [[nodiscard]] bool is_at_rest() const;
    [[nodiscard]] hal::FeedOverride step(std::uint64_t now_us);
    [[nodiscard]] hal::ProgramStatus program_at(std::uint64_t now_us) const;
    void follow_tool(std::uint64_t now_us);
    [[nodiscard]] hal::FeedOverride step_on_sample(const hal::ProgramStatus& program);
    [[nodiscard]] bool is_healthy(const hal::FeedOverride& output) const;

    Wiring wiring_;
    stm32::PwrRegisters& pwr_;
    AnalogueDrives drives_;
    stm32::CanController can_;
    stm32::Watchdog watchdog_;
    override_frame::OverrideSender sender_;
    program_status::ProgramStatusReceiver program_;
    program_status::ToolReceiver tool_;
    program_status::SpeedReceiver speed_;
    program_status::PositionReceiver position_;
    emergency::Emergencies emergencies_;
    std::array<hal::CanFilter, 5> filters_;

    const firmware::Parameters<float>* parameters_ = nullptr;
    std::optional<firmware::ToolTickOf<Tick, Tools>> tick_{};
    std::optional<firmware::WayOverBus<float>> way_{};
    bool was_tool_changed_ = false;  // at the last step
    float largest_ratio_ = 0.0F;
    std::uint32_t period_us_ = 1000;
    std::uint64_t next_tick_us_ = 0;
    std::uint64_t complete_us_ = 0;
    hal::DriveSample sample_{};
    hal::FeedOverride output_{};
    std::uint32_t bus_offs_ = 0;
    std::uint32_t late_ticks_ = 0;
};

}  // namespace millforce::stm32_h405
