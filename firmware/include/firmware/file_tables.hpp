// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameter_fields.hpp"

#include <array>
#include <string_view>

/// Tables of machine.toml that stand for one name in parameter_fields.hpp.

namespace millforce::firmware {

inline constexpr std::array<const char*, 3> axis_tables{"x", "y", "z"};
inline constexpr std::array<const char*, 4> drive_tables{"bus.spindle", "bus.x", "bus.y", "bus.z"};

/// The table as it stands in the file.
constexpr const char* table_in_file(const ParameterName& name) {
    const std::string_view table = name.table;
    if (table == "axis") {
        return axis_tables[name.place % axis_tables.size()];
    }
    return table == "bus.drive" ? drive_tables[name.place % drive_tables.size()] : name.table;
}

}  // namespace millforce::firmware
