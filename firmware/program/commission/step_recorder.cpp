// SPDX-License-Identifier: Apache-2.0
#include "commission/step_recorder.hpp"

#include <algorithm>
#include <utility>

namespace millforce::host {

namespace {
constexpr double piece_s = 10.0;
constexpr double rest_at_end_s = 1.0;
constexpr double rest_after_program_s = 5.0;
constexpr std::uint32_t samples_between_looks = 64;
}  // namespace

StepRecorder::StepRecorder(const Session& session, std::string step, std::uint32_t counts_per_rev, StepWatch& watch,
                           bool in_pieces)
    : session_(session),
      step_(std::move(step)),
      counts_per_rev_(counts_per_rev),
      watch_(watch),
      in_pieces_(in_pieces) {}

bool StepRecorder::add(const hal::DriveSample& sample) {
    if (!first_) {
        first_ = sample;
        last_time_us_ = sample.time_us;
    }
    time_us_ += sample.time_us - last_time_us_;
    last_time_us_ = sample.time_us;
    hal::DriveSample from_zero = sample;
    from_zero.time_us = static_cast<std::uint32_t>(time_us_);
    from_zero.spindle_count -= first_->spindle_count;
    from_zero.spindle_index_count -= first_->spindle_count;
    const double time_s = static_cast<double>(time_us_) / 1e6;  // as in the file: the watch finds the same in it
    steps_.push_back({from_zero, {}, 1.0F});
    watch_.take({time_s, from_zero});
    note_rest(time_s, sample);
    if (++samples_ % samples_between_looks == 0) {
        look(time_s);
    }
    if (in_pieces_ && rests_since_s_ && time_s - piece_start_s_ >= piece_s) {
        write_piece();
        piece_start_s_ = time_s;
    }
    return rests_since_s_ && enough_since_s_ && time_s - std::max(*rests_since_s_, *enough_since_s_) >= rest_at_end_s;
}

void StepRecorder::look(double time_s) {
    const bool is_enough = watch_.is_enough();
    is_enough_.store(is_enough, std::memory_order_relaxed);
    if (is_enough && !enough_since_s_) {
        enough_since_s_ = time_s;
    }
}

void StepRecorder::note_rest(double time_s, const hal::DriveSample& sample) {
    if (!hal::axes_rest(sample.axis_velocity_mm_s)) {
        rests_since_s_.reset();
        has_moved_ = true;
    } else if (!rests_since_s_) {
        rests_since_s_ = time_s;
    }
    if (has_moved_ && rests_since_s_ && time_s - *rests_since_s_ >= rest_after_program_s) {
        has_moved_ = false;
        if (!watch_.is_enough()) {
            watch_.remind();
        }
    }
}

void StepRecorder::write_file(const std::filesystem::path& file, std::uint32_t counts_per_rev,
                              const std::vector<RecordedStep>& steps) {
    RecordingWriter writer(file, counts_per_rev, false);
    for (const RecordedStep& step : steps) {
        writer.add(step);
    }
    writer.commit();
}

void StepRecorder::write_piece() {
    if (writing_.valid()) {
        writing_.get();
    }
    writing_ = std::async(std::launch::async, write_file, session_.next_recording(step_), counts_per_rev_,
                          std::exchange(steps_, {}));
}

void StepRecorder::finish() {
    watch_.end();
    is_enough_.store(watch_.is_enough(), std::memory_order_relaxed);
    if (!steps_.empty()) {
        write_piece();
    }
    if (writing_.valid()) {
        writing_.get();
    }
}

void feed_recordings(const std::vector<std::filesystem::path>& files, std::uint32_t counts_per_rev, StepWatch& watch) {
    for (const auto& file : files) {
        RecordingReader reader(file, counts_per_rev);
        while (reader.next()) {
            watch.take({reader.time_s(), reader.sample()});
        }
    }
    watch.end();
}

}  // namespace millforce::host
