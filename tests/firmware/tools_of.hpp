// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/tool_source.hpp"

namespace millforce::test {

struct ReadyTool {
    std::uint32_t number;
    firmware::ForceControlTick<float> tick;
};

/// Ticks of tools, ready to be copied. No heap: a case may keep them for the next one.
template <std::size_t count>
class ToolsOf final : public firmware::ToolSource {
  public:
    explicit ToolsOf(const std::array<ReadyTool, count>& tools) : tools_(tools) {}

    [[nodiscard]] bool has(std::uint32_t number) const override { return find(number) != nullptr; }
    void set_up(std::uint32_t number, firmware::ForceControlTick<float>& tick) const override {
        const ReadyTool* tool = find(number);
        tick = tool != nullptr ? tool->tick : tools_.front().tick;
    }

  private:
    [[nodiscard]] const ReadyTool* find(std::uint32_t number) const {
        for (const ReadyTool& tool : tools_) {
            if (tool.number == number) {
                return &tool;
            }
        }
        return nullptr;
    }

    std::array<ReadyTool, count> tools_;
};

}  // namespace millforce::test
