// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "firmware/parameters.hpp"

namespace millforce::firmware {

/// A tool under the number by which the CNC calls it, from 1 on.
struct NumberedTool {
    std::uint32_t number = 0;
    ToolParameters<float> parameters{};
};

/// The tools that the CNC may call, wherever they are kept: a host's memory, a chip's flash. They outlive the magazine.
/// No heap. Cost: find() looks through all of them.
class ToolMagazine {
  public:
    explicit ToolMagazine(std::span<const NumberedTool> tools) : tools_(tools) {}

    /// Null where there is no such tool. 0 is none.
    [[nodiscard]] const ToolParameters<float>* find(std::uint32_t number) const {
        for (const NumberedTool& tool : tools_) {
            if (tool.number == number && number != 0) {
                return &tool.parameters;
            }
        }
        return nullptr;
    }

  private:
    std::span<const NumberedTool> tools_;
};

}  // namespace millforce::firmware
