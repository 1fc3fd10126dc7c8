// SPDX-License-Identifier: Apache-2.0
#include "way_sender_on_loopback.hpp"

#include "firmware_can/way_of_tools.hpp"
#include "loop/bounds.hpp"
#include "loop/simulation.hpp"
#include "part_map/map_follower.hpp"
#include "part_map/map_sender.hpp"
#include "preview/preview.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

using namespace millforce;
using namespace millforce::test;

namespace {

sim::Scenario scenario_of(const std::string& name) {
    return sim::read_scenario(std::string(MILLFORCE_SOURCE_DIR) + "/sim/scenarios/" + name + ".toml");
}

struct Run {
    sim::RunFigures figures{};
    std::uint32_t sessions = 0;
    bool is_refuted = false;
};

using Disturb = std::function<void(ControllerOnLoopback&, WaySenderOnLoopback&, firmware::WayOverBus<float>&)>;

/// The controller of a chip; `disturb` may do so each 20 µs.
Run with_window(const sim::Scenario& scenario, const host::PartMap& map, const Disturb& disturb = {}) {
    firmware::WayOverBus<float> way = way_over_bus(scenario.parameters);
    ControllerOnLoopback bench(scenario, nullptr, &way);
    bench.keeps_log = false;
    bench.ticks.is_kept = false;
    WaySenderOnLoopback sender(bench, map, scenario.parameters);
    if (disturb) {
        const auto turn = bench.beside;
        bench.beside = [&, turn](std::uint64_t now_us) {
            turn(now_us);
            disturb(bench, sender, way);
        };
    }
    Run run;
    run.figures = sim::simulate(scenario, bench, "millforce").result.figures;
    run.sessions = sender.sender.sessions();
    run.is_refuted = way.is_refuted();
    return run;
}

sim::RunFigures with_way(const sim::Scenario& scenario, firmware::WaySource<float>* way) {
    ControllerOnLoopback bench(scenario, nullptr, way);
    bench.keeps_log = false;
    bench.ticks.is_kept = false;
    return sim::simulate(scenario, bench, "millforce").result.figures;
}

/// The tick with a window, and the sender beside it: no bus, no time between them.
template <typename Scalar>
class WindowedTick final : public sim::TickController<Scalar> {
  public:
    WindowedTick(const firmware::Parameters<float>& parameters, const host::PartMap& map)
        : sim::TickController<Scalar>(parameters),
          way_(firmware::parameters_in<Scalar>(parameters), firmware::tool_checksum(parameters.tool),
               override_frame::default_node_id),
          sender_(way_sender_settings(), map, parameters) {}
    [[nodiscard]] bool is_refuted() const { return way_.is_refuted(); }

  private:
    void look_ahead(firmware::ForceControlTick<Scalar>& tick, const hal::ProgramStatus& program) override {
        now_us_ += 1000;
        if (now_us_ % 10'000 == 0) {
            sender_.on_frame(program_status::encode_position({program.line, program.distance_to_go_mm, ++counter_},
                                                             way_sender_settings().position_id),
                             now_us_);
        }
        sender_.poll(now_us_);
        hal::CanFrame frame;
        while (sender_.take_frame(frame)) {
            way_.on_frame(frame);
        }
        while (way_.take_frame(frame)) {
            sender_.on_frame(frame, now_us_);
        }
        way_.look_ahead(tick, program);
    }

    firmware::WayOverBus<Scalar> way_;
    host::WaySender sender_;
    std::uint64_t now_us_ = 1'000'000;
    std::uint8_t counter_ = 0;
};

}  // namespace

TEST_GROUP(WindowOverBus){};

