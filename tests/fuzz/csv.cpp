// SPDX-License-Identifier: Apache-2.0
// A recording as CSV, into the reader and the tick of `millforce replay`, and back into a file.
#include <vector>

#include "firmware/tick.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "hal/finite.hpp"
#include "parameters/parameter_files.hpp"
#include "recording/recording.hpp"

using namespace millforce;

namespace {

constexpr std::uint32_t counts_per_rev = 4096;
constexpr std::size_t most_rows = 200;  // that the tick runs on

struct Prepared {
    firmware::Parameters<float> parameters =
        host::read_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml",
                              MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml");
    firmware::ForceControlTick<float> tick{parameters};
};

void require_finite(const hal::DriveSample& sample) {
    bool are_finite = hal::is_finite(sample.spindle_current_A);
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        const bool is_there = (sample.present & hal::axis_mask(axis)) != 0;
        are_finite = are_finite && (!is_there || (hal::is_finite(sample.axis_current_A[axis]) &&
                                                  hal::is_finite(sample.axis_velocity_mm_s[axis])));
    }
    fuzz::require(are_finite, "what is present is finite");
}

std::vector<host::RecordedStep> read(const std::filesystem::path& file, bool& has_force_sensor) {
    std::vector<host::RecordedStep> steps;
    fuzz::is_taken([&] {
        host::RecordingReader reader(file, counts_per_rev);
        has_force_sensor = reader.has_force_sensor();
        double last_s = -1e300;
        while (reader.next()) {
            fuzz::require(reader.time_s() > last_s, "time grows");
            last_s = reader.time_s();
            require_finite(reader.sample());
            if (steps.size() < most_rows) {
                steps.push_back({reader.sample(), reader.program(), 1.0F});
            }
        }
    });
    return steps;
}

void run_tick(const std::vector<host::RecordedStep>& steps) {
    static const Prepared prepared;
    firmware::ForceControlTick<float> tick = prepared.tick;
    for (const host::RecordedStep& step : steps) {
        const hal::FeedOverride output = step_and_work(tick, step.sample, step.program);
        fuzz::require(hal::is_finite(output.ratio) && output.ratio >= 0.0F, "the override is a number");
        fuzz::require(output.ratio <= prepared.parameters.machine.cnc.override_max,
                      "the override is at most the machine's");
    }
}

/// The writer's steps lie less than 2³¹ µs and counts apart, and all angles within ±1e7 rad.
bool can_be_written(const std::vector<host::RecordedStep>& steps) {
    for (std::size_t k = 1; k < steps.size(); ++k) {
        const hal::DriveSample& a = steps[k - 1].sample;
        const hal::DriveSample& b = steps[k].sample;
        const auto turned = static_cast<std::int32_t>(b.spindle_count - a.spindle_count);
        if (b.time_us - a.time_us - 1U >= 0x7FFF'FFFFU || turned > 100'000 || turned < -100'000 ||
            a.present != b.present) {
            return false;
        }
    }
    return true;
}

void write_and_read_back(const std::vector<host::RecordedStep>& steps, bool has_force_sensor) {
    const std::filesystem::path file = fuzz::folder().path("written.csv");
    host::RecordingWriter writer(file, counts_per_rev, has_force_sensor);
    for (const host::RecordedStep& step : steps) {
        writer.add(step);
    }
    writer.commit();
    const std::vector<host::RecordedStep> again = read(file, has_force_sensor);
    fuzz::require(again.size() == steps.size(), "each row that is written is read back");
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const hal::DriveSample& a = steps[k].sample;
        const hal::DriveSample& b = again[k].sample;
        fuzz::require(a.present == b.present && a.spindle_current_A == b.spindle_current_A &&
                          a.axis_current_A == b.axis_current_A,
                      "currents that are written are read back");
        fuzz::require(
            b.spindle_count - again[0].sample.spindle_count == a.spindle_count - steps[0].sample.spindle_count,
            "counts that are written are read back");
        fuzz::require(b.time_us - again[0].sample.time_us == a.time_us - steps[0].sample.time_us,
                      "times that are written are read back");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    bool has_force_sensor = false;
    const auto file = fuzz::folder().write("recording.csv", fuzz::text_of({data, size}));
    const std::vector<host::RecordedStep> steps = read(file, has_force_sensor);
    run_tick(steps);
    if (!steps.empty() && can_be_written(steps)) {
        write_and_read_back(steps, has_force_sensor);
    }
    return 0;
}
