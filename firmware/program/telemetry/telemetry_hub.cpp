// SPDX-License-Identifier: Apache-2.0
#include "telemetry/telemetry_hub.hpp"

#include <sys/resource.h>

#include <chrono>
#include <exception>

namespace millforce::host {

namespace {

constexpr auto turn_period = std::chrono::milliseconds(20);
/// Behind a desktop, and still heard on a busy computer: the page of a run has every tick.
constexpr int low_priority = 5;

std::int64_t unix_offset_us() {
    using std::chrono::microseconds;
    const auto in_us = [](auto time) {
        return std::chrono::duration_cast<microseconds>(time.time_since_epoch()).count();
    };
    return in_us(std::chrono::system_clock::now()) - in_us(std::chrono::steady_clock::now());
}

}  // namespace

TelemetryHub::TelemetryHub(const ToolSet& tools, std::vector<std::unique_ptr<TelemetrySink>> sinks)
    : maker_(tools, unix_offset_us()), sinks_(std::move(sinks)) {
    if (!sinks_.empty()) {
        feed_ = std::make_unique<TelemetryFeed>();
        thread_ = std::thread([this] { run(); });
    }
}

TelemetryHub::~TelemetryHub() {
    finish();
}

void TelemetryHub::finish() {
    ended_.store(true);
    if (thread_.joinable()) {
        thread_.join();
    }
    for (const auto& sink : sinks_) {
        failed_file_ = failed_file_.empty() ? sink->failed_file() : failed_file_;
    }
    sinks_.clear();
}

void TelemetryHub::run() {
    setpriority(PRIO_PROCESS, 0, low_priority);  // on Linux: of this thread
    for_each_sink([](TelemetrySink& sink) { sink.on_begin(); });
    while (!ended_.load()) {
        std::this_thread::sleep_for(turn_period);
        turn();
    }
    turn();
    for_each_sink([](TelemetrySink& sink) { sink.on_end(); });
}

/// Without memory a watcher misses something, and the controller goes on.
template <typename Call>
void TelemetryHub::for_each_sink(Call call) {
    for (const auto& sink : sinks_) {
        try {
            call(*sink);
        } catch (const std::exception&) {
        }
    }
}

void TelemetryHub::turn() {
    for (TelemetrySample sample; feed_->take(sample);) {
        try {
            hand_over(sample);
        } catch (const std::exception&) {  // of an event's text
        }
    }
    for_each_sink([](TelemetrySink& sink) { sink.on_turn(); });
}

void TelemetryHub::hand_over(const TelemetrySample& sample) {
    const Telemetry telemetry = maker_.of(sample, feed_->lost());
    events_.follow(telemetry, [this](const TelemetryEvent& event) {
        for_each_sink([&event](TelemetrySink& sink) { sink.on_event(event); });
    });
    for_each_sink([&telemetry](TelemetrySink& sink) { sink.on_sample(telemetry); });
}

}  // namespace millforce::host
