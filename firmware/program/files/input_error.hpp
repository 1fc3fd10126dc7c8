// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "files/printable.hpp"

namespace millforce::host {

/// Bad input from a user: a file, a key, a column, a value. The message is one line that names the file, the line and
/// column or the key, the value found, and what was expected. `millforce` prints it and exits with code 2. Control
/// characters, which a file may have anywhere, appear as '?'.
class InputError : public std::runtime_error {
  public:
    explicit InputError(const std::string& message) : std::runtime_error(without_controls(message)) {}
};

}  // namespace millforce::host
