// SPDX-License-Identifier: Apache-2.0
#include "run_report/run_recorder.hpp"

namespace millforce::host {

namespace {

double seconds_of(std::uint64_t time_us) {
    return 1e-6 * static_cast<double>(time_us);
}

}  // namespace

void RunRecorder::on_sample(const Telemetry& telemetry) {
    const TelemetrySample& sample = telemetry.sample;
    history_.set_lost(telemetry.lost);
    history_.add(seconds_of(clock_ == RunClock::samples ? sample.tick.time_us : sample.monotonic_us), sample.tick,
                 sample.tool);
}

void RunRecorder::on_turn() {
    notes_.take_all([this](std::uint64_t time_us, std::string_view text) { history_.note(seconds_of(time_us), text); });
}

}  // namespace millforce::host
