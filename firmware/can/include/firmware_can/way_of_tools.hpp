// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/ready_tools.hpp"
#include "firmware_can/way_over_bus.hpp"

namespace millforce::firmware {

/// The part map over the bus of whichever tool is in the spindle (way_over_bus.hpp): with another tool the window is
/// empty, and a sender that has a map for this one fills it. No heap. One thread.
class WayOfTools final : public WaySource<float> {
  public:
    /// `tools` outlive this; null: one tool, that of `parameters`.
    WayOfTools(const Parameters<float>& parameters, std::uint8_t node_id, const ReadyTools* tools)
        : way_(parameters, tool_checksum(parameters.tool), node_id), tools_(tools) {}

    void set_tool(std::uint32_t number) override {
        if (const ReadyTool* tool = tools_ != nullptr ? tools_->tool(number) : nullptr) {
            way_.change_tool(*tool->along, tool->checksum);
        }
    }

    void look_ahead(ForceControlTick<float>& tick, const hal::ProgramStatus& program) override {
        way_.look_ahead(tick, program);
    }
    [[nodiscard]] bool is_refuted() const override { return way_.is_refuted(); }
    [[nodiscard]] std::uint32_t frame_id() const override { return way_.frame_id(); }
    void on_frame(const hal::CanFrame& frame) override { way_.on_frame(frame); }
    void begin_again() override { way_.begin_again(); }
    [[nodiscard]] bool take_frame(hal::CanFrame& frame) override { return way_.take_frame(frame); }

  private:
    WayOverBus<float> way_;
    const ReadyTools* tools_;
};

}  // namespace millforce::firmware
