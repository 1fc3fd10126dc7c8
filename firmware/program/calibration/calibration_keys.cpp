// SPDX-License-Identifier: Apache-2.0
#include "calibration/calibration_keys.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "parameters/parameter_table.hpp"

namespace millforce::host {

CalibrationKey key_of(std::string_view table, std::string_view name) noexcept {
    for (const ParameterRow& row : parameter_table()) {
        if (table == row.table && name == row.key) {
            return {row.key, std::string_view(row.unit) == "1" ? "" : row.unit, row.minimum, row.maximum};
        }
    }
    for (const InformationRow& row : information_table()) {
        if (table == row.table && name == row.key) {
            return {row.key, row.unit};
        }
    }
    fmt::print(stderr, "{}.{} is in neither parameter table\n", table, name);
    std::abort();
}

}  // namespace millforce::host
