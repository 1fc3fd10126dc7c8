// SPDX-License-Identifier: Apache-2.0
#include "telemetry/telemetry_hub.hpp"

#include <memory>
#include <string>
#include <vector>

#include "control/cut_state.hpp"
#include "telemetry_bench.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

struct Seen {
    std::vector<std::uint32_t> ticks;
    std::vector<std::string> events;
    std::uint64_t lost = 0;
    bool has_ended = false;
};

class SeenSink final : public TelemetrySink {
  public:
    explicit SeenSink(Seen& seen) : seen_(seen) {}
    void on_sample(const Telemetry& telemetry) override {
        seen_.ticks.push_back(telemetry.sample.tick.feed_override.heartbeat);
        seen_.lost = telemetry.lost;
    }
    void on_event(const TelemetryEvent& event) override { seen_.events.push_back(event.text); }
    void on_end() override { seen_.has_ended = true; }

  private:
    Seen& seen_;
};

TelemetrySample tick_number(std::uint32_t number) {
    TelemetrySample sample;
    sample.tick.feed_override = {0.5F, false, 0, 0, number};
    sample.is_held = false;
    return sample;
}

}  // namespace

TEST_GROUP(TelemetryHub) {
    Seen seen;
    EventWatch events;

    std::string events_of(const TelemetrySample& sample) {
        std::string text;
        Telemetry telemetry;
        telemetry.sample = sample;
        events.follow(telemetry, [&text](const TelemetryEvent& event) { text += event.text + ";"; });
        return text;
    }
};

TEST(TelemetryHub, hands_over_every_sample_in_its_order_and_the_rest_at_the_end) {
    {
        std::vector<std::unique_ptr<TelemetrySink>> sinks;
        sinks.push_back(std::make_unique<SeenSink>(seen));
        TelemetryHub hub(one_tool(), std::move(sinks));
        for (std::uint32_t k = 1; k <= 1000; ++k) {
            hub.feed()->put(tick_number(k));
        }
    }
    LONGS_EQUAL(1000, seen.ticks.size());
    for (std::uint32_t k = 0; k < 1000; ++k) {
        UNSIGNED_LONGS_EQUAL(k + 1, seen.ticks[k]);
    }
    CHECK(seen.has_ended);
}

TEST(TelemetryHub, has_no_feed_and_no_thread_where_nobody_watches) {
    TelemetryHub hub(one_tool(), {});
    CHECK(hub.feed() == nullptr);
}

TEST(TelemetryHub, counts_what_a_full_feed_does_not_take) {
    const auto feed = std::make_unique<TelemetryFeed>();
    for (std::uint32_t k = 0; k < 5000; ++k) {
        feed->put(tick_number(k));
    }
    TelemetrySample first;
    CHECK(feed->take(first));
    UNSIGNED_LONGS_EQUAL(0, first.tick.feed_override.heartbeat);
    UNSIGNED_LONGS_EQUAL(5000 - 4096, feed->lost());
}

TEST(TelemetryHub, reports_what_begins_and_ends_once) {
    STRCMP_EQUAL("run begins;feed free;", events_of(tick_number(1)).c_str());
    STRCMP_EQUAL("", events_of(tick_number(2)).c_str());
    TelemetrySample sample = tick_number(3);
    sample.tick.feed_override.fault = static_cast<std::uint8_t>(control::Fault::overload);
    sample.is_held = true;
    sample.conditions.set(firmware::Condition::drive_lost, true);
    sample.tool = 7;
    STRCMP_EQUAL("fault: overload;feed held;drive_lost;tool 7;", events_of(sample).c_str());
    STRCMP_EQUAL("", events_of(sample).c_str());
    STRCMP_EQUAL("fault reset;feed free;drive_lost ended;tool not known;", events_of(tick_number(5)).c_str());
    STRCMP_EQUAL("run begins;", events_of(tick_number(1)).c_str());
}
