// SPDX-License-Identifier: Apache-2.0
// What rs274, LinuxCNC's interpreter, prints for a part program: canonical commands.
#include "cnc/rs274.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "fuzz/moves.hpp"

using namespace millforce;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    sim::GcodeSettings settings;
    settings.max_moves = fuzz::most_moves;
    fuzz::is_taken([&] {
        const sim::GcodeProgram program = sim::moves_of_canonical(fuzz::text_of({data, size}), "part.ngc", settings);
        fuzz::require_sound(program, settings);
    });
    return 0;
}
