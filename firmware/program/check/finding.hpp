// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace millforce::host {

enum class Severity : unsigned char {
    note,     ///< could not be judged, or is worth knowing
    warning,  ///< likely wrong: beyond four of its stated standard deviations
    error,    ///< cannot be right
};

/// One mistake, in words, with the key of the file or the column of the recording to look at.
struct Finding {
    Severity severity = Severity::note;
    std::string words;
    std::string key;
};

using Findings = std::vector<Finding>;

/// "warning: WORDS [KEY]"
std::string line_of(const Finding& finding);

/// "2 found: 1 error, 1 warning; 1 note", or "nothing found; 1 note".
std::string count_of(const Findings& findings);

/// Whether there is more than notes.
bool is_something_wrong(const Findings& findings);

void append(Findings& findings, Findings more);

}  // namespace millforce::host
