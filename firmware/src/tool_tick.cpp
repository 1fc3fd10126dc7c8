// SPDX-License-Identifier: Apache-2.0
#include "firmware/tool_tick_impl.hpp"
#include "firmware/tools_in_block.hpp"

namespace millforce::firmware {

template class ToolTickOf<ForceControlTick<float>, ToolSource>;
template class ToolTickOf<SmallTick<float>, ToolsInBlock<SmallTick<float>>>;

}  // namespace millforce::firmware
