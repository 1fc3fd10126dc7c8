// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameter_fields.hpp"
#include "report/json_writer.hpp"

namespace millforce::sim {

/// The parameters of one file as an object of objects, with the tables and keys of machine.toml or tool.toml and all
/// defaults. What belongs to a bus is left out.
void write_parameters(JsonWriter& out, const firmware::Parameters<float>& parameters, firmware::ParameterFile file);

}  // namespace millforce::sim
