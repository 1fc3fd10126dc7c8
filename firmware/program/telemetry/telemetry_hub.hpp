// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "telemetry/event_watch.hpp"
#include "telemetry/telemetry.hpp"
#include "telemetry/telemetry_feed.hpp"

namespace millforce::host {

/// Somebody who watches. All calls come from the hub's thread; an exception ends the call, and nothing else.
class TelemetrySink {
  public:
    virtual ~TelemetrySink() = default;
    /// The first call.
    virtual void on_begin() {}
    virtual void on_sample(const Telemetry& telemetry) = 0;
    /// Before on_sample() of the telemetry that shows it.
    virtual void on_event(const TelemetryEvent&) {}
    /// After the samples that there were, each 20 ms.
    virtual void on_turn() {}
    /// The last call.
    virtual void on_end() {}
    /// A file that could not be written whole; empty: none. After on_end().
    [[nodiscard]] virtual std::string failed_file() const { return {}; }
};

/// Takes samples from the real-time thread and hands them to all sinks, in a thread of its own with a low
/// priority. Made before the caller becomes real-time: the thread inherits its scheduler.
class TelemetryHub {
  public:
    TelemetryHub(const ToolSet& tools, std::vector<std::unique_ptr<TelemetrySink>> sinks);
    ~TelemetryHub();
    TelemetryHub(const TelemetryHub&) = delete;
    TelemetryHub& operator=(const TelemetryHub&) = delete;

    /// Hands over what is left, and closes all sinks.
    void finish();

    /// A file that could not be written whole; empty: none. After finish().
    [[nodiscard]] const std::string& failed_file() const { return failed_file_; }
    /// Of the real-time thread; null where nobody watches.
    [[nodiscard]] TelemetryFeed* feed() { return feed_.get(); }

  private:
    void run();
    void turn();
    template <typename Call>
    void for_each_sink(Call call);
    void hand_over(const TelemetrySample& sample);

    TelemetryMaker maker_;
    EventWatch events_{};
    std::vector<std::unique_ptr<TelemetrySink>> sinks_;
    std::string failed_file_{};
    std::unique_ptr<TelemetryFeed> feed_{};
    std::atomic<bool> ended_{false};
    std::thread thread_{};
};

}  // namespace millforce::host
