// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace millforce::host {

/// The one line that says what is wrong with the command line: the message of CLI11, with the nearest name of an
/// unknown command or option.
std::string usage_error(const CLI::App& app, int argc, const char* const* argv, const std::string& message);

}  // namespace millforce::host
