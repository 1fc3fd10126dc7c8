// SPDX-License-Identifier: Apache-2.0
#include "bus/plant_on_can.hpp"
#include "can_frames.hpp"

#include <algorithm>
#include <deque>
#include <initializer_list>
#include <memory>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace millforce;

namespace {

/// Frames of a script, each at its time; what waits lets the time pass up to the next.
class ScriptedPort final : public host::CanPort {
  public:
    [[nodiscard]] std::uint64_t now_us() override { return now_us_; }
    void poll(std::uint64_t) override {}
    [[nodiscard]] bool receive(hal::CanFrame& frame, std::uint64_t& time_us) override {
        if (script.empty() || script.front().time_us > now_us_) {
            return false;
        }
        frame = script.front().frame;
        time_us = script.front().time_us;
        script.pop_front();
        return true;
    }
    void send(const hal::CanFrame& frame) override { sent.push_back(frame.id); }
    void wait(std::uint64_t timeout_us) override {
        const std::uint64_t end_us = now_us_ + timeout_us;
        now_us_ = script.empty() ? end_us : std::min(end_us, script.front().time_us);
    }

    struct Heard {
        std::uint64_t time_us;
        hal::CanFrame frame;
    };
    std::deque<Heard> script{};
    std::vector<std::uint32_t> sent{};

  private:
    std::uint64_t now_us_ = 0;
};

constexpr std::uint32_t sync_id = 0x080;
constexpr std::uint32_t first_pdo_of_spindle = 0x181;

/// A plant whose drives run, and a SYNC at each of these times.
struct PlantOnScript {
    PlantOnScript(bool computes_ahead, std::initializer_list<std::uint64_t> sync_times_us) {
        auto owned = std::make_unique<ScriptedPort>();
        port = owned.get();
        constexpr std::uint8_t start_all = 1;
        port->script.push_back({1, frame_of_length(0x000, 2, start_all)});
        for (const std::uint64_t time_us : sync_times_us) {
            port->script.push_back({time_us, frame_of_length(sync_id, 0)});
        }
        sim::PlantOnCanSettings settings;
        settings.computes_ahead = computes_ahead;
        plant = std::make_unique<sim::PlantOnCan>(settings, std::move(owned));
    }

    /// Up to the next SYNC: how the plant is to step behind it.
    sim::OverrideSource::PlantSteps next() {
        (void)plant->step({}, {});
        return plant->plant_steps({4, 0.25e-3});
    }
    [[nodiscard]] bool has_answered() const {
        return std::find(port->sent.begin(), port->sent.end(), first_pdo_of_spindle) != port->sent.end();
    }

    ScriptedPort* port = nullptr;
    std::unique_ptr<sim::PlantOnCan> plant;
};

}  // namespace

TEST_GROUP(PlantOnCan){};

TEST(PlantOnCan, a_plant_that_computes_ahead_has_answered_a_SYNC_before_it_computes_on) {
    PlantOnScript ahead(true, {1'000});
    (void)ahead.next();
    CHECK_TRUE(ahead.has_answered());
    PlantOnScript behind(false, {1'000});
    (void)behind.next();
    CHECK_FALSE(behind.has_answered());
}

TEST(PlantOnCan, ahead_a_SYNC_that_is_heard_late_is_one_period_all_the_same) {
    PlantOnScript ahead(true, {1'000, 2'650, 3'000});
    PlantOnScript behind(false, {1'000, 2'650, 3'000});
    for (const int count : {4, 7, 1}) {
        const auto steps = ahead.next();
        LONGS_EQUAL(4, steps.count);
        DOUBLES_EQUAL(0.25e-3, steps.step_s, 0.0);
        LONGS_EQUAL(count, behind.next().count);
    }
}

TEST(PlantOnCan, ahead_a_plant_without_SYNC_goes_on_by_the_clock) {
    PlantOnScript ahead(true, {1'000});
    (void)ahead.next();
    const auto steps = ahead.next();
    DOUBLES_EQUAL(5e-3, steps.count * steps.step_s, 1e-9);
}
