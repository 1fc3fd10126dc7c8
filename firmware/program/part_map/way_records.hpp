// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "part_map/part_map.hpp"
#include "way_window/way_frames.hpp"

namespace millforce::host {

/// A stretch of the cut or a block of the program, as it goes over a bus to a controller without files.
using WayRecord = std::variant<way_window::StretchRecord, way_window::BlockRecord>;

/// mm along the path.
[[nodiscard]] double begin_mm(const WayRecord& record);

/// A map in the order of its path: each block before the stretches that begin in it. After so many blocks without a
/// change of the cut the last stretch is repeated: a chip's window ends with the last stretch that it has.
///
/// A stretch that does not fit its record (a force of more than 16 kN, for instance) goes as one of which nothing is
/// known. Throws InputError where the path is longer than 4 km, or a line is not 1…16 777 215.
[[nodiscard]] std::vector<WayRecord> way_records(const PartMap& map, const firmware::Parameters<float>& parameters);

/// Nothing is known of it where the stretch does not fit.
[[nodiscard]] way_window::StretchRecord record_of(const control::Stretch<float>& stretch);

}  // namespace millforce::host
