// SPDX-License-Identifier: Apache-2.0
#include "files/toml_reader.hpp"
#include "module/bindings.hpp"
#include "parameters/parameter_files.hpp"
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

std::string json_of(const Parameters& parameters, firmware::ParameterFile file) {
    sim::JsonWriter out;
    sim::write_parameters(out, parameters, file);
    return out.str();
}

}  // namespace

void bind_parameters(py::module_& module) {
    py::class_<Parameters>(module, "Parameters")
        .def(py::init(&from_texts), py::arg("machine"), py::arg("machine_name"), py::arg("tool"), py::arg("tool_name"))
        .def("machine_json", [](const Parameters& self) { return json_of(self, firmware::ParameterFile::machine); })
        .def("tool_json", [](const Parameters& self) { return json_of(self, firmware::ParameterFile::tool); });
}

}  // namespace millforce::python
