// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/cut_state.hpp"
#include "firmware_can/conditions.hpp"

/// What the controller's names mean, for someone who stands at the machine.

namespace millforce::host {

/// One sentence.
[[nodiscard]] const char* meaning_of(control::CutState state);
/// One sentence that begins in lower case.
[[nodiscard]] const char* meaning_of(control::Fault fault);

/// Some words that begin in lower case, without a full stop.
[[nodiscard]] const char* meaning_of(firmware::Condition condition);

struct CeilingWords {
    const char* label;    ///< a few words
    const char* keys;     ///< keys of machine.toml or tool.toml that set it, separated by ", "; empty: none
    const char* meaning;  ///< a sentence or two
};
[[nodiscard]] const CeilingWords& words_of(control::Limit limit);

}  // namespace millforce::host
