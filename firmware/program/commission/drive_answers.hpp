// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "commission/answers.hpp"
#include "commission/drive_search.hpp"

namespace millforce::host {

/// What the drives of a bus say of themselves, as answers (KEY = VALUE lines) to the questions for machine.toml. Asks
/// which node is the spindle and which an axis; the usual order is that of the nodes. Throws InputError where no drive
/// answers, or none at a node that was named.
std::string answers_of_drives(const std::vector<FoundDrive>& drives, const std::vector<std::string>& axes,
                              Answers& answers);

}  // namespace millforce::host
