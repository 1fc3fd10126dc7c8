// SPDX-License-Identifier: Apache-2.0
// What a controller behind `millforce simulate --controller socket:PATH` sends: its first line, and its answers.
#include <cmath>
#include <string>

#include "fuzz/hostile_bytes.hpp"
#include "loop/override_source.hpp"
#include "remote/controller_messages.hpp"
#include "remote/line_socket.hpp"

using namespace millforce;

namespace {

void require_sound(const sim::ControllerAnswer& answer, const firmware::CncParameters<float>& limits) {
    fuzz::require(answer.override_ratio >= limits.override_min && answer.override_ratio <= limits.override_max,
                  "an override that the CNC takes");
    if (answer.estimate) {
        fuzz::require(!std::isinf(answer.estimate->tangential_force_N) && !std::isinf(answer.estimate->force_limit_N),
                      "an estimate is a number, or none");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view line =
        fuzz::text_of({data, size}).substr(0, sim::LineSocket::longest_line);  // longer ones are refused unread
    const firmware::CncParameters<float> limits;
    fuzz::is_taken([&] { require_sound(sim::read_answer(line, 7, limits), limits); });
    fuzz::is_taken([&] { fuzz::require_printable(sim::read_ready(line)); });
    return 0;
}
