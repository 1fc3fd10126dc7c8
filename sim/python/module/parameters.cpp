// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <filesystem>
#include <map>

#include "files/toml_reader.hpp"
#include "module/bindings.hpp"
#include "parameters/parameter_files.hpp"
#include "parameters/tool_set.hpp"
#include "remote/parameters_json.hpp"

namespace millforce::python {

namespace {

using Parameters = firmware::Parameters<float>;

Parameters from_texts(const std::string& machine, const std::string& machine_name, const std::string& tool,
                      const std::string& tool_name) {
    Parameters parameters;
    parameters.machine = host::machine_parameters_in(host::TomlFile::from_text(machine, machine_name));
    parameters.tool = host::tool_parameters_in(host::TomlFile::from_text(tool, tool_name));
    return parameters;
}

std::map<std::uint32_t, Parameters> of_folder(const std::string& machine, const std::string& machine_name,
                                              const std::filesystem::path& folder) {
    Parameters parameters;
    parameters.machine = host::machine_parameters_in(host::TomlFile::from_text(machine, machine_name));
    std::map<std::uint32_t, Parameters> by_number;
    for (const host::NumberedTool& tool : host::read_tool_folder(folder)) {
        parameters.tool = tool.parameters;
        by_number.emplace(tool.number, parameters);
    }
    return by_number;
}

std::string json_of(const Parameters& parameters, firmware::ParameterFile file) {
    host::JsonWriter out;
    sim::write_parameters(out, parameters, file);
    return out.str();
}

}  // namespace

void bind_parameters(py::module_& module) {
    py::class_<Parameters>(module, "Parameters")
        .def(py::init(&from_texts), py::arg("machine"), py::arg("machine_name"), py::arg("tool"), py::arg("tool_name"))
        .def("machine_json", [](const Parameters& self) { return json_of(self, firmware::ParameterFile::machine); })
        .def("tool_json", [](const Parameters& self) { return json_of(self, firmware::ParameterFile::tool); });
    module.def("read_tools", &of_folder, py::arg("machine"), py::arg("machine_name"), py::arg("folder"));
}

}  // namespace millforce::python
