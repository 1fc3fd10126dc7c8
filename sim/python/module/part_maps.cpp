// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>
#include <tuple>
#include <vector>

#include "module/bindings.hpp"
#include "part_map/part_map_file.hpp"

namespace millforce::python {

namespace {

using host::MapOrigin;
using host::MapPlace;
using host::PartMapFile;
using Arc = std::tuple<double, double, double>;  ///< entry and exit in degrees, axial depth in mm

double in_degrees(double angle_rad) {
    return angle_rad * 180.0 / std::numbers::pi;
}

std::vector<Arc> arcs_of(const MapPlace& place) {
    std::vector<Arc> arcs;
    for (const host::EngagedArc& arc : place.cut) {
        arcs.emplace_back(in_degrees(arc.entry_rad), in_degrees(arc.exit_rad), arc.axial_depth_mm);
    }
    return arcs;
}

/// A place holds to the next one: that in force at a path. Before the first and behind the last there is air.
std::vector<Arc> arcs_at(const PartMapFile& file, double path_mm) {
    const auto next = std::upper_bound(file.map.begin(), file.map.end(), path_mm,
                                       [](double path, const MapPlace& place) { return path < place.path_mm; });
    return next == file.map.begin() ? std::vector<Arc>() : arcs_of(*std::prev(next));
}

py::tuple row_of(const MapPlace& place) {
    return py::make_tuple(place.path_mm, place.block_end_mm, place.line, place.rapid, 60.0 * place.programmed_feed_mm_s,
                          30.0 / std::numbers::pi * place.spindle_speed_rad_s, arcs_of(place));
}

/// In the order of the file's further columns.
py::tuple doubt_of(const MapPlace& place) {
    return py::make_tuple(static_cast<int>(place.known), in_degrees(place.arc_sd_rad), place.axial_depth_sd_mm,
                          place.hardness, place.hardness_sd, place.position_sd_mm, place.is_contested,
                          place.known == host::Known::at_most ? place.least_share : 1.0);
}

py::list rows_of(const PartMapFile& file) {
    py::list rows;
    for (const MapPlace& place : file.map) {
        rows.append(py::make_tuple(row_of(place), doubt_of(place)));
    }
    return rows;
}

}  // namespace

void bind_part_maps(py::module_& module) {
    py::class_<PartMapFile>(module, "PartMap")
        .def(py::init(&host::read_part_map), py::arg("path"))
        .def("write",
             [](const PartMapFile& self, const std::filesystem::path& path) { host::write_part_map(path, self); })
        .def("rows", &rows_of)
        .def("arcs_at", &arcs_at, py::arg("path_mm"))
        .def_property_readonly("program", [](const PartMapFile& self) { return self.origin.program; })
        .def_property_readonly("tool", [](const PartMapFile& self) { return self.origin.tool; });
    module.def(
        "map_origin",
        [](const std::filesystem::path& program, const std::string& tool,
           const firmware::Parameters<float>& parameters) {
            const MapOrigin origin = host::origin_of(program, tool, parameters.tool);
            return py::make_tuple(origin.program, origin.program_crc32, origin.tool, origin.tool_crc32);
        },
        py::arg("program"), py::arg("tool"), py::arg("parameters"));
}

}  // namespace millforce::python