TEST(WindowOverBus, a_chip_mills_as_fast_as_with_the_whole_map) {
    for (const char* name : {"slot_entry", "width_step", "interrupted"}) {
        const sim::Scenario scenario = scenario_of(name);
        const host::PartMap map = sim::preview(scenario);
        host::MapFollower follower(scenario.parameters, map);
        const sim::RunFigures whole = with_way(scenario, &follower);
        const sim::RunFigures blind = with_way(scenario, nullptr);
        const Run chip = with_window(scenario, map);
        CHECK(sim::bounds_hold(chip.figures));
        CHECK_FALSE(chip.is_refuted);
        CHECK(chip.figures.time_s < 1.03 * whole.time_s);
        CHECK(chip.figures.time_s < 0.9 * blind.time_s);
        CHECK(chip.sessions <= 2);  // the first may come before the controller hears
    }
}

/// Two tools out of which the CNC tells 7, and the sender of both maps.
TEST(WindowOverBus, a_chip_with_tools_by_number_mills_as_fast_with_the_map_of_the_tool_in_the_spindle) {
    const sim::Scenario scenario = scenario_of("slot_entry");
    firmware::Parameters<float> other = scenario.parameters;
    other.tool.tooth_force_limit_N *= 0.5F;
    const host::PartMap map = sim::preview(scenario);
    const Run of_one_tool = with_window(scenario, map);
    std::array<firmware::ReadyTool, 2> memory;
    firmware::ReadyTools tools(memory);
    tools.add(7, scenario.parameters);
    tools.add(8, other);
    firmware::WayOfTools way(other, override_frame::default_node_id, &tools);
    ControllerOnLoopback bench(scenario, &tools, &way);
    bench.keeps_log = false;
    bench.ticks.is_kept = false;
    host::MapSender sender(way_sender_settings(), program_status::default_id);
    CHECK(sender.add(8, map, other));
    CHECK(sender.add(7, map, scenario.parameters));
    const int place = bench.wire.attach(
        [&sender](const hal::CanFrame& frame, std::uint64_t time_us) { sender.on_frame(frame, time_us); });
    bench.beside = [&](std::uint64_t now_us) {
        sender.poll(now_us);
        hal::CanFrame frame;
        while (sender.take_frame(frame)) {
            bench.wire.send(place, frame, now_us);
        }
    };
    bench.cnc.set_tool(7, bench.now_us);
    const sim::RunFigures figures = sim::simulate(scenario, bench, "millforce").result.figures;
    CHECK(sim::bounds_hold(figures));
    CHECK_FALSE(way.is_refuted());
    DOUBLES_EQUAL(of_one_tool.figures.time_s, figures.time_s, 0.03 * figures.time_s);
}

/// Its map has 344 records: a window holds a part of it.
TEST(WindowOverBus, where_the_sender_dies_the_chip_goes_on_blind_and_breaks_no_tooth) {
    const sim::Scenario scenario = scenario_of("interrupted");
    const host::PartMap map = sim::preview(scenario);
    const sim::RunFigures blind = with_way(scenario, nullptr);
    const Run whole = with_window(scenario, map);
    const double half_mm = 0.5 * map.back().path_mm;
    bool has_died = false;
    const Run run = with_window(scenario, map, [&](ControllerOnLoopback&, WaySenderOnLoopback& sender, auto& way) {
        has_died = has_died || (way.position_mm() && static_cast<double>(*way.position_mm()) > half_mm);
        sender.lives = !has_died;
    });
    CHECK(has_died);
    CHECK(sim::bounds_hold(run.figures));
    CHECK(run.figures.time_s > 1.1 * whole.figures.time_s);
    CHECK(run.figures.time_s < 1.03 * blind.time_s);
}

