// SPDX-License-Identifier: Apache-2.0
#include "calibration/estimate.hpp"
#include "parameters/parameter_files.hpp"

namespace millforce::host {

ToolLaw read_tool_law(const std::filesystem::path& file) {
    const CuttingTable table = read_cutting_table(file.string());
    return {table.law, table.side.value_or(estimation::CutSide::down)};
}

}  // namespace millforce::host
