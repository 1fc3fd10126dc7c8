// SPDX-License-Identifier: Apache-2.0
// A part program in G-code, as `millforce simulate` and `millforce preview` read it.
#include "cnc/gcode.hpp"

#include "fuzz/hostile_bytes.hpp"
#include "fuzz/moves.hpp"

using namespace millforce;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    sim::GcodeSettings settings;
    settings.max_moves = fuzz::most_moves;
    fuzz::is_taken([&] {
        const sim::GcodeProgram program = sim::read_gcode(fuzz::text_of({data, size}), "part.ngc", settings);
        fuzz::require_sound(program, settings);
    });
    return 0;
}
