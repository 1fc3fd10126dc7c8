// SPDX-License-Identifier: Apache-2.0
#include "run_log/tool_forces.hpp"

namespace millforce::host {

ToolForces::ToolForces(const ToolSet& tools) : has_numbers_(!tools.tools().empty()) {
    firmware::Parameters<float> parameters = tools.parameters();
    if (!has_numbers_) {
        by_number_.emplace(0, firmware::total_force(parameters));
    }
    for (const NumberedTool& tool : tools.tools()) {
        parameters.tool = tool.parameters;
        by_number_.emplace(tool.number, firmware::total_force(parameters));
    }
}

firmware::ShownForces ToolForces::of(const firmware::TickRecord& record, std::uint32_t tool) const {
    const auto found = by_number_.find(tool);
    return found != by_number_.end() ? firmware::shown_forces(found->second, record) : firmware::ShownForces{};
}

}  // namespace millforce::host
