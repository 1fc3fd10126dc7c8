// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "firmware/along_path.hpp"
#include "firmware/parameter_block.hpp"
#include "firmware/tool_checksum.hpp"
#include "firmware/tool_source.hpp"

namespace millforce::firmware {

/// Memory for the tick of one tool: 18 KiB.
struct ReadyTool {
    std::uint32_t number = 0;
    std::optional<ForceControlTick<float>> tick{};
    std::optional<AlongPath<float>> along{};  ///< this and the checksum: for its part map
    std::uint32_t checksum = 0;               ///< tool_checksum()
};

/// Tools whose ticks are built at the start, so that a change copies one. No heap.
class ReadyTools final : public ToolSource {
  public:
    /// `memory` outlives this; no more tools than it has places can be added.
    explicit ReadyTools(std::span<ReadyTool> memory) : memory_(memory) {}

    void add(std::uint32_t number, const Parameters<float>& parameters) {
        ReadyTool& tool = memory_[count_];
        tool.number = number;
        tool.tick.emplace(parameters);
        tool.along.emplace(parameters);
        tool.checksum = tool_checksum(parameters.tool);
        ++count_;
    }

    /// The tools of a block. `parameters`: of its machine; the tool is overwritten.
    void add(const BlockTools& of_block, Parameters<float>& parameters) {
        for (std::size_t place = 0; place < of_block.size(); ++place) {
            if (of_block.read_at(place, parameters.tool)) {
                add(of_block.number_at(place), parameters);
            }
        }
    }

    [[nodiscard]] bool has(std::uint32_t number) const override { return place_of(number) < count_; }
    void set_up(std::uint32_t number, ForceControlTick<float>& tick) const override {
        const std::size_t place = place_of(number);
        tick = *memory_[place < count_ ? place : 0].tick;
    }

    /// Null where there is no such tool.
    [[nodiscard]] const ReadyTool* tool(std::uint32_t number) const {
        const std::size_t place = place_of(number);
        return place < count_ ? &memory_[place] : nullptr;
    }

  private:
    /// The count where there is no such tool.
    [[nodiscard]] std::size_t place_of(std::uint32_t number) const {
        std::size_t place = 0;
        while (place < count_ && memory_[place].number != number) {
            ++place;
        }
        return place;
    }

    std::span<ReadyTool> memory_;
    std::size_t count_ = 0;
};

}  // namespace millforce::firmware
