// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "commission/answers.hpp"
#include "commission/file_draft.hpp"
#include "estimation/cutting/cutting_law.hpp"

/// The first machine.toml and tool.toml, from data sheets: the keys that matter, each with where its value comes from.
/// What is left out has its default (`millforce parameters`).

namespace millforce::host {

/// How the samples come: over a CAN bus, or from a program on the same computer (LinuxCNC's HAL).
enum class Connection : unsigned char { can, hal };

/// "x", "y", "z": those that the machine has.
std::vector<std::string> axes_of(Answers& answers);

/// Asks for the spindle, the axes, the CNC and, on CAN, the nodes. Values from data sheets are known to 10 %.
FileDraft first_machine_file(Answers& answers, std::optional<Connection> connection = {});

/// The law of a tool and workpiece that are known, e.g. of a standard cut.
struct KnownLaw {
    estimation::CuttingLaw<double> law{};
    std::string source;
};

/// Asks for the tool, the workpiece (unless its law is known) and the feeds. The advice for the largest force on a
/// tooth goes to `advice`, before the question for it.
FileDraft first_tool_file(Answers& answers, std::ostream& advice, const std::optional<KnownLaw>& known = {});

/// [bus], and [bus.spindle], [bus.x] … of drives that this controller maps and starts, or that the CNC does.
void add_bus(FileDraft& draft, Answers& answers, const std::vector<std::string>& axes);

}  // namespace millforce::host
