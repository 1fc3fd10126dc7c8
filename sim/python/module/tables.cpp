// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "files/csv.hpp"
#include "files/input_error.hpp"
#include "module/bindings.hpp"

namespace millforce::python {

namespace {

using Texts = std::vector<std::vector<std::string>>;

Texts read_cells(host::CsvReader& csv) {
    Texts columns(csv.column_names().size());
    while (csv.next_row()) {
        for (std::size_t k = 0; k < columns.size(); ++k) {
            columns[k].emplace_back(csv.text({k}));
        }
    }
    return columns;
}

}  // namespace

void bind_tables(py::module_& module) {
    module.def(
        "read_cells",
        [](const std::string& path) {
            py::gil_scoped_release free;
            host::CsvReader csv(path);
            return std::pair(csv.column_names(), read_cells(csv));
        },
        py::arg("path"), "Names and cells of the columns of a CSV file.");
}

}  // namespace millforce::python
