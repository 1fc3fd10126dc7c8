// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "files/toml_reader.hpp"
#include "parameters/local_io.hpp"

namespace millforce::host {

/// `table_of(name)`: the table of that name in the file. Throws InputError: a value out of its range, a channel without
/// its device, a unit that is missing.
LocalIoKeys read_local_io(const std::function<TomlFile::Table&(const std::string& name)>& table_of);

}  // namespace millforce::host
