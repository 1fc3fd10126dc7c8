// SPDX-License-Identifier: Apache-2.0
// A candump log, line by line, and as `millforce replay` reads it through.
#include "candump/log_line.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "parameters/parameter_files.hpp"
#include "replay/candump_replay.hpp"
#include "run_log/candump_line.hpp"

using namespace millforce;

namespace {

void require_same(const hal::CanFrame& a, const hal::CanFrame& b) {
    fuzz::require(
        a.id == b.id && a.extended == b.extended && a.remote == b.remote && a.length == b.length && a.data == b.data,
        "a frame that is written is read back");
}

void read_line(std::string_view text) {
    const candump::LogLine line = candump::read_line(text);
    if (line.kind == candump::LineKind::malformed) {
        fuzz::require(line.column >= 1 && line.column <= text.size() + 1, "an error has a place in the line");
        fuzz::require(!candump::expectation(line.error).empty(), "an error says what was expected");
        return;
    }
    if (line.kind != candump::LineKind::frame) {
        return;
    }
    fuzz::require(line.frame.length <= hal::largest_can_length, "at most 8 bytes");
    fuzz::require(line.frame.id <= (line.frame.extended ? 0x1FFF'FFFFU : hal::largest_standard_can_id),
                  "an id of 11 or 29 bits");
    const std::string written = host::candump_line(line.frame, line.time_us, line.interface);
    const candump::LogLine again = candump::read_line(std::string_view(written).substr(0, written.size() - 1));
    fuzz::require(
        again.kind == candump::LineKind::frame && again.time_us == line.time_us && again.interface == line.interface,
        "a line that is written is read back");
    require_same(line.frame, again.frame);
}

void read_log(fuzz::Input input) {
    static const std::string machine = MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml";
    static const host::MachineBus bus = host::read_machine_bus(machine).value();
    host::CandumpReplay::Settings settings;
    settings.log = fuzz::folder().write("bus.log", fuzz::text_of(input)).string();
    settings.bus = bus;
    fuzz::is_taken([&] { const host::CandumpReplay replay(settings); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view rest = fuzz::text_of({data, size});
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        read_line(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    read_log({data, size});
    return 0;
}
