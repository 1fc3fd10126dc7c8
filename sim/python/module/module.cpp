// SPDX-License-Identifier: Apache-2.0
#include "files/input_error.hpp"
#include "module/bindings.hpp"

PYBIND11_MODULE(_millforce, module) {
    using namespace millforce;
    module.doc() = "What the package millforce is built on; not for direct use.";
    pybind11::register_exception<host::InputError>(module, "InputError", PyExc_ValueError);
    python::bind_parameters(module);
    python::bind_tables(module);
    python::bind_tick(module);
    python::bind_plant(module);
    python::bind_calibration(module);
    python::bind_part_maps(module);
}
