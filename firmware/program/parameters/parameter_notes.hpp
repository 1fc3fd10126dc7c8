// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "firmware/parameters.hpp"

namespace millforce::host {

/// What a machine with these parameters cannot know, and what follows from it, to be printed at the start. One
/// sentence each.
std::vector<std::string> parameter_notes(const firmware::Parameters<float>& parameters);

/// Prints the notes of parameter_notes() on standard error.
void tell_parameter_notes(const firmware::Parameters<float>& parameters);

}  // namespace millforce::host
