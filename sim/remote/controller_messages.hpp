// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/drive_sample.hpp"
#include "loop/scenario.hpp"
#include "recording/continuous_counts.hpp"
#include "report/run_result.hpp"

/// What the simulator and a controller in another process say to each other: JSON (RFC 8259), one object a line. All
/// keys are listed in sim/python/README.md. Names and units are those of recordings and tables of estimates; null is
/// "no measurement" or "no estimate".

namespace millforce::sim {

/// Increases with each change that an older controller would not understand; a new key alone is none.
inline constexpr int controller_protocol_version = 1;

/// The first line to the controller: version, scenario, and all parameters of machine and tool.
[[nodiscard]] std::string hello_message(const Scenario& scenario);

/// What the controller answers to it. Returns its name, for tables and reports. Throws InputError: not this message,
/// another version, or a name that is empty or that of one of the project's own controllers.
[[nodiscard]] std::string read_ready(std::string_view line);

struct SampleOfRun {
    std::uint64_t number = 0;  ///< 1 for the first
    const hal::DriveSample& sample;
    const hal::ProgramStatus& program;
    const host::ContinuousCounts& counts;  ///< have followed the sample
    const TracePoint& estimate;            ///< what the project's own tick makes of it
};
[[nodiscard]] std::string sample_message(const SampleOfRun& at);

struct ControllerAnswer {
    float override_ratio = 0.0F;
    bool hold = false;
    std::optional<TracePoint> estimate;  ///< the controller's own, where it sent one
};
/// Throws InputError: not JSON, a key that is unknown, missing or of another type, an override outside of the CNC's
/// limits, an answer to another sample.
[[nodiscard]] ControllerAnswer read_answer(std::string_view line, std::uint64_t number,
                                           const firmware::CncParameters<float>& limits);

/// Puts the estimates of one point into another, and leaves the rest of it as it is.
void copy_estimate(const TracePoint& from, TracePoint& to);

/// The last line to the controller: how the run ended.
[[nodiscard]] std::string end_message(const RunFigures& figures);
/// Or why it was broken off.
[[nodiscard]] std::string error_message(std::string_view what);

}  // namespace millforce::sim
