// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench_control/parts.hpp"
#include "loop/scenario.hpp"

namespace millforce::sim {

/// Machines of the benchmark, by what the controller is given of them.
enum class BenchMachine : std::uint8_t {
    currents,       ///< currents of the spindle and of all axes
    spindle_alone,  ///< the spindle's current with each sample, no axis
    converter,      ///< the load that a frequency converter reports ten times a second, late
};

/// Writes a part as a scenario that `millforce simulate` can run: FOLDER/NAME.toml, NAME.ngc, NAME_tool.toml, and the
/// machine files vmc.toml and vfd.toml beside them. Throws InputError where the folder cannot be written.
void write_part_files(const std::filesystem::path& folder, const BenchPart& part);

/// Reads it back, for one of the machines. The blank is the drawn one and the plant the calibrated one. Throws
/// InputError.
[[nodiscard]] Scenario read_bench_part(const std::filesystem::path& folder, const BenchPart& part,
                                       BenchMachine machine);

}  // namespace millforce::sim
