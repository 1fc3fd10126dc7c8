// SPDX-License-Identifier: Apache-2.0
// A part map as `millforce serve --map` reads it, and back into a file.
#include <algorithm>
#include <cmath>

#include "fuzz/hostile_bytes.hpp"
#include "hal/finite.hpp"
#include "parameters/parameter_files.hpp"
#include "part_map/part_map.hpp"
#include "part_map/part_map_file.hpp"

using namespace millforce;

namespace {

constexpr std::size_t most_places = 8;  // that are turned into stretches: each takes a thousand tooth forces

void require_sound(const host::PartMap& map) {
    double last_mm = -1.0;
    for (const host::MapPlace& place : map) {
        fuzz::require(place.path_mm > last_mm && place.block_end_mm >= place.path_mm, "the path goes on");
        last_mm = place.path_mm;
        fuzz::require(place.programmed_feed_mm_s >= 0.0 && std::isfinite(place.programmed_feed_mm_s), "a feed");
        double last_rad = 0.0;
        for (const host::EngagedArc& arc : place.cut) {
            fuzz::require(arc.entry_rad >= last_rad && arc.exit_rad > arc.entry_rad && arc.exit_rad < 3.1416 &&
                              arc.axial_depth_mm > 0.0,
                          "arcs in their order");
            last_rad = arc.exit_rad;
        }
    }
    fuzz::require(!map.empty() && map.back().cut.empty(), "the end is in air");
}

void write_and_read_back(const host::PartMapFile& map) {
    const std::filesystem::path file = fuzz::folder().path("written.map");
    host::write_part_map(file, map);
    const host::PartMapFile again = host::read_part_map(file);
    fuzz::require(again.origin.program_crc32 == map.origin.program_crc32 &&
                      again.origin.tool_crc32 == map.origin.tool_crc32 && again.origin.program == map.origin.program,
                  "the origin that is written is read back");
    fuzz::require(std::abs(again.map.back().path_mm - map.map.back().path_mm) <= 0.001, "so is the end");
    const std::string first = fuzz::folder().read("written.map");
    host::write_part_map(file, again);
    fuzz::require(fuzz::folder().read("written.map") == first, "written again, the map is the same");
}

void look_ahead(const host::PartMap& map) {
    static const firmware::Parameters<float> parameters =
        host::read_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml",
                              MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml");
    const double most = static_cast<double>(parameters.machine.cnc.override_max);
    double fastest_mm_s = 0.0;
    for (const host::MapPlace& place : map) {
        fastest_mm_s = std::max(fastest_mm_s, place.programmed_feed_mm_s);
    }
    for (const control::Stretch<float>& stretch : host::stretches_of(map, parameters)) {
        const auto feed_mm_s = static_cast<double>(stretch.feed_mm_s);
        fuzz::require(feed_mm_s >= 0.0 && feed_mm_s <= 2.001 * most * fastest_mm_s,
                      "no stretch is faster than twice what the override allows");
        fuzz::require(hal::is_finite(stretch.tangential_N) && hal::is_finite(stretch.tooth_per_tangential) &&
                          hal::is_finite(stretch.feed_per_tangential) && hal::is_finite(stretch.falling_share) &&
                          hal::is_finite(stretch.feed_per_softness),
                      "what the controller takes of a stretch is finite");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto file = fuzz::folder().write("part.map", fuzz::text_of({data, size}));
    fuzz::is_taken([&] {
        const host::PartMapFile map = host::read_part_map(file);
        require_sound(map.map);
        write_and_read_back(map);
        if (map.map.size() <= most_places) {
            look_ahead(map.map);
        }
    });
    return 0;
}