TEST(WindowOverBus, a_bus_that_loses_a_fifth_doubles_delays_and_reorders_costs_little) {
    const sim::Scenario scenario = scenario_of("interrupted");
    const host::PartMap map = sim::preview(scenario);
    const Run clean = with_window(scenario, map);
    const auto of_window = [](const hal::CanFrame& frame) {
        return frame.id == way_window::way_frame_id(override_frame::default_node_id) ||
               frame.id == way_window::way_answer_id(override_frame::default_node_id);
    };
    std::vector<double> times_s;
    for (std::uint32_t seed = 1; seed <= 9; ++seed) {
        std::mt19937 random(seed);
        std::uint64_t lost = 0;
        const Run run = with_window(scenario, map, [&](ControllerOnLoopback& bench, WaySenderOnLoopback&, auto&) {
            bench.wire.set_fault([&](const hal::CanFrame& frame) -> sim::LoopbackBus::Fate {
                if (!of_window(frame)) {
                    return {1, 0, frame};
                }
                const auto chance = random() % 100;
                lost += chance < 20 ? 1 : 0;
                return {chance < 20 ? 0 : (chance < 30 ? 2 : 1), 10'000 + random() % 3000, frame};
            });
        });
        CHECK(lost > 100);
        CHECK(sim::bounds_hold(run.figures));
        times_s.push_back(run.figures.time_s);
    }
    std::ranges::sort(times_s);
    CHECK(times_s[times_s.size() / 2] < 1.05 * clean.figures.time_s);
    CHECK(times_s[times_s.size() - 2] < 1.2 * clean.figures.time_s);
    // A window that has to begin again within the cut leaves the tool blind for that long.
    CHECK(times_s.back() < with_way(scenario, nullptr).time_s);
}

TEST(WindowOverBus, a_chip_that_starts_anew_in_mid_program_gets_the_map_from_there) {
    const sim::Scenario scenario = scenario_of("interrupted");
    const host::PartMap map = sim::preview(scenario);
    const Run clean = with_window(scenario, map);
    const double half_mm = 0.5 * map.back().path_mm;
    bool was_reset = false;
    const Run run = with_window(scenario, map, [&](ControllerOnLoopback&, WaySenderOnLoopback&, auto& way) {
        if (!was_reset && way.position_mm() && static_cast<double>(*way.position_mm()) > half_mm) {
            was_reset = true;
            way.begin_again();
        }
    });
    CHECK(was_reset);
    CHECK(run.sessions > clean.sessions);
    CHECK(sim::bounds_hold(run.figures));
    DOUBLES_EQUAL(clean.figures.time_s, run.figures.time_s, 0.05 * clean.figures.time_s);
}

TEST(WindowOverBus, a_map_of_another_tool_is_refused_and_does_no_harm) {
    const sim::Scenario scenario = scenario_of("slot_entry");
    const host::PartMap map = sim::preview(scenario);
    firmware::Parameters<float> other = scenario.parameters;
    other.tool.tooth_force_limit_N *= 2.0F;
    firmware::WayOverBus<float> way = way_over_bus(scenario.parameters);
    ControllerOnLoopback bench(scenario, nullptr, &way);
    WaySenderOnLoopback sender(bench, map, other);
    const sim::RunFigures figures = sim::simulate(scenario, bench, "millforce").result.figures;
    CHECK(sender.sender.controller_state(bench.now_us) == way_window::WayState::other_tool);
    CHECK(sim::bounds_hold(figures));
    const sim::RunFigures blind = with_way(scenario, nullptr);
    DOUBLES_EQUAL(blind.time_s, figures.time_s, 0.03 * blind.time_s);
}

TEST(WindowOverBus, a_tick_in_fixed_point_mills_with_a_window_as_one_in_float) {
    const sim::Scenario scenario = scenario_of("interrupted");
    const host::PartMap map = sim::preview(scenario);
    sim::MappedController whole(scenario.parameters, map);
    WindowedTick<float> in_float(scenario.parameters, map);
    WindowedTick<estimation::Fixed> in_fixed(scenario.parameters, map);
    const sim::RunFigures of_whole = sim::simulate(scenario, whole, "millforce").result.figures;
    const sim::RunFigures of_float = sim::simulate(scenario, in_float, "millforce").result.figures;
    const sim::RunFigures of_fixed = sim::simulate(scenario, in_fixed, "millforce").result.figures;
    CHECK(sim::bounds_hold(of_float));
    CHECK(sim::bounds_hold(of_fixed));
    CHECK_FALSE(in_fixed.is_refuted());
    DOUBLES_EQUAL(of_whole.time_s, of_float.time_s, 0.01 * of_whole.time_s);
    DOUBLES_EQUAL(of_float.time_s, of_fixed.time_s, 0.01 * of_float.time_s);
}
