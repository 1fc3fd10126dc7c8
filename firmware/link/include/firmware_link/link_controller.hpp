// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "firmware/tool_tick.hpp"
#include "firmware/way_source.hpp"
#include "firmware_link/link_drives.hpp"
#include "local_link/messages.hpp"

/// The whole controller behind a local link, without the socket: the bytes of a sample in, the bytes of the override
/// out. One instance per connection.
///
/// Only the samples' own time counts: the same messages give the same answers, bit for bit, however late they
/// come. So it does not notice missing samples; the other end watches the heartbeat of the answers. A gap in the
/// samples' time (the bridge dropped some) breaks the averages, and beyond the CNC's `stale_s` it is the
/// fault `stale_input`.
///
/// A fault is latched until a sample with a reset comes, after one without, with all axes at rest.
///
/// With a ToolSource the samples say which tool is in the spindle, and the tool's parameters change with it, at rest
/// (tool_tick.hpp).
///
/// No heap, no operating system. One thread. Cost: that of the tick.

namespace millforce::firmware {

/// The machine, with an override_max that the CNC's input takes.
[[nodiscard]] MachineParameters<float> capped(const MachineParameters<float>& machine, float largest_override);

class LinkController {
  public:
    /// `largest_override`: what the CNC's input takes; caps the machine's override_max. `way`: what lies ahead of the
    /// tool in the spindle. With `tools`, `parameters.tool` is any tool of it. Both outlive this.
    LinkController(const Parameters<float>& parameters, float largest_override, WaySource<float>* way = nullptr,
                   const ToolSource* tools = nullptr);

    /// `answer` is written if the bytes are valid.
    [[nodiscard]] local_link::MessageError on_message(std::span<const std::uint8_t> bytes,
                                                      local_link::OverrideBytes& answer);

    /// While this is requested, the answers say hold. The tick does not see it.
    void hold_from_outside(bool is_held) { is_held_outside_ = is_held; }

    /// The tick's work beside its steps, in slices, for after the answer was sent. What is left is done before the next
    /// sample.
    [[nodiscard]] bool work_due() const { return tick_.work_due(); }
    void work() { tick_.work(); }

    [[nodiscard]] const ForceControlTick<float>& tick() const { return tick_.of_tool(); }
    [[nodiscard]] bool is_tool_known() const { return tick_.is_tool_known(); }
    [[nodiscard]] bool is_tool_change_due() const { return tick_.is_change_due(); }
    /// Number of the tool that the override is for; 0: without a source of tools, or not known.
    [[nodiscard]] std::uint32_t tool() const { return tick_.tool(); }
    [[nodiscard]] const hal::FeedOverride& output() const { return output_; }
    /// The answer says hold: by the tick, or from outside.
    [[nodiscard]] bool is_held() const { return output_.hold || is_held_outside_; }
    /// What went into the newest tick.
    [[nodiscard]] const hal::DriveSample& sample() const { return sample_; }
    [[nodiscard]] const hal::ProgramStatus& program() const { return program_; }

  private:
    void bridge_gap(std::uint32_t time_us, const hal::ProgramStatus& program);
    void reset_where_asked(const local_link::SampleMessage& message);
    [[nodiscard]] local_link::OverrideMessage answer_to(std::uint32_t sequence) const;

    LinkDrives drives_{};
    ToolTick tick_;
    hal::DriveSample sample_{};
    hal::ProgramStatus program_{};
    hal::FeedOverride output_{};
    float largest_override_;
    WaySource<float>* way_;
    bool has_time_ = false;
    bool was_reset_ = true;
    bool is_held_outside_ = false;
    std::uint32_t time_us_ = 0;
};

}  // namespace millforce::firmware
