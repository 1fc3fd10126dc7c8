// SPDX-License-Identifier: Apache-2.0
#include "daemon/run_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <new>

namespace millforce::host {

namespace {

constexpr auto taking_period = std::chrono::milliseconds(20);

double seconds_of(std::uint64_t time_us) {
    return 1e-6 * static_cast<double>(time_us);
}

}  // namespace

RunRecorder::RunRecorder(RunHistory& history) : history_(history) {
    taker_ = std::thread([this] { run(); });
}

RunRecorder::~RunRecorder() {
    finish();
}

void RunRecorder::tick(std::uint64_t time_us, const firmware::TickRecord& record, std::uint32_t tool) noexcept {
    if (!ticks_.push({time_us, record, tool})) {
        lost_.fetch_add(1, std::memory_order_relaxed);
    }
}

void RunRecorder::note(std::uint64_t time_us, std::string_view text) noexcept {
    Note note;
    note.time_us = time_us;
    note.length = std::min(text.size(), longest_note);
    std::copy_n(text.begin(), note.length, note.text.begin());
    notes_.push(note);
}

void RunRecorder::run() {
    while (!ended_.load()) {
        std::this_thread::sleep_for(taking_period);
        take_all();
    }
    take_all();
}

/// Without memory the page lacks an event, and the controller goes on.
void RunRecorder::take_all() {
    try {
        for (Tick tick; ticks_.pop(tick);) {
            history_.add(seconds_of(tick.time_us), tick.record, tick.tool);
        }
        for (Note note; notes_.pop(note);) {
            history_.note(seconds_of(note.time_us), {note.text.data(), note.length});
        }
    } catch (const std::bad_alloc&) {
        lost_.fetch_add(1, std::memory_order_relaxed);
    }
}

void RunRecorder::finish() {
    if (!taker_.joinable()) {
        return;
    }
    ended_.store(true);
    taker_.join();
    history_.set_lost(lost_.load());
}

}  // namespace millforce::host
