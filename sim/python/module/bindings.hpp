// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

/// The module `millforce._millforce`, on which the Python package is built. Its own functions take files, texts and
/// columns; the package makes dictionaries of them, and its docstrings are the manual. Whatever takes long runs without
/// the interpreter's lock. Bad input is `InputError`, a ValueError with the program's message.

namespace millforce::python {

namespace py = pybind11;

/// Columns as Python gives them: contiguous, and converted to double where they are something else.
using Column = py::array_t<double, py::array::c_style | py::array::forcecast>;

void bind_parameters(py::module_& module);
void bind_tables(py::module_& module);
void bind_tick(py::module_& module);
void bind_plant(py::module_& module);
void bind_calibration(py::module_& module);
void bind_part_maps(py::module_& module);

}  // namespace millforce::python
