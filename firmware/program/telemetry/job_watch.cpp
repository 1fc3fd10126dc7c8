// SPDX-License-Identifier: Apache-2.0
#include "telemetry/job_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "control/cut_state.hpp"
#include "report/json_writer.hpp"

namespace millforce::host {

namespace {

constexpr std::uint64_t end_after_us = 30'000'000;
constexpr double longest_step_s = 0.1;  // a longer one is a gap
constexpr std::size_t most_faults = 100;

bool is_cut(const Telemetry& telemetry) {
    return control::is_cutting(static_cast<control::CutState>(telemetry.sample.tick.feed_override.state));
}

bool is_new_run(const Telemetry& last, const Telemetry& now) {
    return now.sample.tick.feed_override.heartbeat < last.sample.tick.feed_override.heartbeat;
}

double in_s(std::uint64_t time_us) {
    return 1e-6 * static_cast<double>(time_us);
}

}  // namespace

std::string job_id(const JobReport& report) {
    return fmt::format("job-{}", report.begin_unix_us);
}

std::string job_json(const JobReport& report) {
    constexpr int digits_of_time = 16;
    JsonWriter json;
    json.begin_object().key("id").text(job_id(report));
    json.key("begin_unix_s").number(in_s(report.begin_unix_us), digits_of_time);
    json.key("end_unix_s").number(in_s(report.end_unix_us), digits_of_time);
    json.key("cutting_s").number(report.cutting_s).key("held_s").number(report.held_s);
    if (report.cutting_s > 0.0) {
        json.key("mean_override").number(report.override_sum_s / report.cutting_s);
    }
    if (report.largest_load > 0.0F) {
        json.key("largest_load").number(static_cast<double>(report.largest_load));
    }
    if (report.largest_depth_mm > 0.0F) {
        json.key("largest_depth_mm").number(static_cast<double>(report.largest_depth_mm));
    }
    json.key("tools").begin_array();
    for (const std::uint32_t tool : report.tools) {
        json.unsigned_integer(tool);
    }
    json.end_array().key("faults").begin_array();
    for (const JobReport::FaultAt& fault : report.faults) {
        json.begin_object().key("unix_s").number(in_s(fault.unix_us), digits_of_time);
        json.key("fault").text(control::name(static_cast<control::Fault>(fault.fault))).end_object();
    }
    return json.end_array().key("samples_lost").unsigned_integer(report.lost).end_object().str();
}

void JobWatch::add(JobReport& job, const Telemetry& telemetry) const {
    const firmware::TickRecord& tick = telemetry.sample.tick;
    const double step_s = last_ ? std::clamp(telemetry.time_s - last_->time_s, 0.0, longest_step_s) : 0.0;
    if (is_cut(telemetry)) {
        job.cutting_s += step_s;
        job.override_sum_s += step_s * static_cast<double>(tick.feed_override.ratio);
        job.end_unix_us = telemetry.unix_us;
    }
    job.held_s += telemetry.sample.is_held ? step_s : 0.0;
    if (tick.has_tooth_force() && telemetry.shown.limit_N > 0.0F) {
        job.largest_load = std::max(job.largest_load, telemetry.shown.peak_N / telemetry.shown.limit_N);
    }
    if (tick.axial_depth_mm > job.largest_depth_mm) {
        job.largest_depth_mm = tick.axial_depth_mm;
    }
    if (telemetry.sample.tool != 0) {
        job.tools.insert(telemetry.sample.tool);
    }
    const std::uint8_t fault_before = last_ ? last_->sample.tick.feed_override.fault : std::uint8_t{0};
    if (tick.feed_override.fault != 0 && tick.feed_override.fault != fault_before && job.faults.size() < most_faults) {
        job.faults.push_back({telemetry.unix_us, tick.feed_override.fault});
    }
    job.lost = telemetry.lost - lost_before_;
}

std::optional<JobReport> JobWatch::follow(const Telemetry& telemetry) {
    std::optional<JobReport> ended = look(telemetry.sample.monotonic_us);
    if (last_ && is_new_run(*last_, telemetry)) {
        ended = ended ? ended : end();
        last_.reset();
    }
    if (is_cut(telemetry)) {
        last_cut_us_ = telemetry.sample.monotonic_us;
        if (!job_) {
            lost_before_ = last_ ? last_->lost : 0;
            job_ = JobReport{.begin_unix_us = telemetry.unix_us, .end_unix_us = telemetry.unix_us};
        }
    }
    if (job_) {
        add(*job_, telemetry);
    }
    last_ = telemetry;
    return ended;
}

std::optional<JobReport> JobWatch::look(std::uint64_t monotonic_us) {
    return job_ && monotonic_us > last_cut_us_ + end_after_us ? end() : std::nullopt;
}

std::optional<JobReport> JobWatch::end() {
    return std::exchange(job_, std::nullopt);
}

}  // namespace millforce::host
