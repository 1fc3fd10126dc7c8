// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace millforce::host {

/// InputError where the text nests more tables, arrays or key parts than a file of parameters has. The parser calls
/// itself for each of them: unchecked, a key of thousands of parts ends the program. `name`: the file, for the message.
void check_toml_limits(std::string_view text, std::string_view name);

}  // namespace millforce::host
