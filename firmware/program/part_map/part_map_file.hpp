// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "part_map/part_map.hpp"

/// A part map as a file: CSV, with comments in front that say what it belongs to.
///
///     # millforce part map 1
///     # program pocket.ngc crc32 5f3a09c1
///     # tool endmill_10mm crc32 0b77e2d4
///     path_mm,block_end_mm,line,rapid,feed_mm_min,spindle_rpm,entry_deg,exit_deg,axial_depth_mm
///     0,142.7,4,1,15000,4000,,,
///     150.4,216.7,8,0,1500,4000,11.5,168.5,5
///
///   path_mm         gone along the program's path since its begin, rapids included; a row holds up to the next one. Of
///                   a program that changes its tool: gone with this one
///   block_end_mm    path at the end of the block in work: a CNC reports the line and the distance to go to that end
///   line            of the program, 1 the first
///   rapid           1 in a G0
///   feed_mm_min     as programmed
///   spindle_rpm     as programmed; 0: stands
///   entry_deg, exit_deg, axial_depth_mm   an arc that is engaged, φ from the normal to the feed as in
///                   estimation/cutting/cut_geometry.hpp; empty: air. Further arcs at the same place are further rows
///                   with the same path_mm, in the order of φ
///
/// A map that a run has written, and one that joins both, are "part map 2" and have further columns:
///
///   known           0: nothing is known of this place; 1: the cut is between least_share of this one and all of it;
///                   2: it is this cut, or air
///   arc_sd_deg      standard deviation of entry_deg and exit_deg; 0: as geometry has them
///   axial_depth_sd_mm   of the depth; 0: as geometry has it
///   hardness, hardness_sd   K_s relative to the tool's file, and its deviation; 1 and 0: not measured. A run alone
///                   cannot tell it from the depth
///   position_sd_mm  of the place along the path; 0: not measured
///   contested       1 where geometry and run disagree beyond their doubt
///   least_share     of the cut's force that is surely there, where it is known at most; 0: it may be air. Without this
///                   column, as older versions wrote it, 0
///
/// The last row is the end of the program, or of the run, in air. The checksum of the program is that of its bytes
/// without carriage returns; that of the tool covers what the arcs and depths depend on: teeth, diameter, helix and
/// flute length. It leaves out the tool's law on purpose: the forces along a map are worked out when it is read, by the
/// law of the tool's file then, and a tool that is calibrated again keeps its maps. In the map of a run the depth is
/// the one that gave the measured force by the law of that time; another k_s now is to the controller another steel. In
/// the width step a map that was learnt with a k_s of 0.77 or 1.3 of the right one takes 8.6 s or 9.3 s instead of 8.9
/// s, with peaks of 98 % or 90 % of the limit instead of 93 %.

namespace millforce::host {

struct MapOrigin {
    std::string program;  ///< file name; empty where there is none (a profile)
    std::uint32_t program_crc32 = 0;
    std::string tool;
    std::uint32_t tool_crc32 = 0;
};

struct PartMapFile {
    MapOrigin origin;
    PartMap map;
};

/// `program_file` may be empty. Throws InputError.
[[nodiscard]] MapOrigin origin_of(const std::filesystem::path& program_file, const std::string& tool_name,
                                  const firmware::ToolParameters<float>& tool);

/// Writes only places that differ from the one before, and no place or arc that is shorter than the file's digits
/// (1 µm, 0.001°): a run may leave such a place where a block ends as soon as it has begun. Throws InputError.
void write_part_map(const std::filesystem::path& file, const PartMapFile& map);

/// Throws InputError "FILE:LINE: …": another version, a checksum that cannot be read, a path that goes back, an arc
/// outside 0…180° or that ends before it begins, a depth or a feed that cannot be, no end in air, all that CsvReader
/// rejects.
[[nodiscard]] PartMapFile read_part_map(const std::filesystem::path& file);

/// Throws InputError where the map was made for another program or another tool than these.
void require_same_origin(const std::filesystem::path& file, const MapOrigin& of_map, const MapOrigin& of_part);

}  // namespace millforce::host
