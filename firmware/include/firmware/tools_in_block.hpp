// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "firmware/parameter_block.hpp"

namespace millforce::firmware {

/// Tools by number for a small chip (ToolTickOf): a tool's parameters are read where the block is, in flash, and its
/// tick is built at the change, in the place of the last one. Cost of a change: that of building a tick, 22 million
/// instructions on a Cortex-M4F.
template <typename Tick>
class ToolsInBlock {
  public:
    /// `parameters`: the machine's, with a tool of the block; the tool is overwritten at each change. The block and the
    /// parameters outlive this.
    ToolsInBlock(const BlockTools& tools, Parameters<float>& parameters) : tools_(tools), parameters_(parameters) {}

    /// False, too, where the flash has lost the tool since the start.
    [[nodiscard]] bool has(std::uint32_t number) const {
        const std::size_t place = tools_.place_of(number);
        return place < tools_.size() && tools_.is_whole_at(place);
    }

    /// Of the tool before where there is none with this number.
    void set_up(std::uint32_t number, Tick& tick) const {
        if (const std::size_t place = tools_.place_of(number); place < tools_.size()) {
            (void)tools_.read_at(place, parameters_.tool);  // its values were checked with the block
        }
        std::destroy_at(&tick);
        std::construct_at(&tick, parameters_);
    }

  private:
    BlockTools tools_;
    Parameters<float>& parameters_;
};

}  // namespace millforce::firmware
