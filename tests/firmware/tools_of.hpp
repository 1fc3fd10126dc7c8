// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "firmware/tool_source.hpp"

namespace millforce::test {

/// Ticks by the numbers of their tools, ready to be copied.
class ToolsOf final : public firmware::ToolSource {
  public:
    ToolsOf(const firmware::MachineParameters<float>& machine,
            const std::map<std::uint32_t, firmware::ToolParameters<float>>& tools) {
        for (const auto& [number, tool] : tools) {
            ticks_.emplace(number, firmware::Parameters<float>{machine, tool});
        }
    }
    [[nodiscard]] bool has(std::uint32_t number) const override { return ticks_.contains(number); }
    void set_up(std::uint32_t number, firmware::ForceControlTick<float>& tick) const override {
        tick = has(number) ? ticks_.at(number) : ticks_.begin()->second;
    }

  private:
    std::map<std::uint32_t, firmware::ForceControlTick<float>> ticks_{};
};

}  // namespace millforce::test
