// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "firmware/tick_record.hpp"
#include "parameters/tool_set.hpp"

namespace millforce::host {

/// The shown forces of a tick's record, by the parameters of its tool.
class ToolForces {
  public:
    explicit ToolForces(const ToolSet& tools);

    /// With a folder of tools: whoever shows a record also shows the number of its tool.
    [[nodiscard]] bool has_numbers() const { return has_numbers_; }
    /// `tool`: that of the record, 0 where it is not known, and where there is one tool.
    [[nodiscard]] firmware::ShownForces of(const firmware::TickRecord& record, std::uint32_t tool) const;

  private:
    bool has_numbers_;
    std::map<std::uint32_t, estimation::TotalForce<float>> by_number_;
};

}  // namespace millforce::host
