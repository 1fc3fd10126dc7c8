// SPDX-License-Identifier: Apache-2.0
#include "gpio/feed_hold_line.hpp"

#include <cerrno>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::gpio;

namespace {

class FakePort final : public LinePort {
  public:
    bool open(std::uint32_t wanted) override {
        ++opened;
        is_open = works;
        levels = works ? wanted : levels;
        return works;
    }
    bool set(std::uint32_t wanted) override {
        is_open = is_open && works;
        levels = is_open ? wanted : levels;
        return is_open;
    }
    [[nodiscard]] int last_error() const override { return works ? 0 : EIO; }

    bool works = true;
    bool is_open = false;
    int opened = 0;
    std::uint32_t levels = 0;
};

}  // namespace

TEST_GROUP(FeedHoldLine) {
    FakePort port{};
    std::uint64_t now_us = 1'000'000;
    std::uint32_t heartbeat = 0;

    void tick(hal::OverrideOutput & output, bool hold = false, std::uint8_t fault = 0, float ratio = 0.8F) {
        output.update({ratio, hold, 3, fault, ++heartbeat}, now_us += 1000);
        output.poll(now_us);
    }
    bool is_released() const {
        return (port.levels & FeedHoldLine::release_line) != 0;
    }
    bool pulse() const {
        return (port.levels & FeedHoldLine::pulse_line) != 0;
    }
    int pulses(FeedHoldLine & line, int ticks, bool hold) {
        int changes = 0;
        for (int k = 0; k < ticks; ++k) {
            const bool before = pulse();
            tick(line, hold);
            changes += pulse() != before ? 1 : 0;
        }
        return changes;
    }
};

TEST(FeedHoldLine, releases_the_feed_while_ticks_come_and_nothing_stops_it) {
    FeedHoldLine line({}, port);
    line.poll(now_us);
    CHECK(port.is_open && !is_released());
    tick(line);
    CHECK(is_released());
    tick(line, true);
    CHECK_FALSE(is_released());
    tick(line);
    tick(line, false, 4);
    CHECK_FALSE(is_released());
    tick(line);
    tick(line, false, 0, 0.0F);
    CHECK_FALSE(is_released());
}

TEST(FeedHoldLine, pulses_while_ticks_come_hold_or_not) {
    FeedHoldLine line({}, port);
    tick(line);
    LONGS_EQUAL(20, pulses(line, 100, false));
    LONGS_EQUAL(20, pulses(line, 100, true));
}

TEST(FeedHoldLine, of_a_dead_tick_stands_still_and_holds_though_it_is_called) {
    FeedHoldLine line({}, port);
    pulses(line, 10, false);
    const bool before = pulse();
    const std::uint64_t last_us = now_us;
    for (; now_us < last_us + 100'000; now_us += 1000) {
        line.update({0.8F, false, 3, 0, heartbeat}, now_us);
        line.poll(now_us);
        CHECK(pulse() == before);
        CHECK(is_released() == (now_us <= last_us + 20'000));
    }
    CHECK_FALSE(line.health().ticks);
}

TEST(FeedHoldLine, holds_after_its_end) {
    {
        FeedHoldLine line({}, port);
        tick(line);
        CHECK(is_released());
    }
    CHECK_FALSE(is_released());
}

TEST(FeedHoldLine, whose_lines_are_lost_says_so_and_takes_them_again) {
    FeedHoldLine line({}, port);
    tick(line);
    port.works = false;
    tick(line, true);
    CHECK_FALSE(line.health().is_ready);
    LONGS_EQUAL(EIO, line.health().last_error);
    const int tries = port.opened;
    pulses(line, 50, true);
    CHECK(port.opened <= tries + 1);
    port.works = true;
    pulses(line, 100, true);
    CHECK(line.health().is_ready && !is_released());
    tick(line);
    CHECK(is_released());
}
