// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick.hpp"
#include "firmware/tick_bench.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>

using namespace millforce;
using namespace millforce::test;
using control::CutState;
using firmware::step_and_work;
using Tick = firmware::ForceControlTick<float>;

namespace {

/// Shares of what the spindle's current and that of the axis have beyond air in the cut of tick_bench.hpp.
struct Load {
    float spindle = 1.0F;
    float axis = 1.0F;
};

constexpr Load air{0.0F, 0.0F};
constexpr Load whole{1.0F, 1.0F};
constexpr Load faded{0.75F, 1.0F};  // the spindle's current has, the axis carries what it did
constexpr Load lighter{0.65F, 0.65F};

hal::DriveSample loaded(int index, Load load) {
    hal::DriveSample sample = sample_of(1200 + index);  // 80 revolutions later, in the cut
    const hal::DriveSample idle = sample_of(0);
    sample.time_us = static_cast<std::uint32_t>(index) * 1000U;
    sample.spindle_current_A =
        idle.spindle_current_A + load.spindle * (sample.spindle_current_A - idle.spindle_current_A);
    sample.axis_current_A[0] = idle.axis_current_A[0] + load.axis * (sample.axis_current_A[0] - idle.axis_current_A[0]);
    return sample;
}

hal::DriveSample at_rest(int index) {
    hal::DriveSample sample = loaded(index, air);
    sample.axis_velocity_mm_s = {};
    sample.axis_current_A = {};
    return sample;
}

/// Nothing but the force on a tooth limits the feed.
Parameters with_all_currents() {
    Parameters p = machine_and_tool();
    p.tool.control.depth_step_ratio = 1.0F;
    p.tool.control.surge_radial_immersion = 0.0F;
    return p;
}

Parameters spindle_alone() {
    Parameters p = with_all_currents();
    p.machine.spindle_rated_current_A = 20.0F;
    for (auto& axis : p.machine.axes) {
        axis.K_x4_N_per_A = 0.0F;
    }
    return p;
}

const Tick& tick_with_axes() {
    static const Tick tick(with_all_currents());
    return tick;
}

const Tick& tick_alone() {
    static const Tick tick(spindle_alone());
    return tick;
}

class Milling {
  public:
    explicit Milling(const Tick& tick = tick_with_axes()) : tick_(tick) {}

    Milling& mill(Load load, int samples = 1500) { return mill_from(load, load, samples); }
    /// The load changes evenly.
    Milling& mill_from(Load from, Load to, int samples) {
        for (int k = 0; k < samples; ++k) {
            const float share = static_cast<float>(k) / static_cast<float>(samples);
            step_and_work(tick_,
                          loaded(index_++, {from.spindle + share * (to.spindle - from.spindle),
                                            from.axis + share * (to.axis - from.axis)}),
                          program());
        }
        return *this;
    }
    Milling& rest(int samples = 500) {
        for (int k = 0; k < samples; ++k) {
            step_and_work(tick_, at_rest(index_++), program());
        }
        return *this;
    }
    /// Over 6 mm, into air that is too short to learn anything.
    Milling& leave_the_cut(Load load) { return mill_from(load, air, 300).mill(air, 200); }
    Milling& enter_the_cut(Load load, int samples = 1500) { return mill_from(air, load, 200).mill(load, samples); }

    [[nodiscard]] float ratio() const { return tick_.control().ratio; }
    [[nodiscard]] Tick& tick() { return tick_; }

  private:
    Tick tick_;
    int index_ = 0;
};

}  // namespace

TEST_GROUP(TickInDrift){};

TEST(TickInDrift, speeds_up_in_a_cut_that_becomes_lighter_by_both_forces) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    CHECK(milling.mill_from(whole, lighter, 2500).mill(lighter).ratio() > 1.18F * before);
}

TEST(TickInDrift, hardly_speeds_up_where_the_spindle_alone_carries_less) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    CHECK(milling.mill_from(whole, faded, 2500).mill(faded).ratio() < 1.15F * before);
    CHECK(milling.tick().control().state == CutState::in_cut);
}

TEST(TickInDrift, takes_the_next_cut_by_itself) {
    Milling fresh;
    Milling milling;
    milling.mill(air, 200).enter_the_cut(whole).leave_the_cut(whole);
    DOUBLES_EQUAL(static_cast<double>(fresh.mill(air, 200).enter_the_cut(faded).ratio()),
                  static_cast<double>(milling.enter_the_cut(faded).ratio()), 0.04);
}

TEST(TickInDrift, does_not_believe_it_there_if_it_has_faded_in_the_cut_before) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    milling.mill_from(whole, faded, 2500).leave_the_cut(faded);
    CHECK(milling.enter_the_cut(faded, 6000).ratio() < 1.15F * before);
}

TEST(TickInDrift, believes_it_again_once_the_spindle_is_found_sound_in_air) {
    Milling milling;
    const float before = milling.mill(air, 200).enter_the_cut(whole).ratio();
    milling.mill_from(whole, faded, 2500).leave_the_cut(faded).rest();
    CHECK(milling.enter_the_cut(faded, 6000).ratio() > 1.25F * before);
}

TEST(TickInDrift, believes_a_slow_fall_on_a_machine_with_axes_and_none_on_the_spindle_alone) {
    Milling with_axes;
    Milling alone(tick_alone());
    const float before = with_axes.mill(air, 200).enter_the_cut(whole).ratio();
    const float before_alone = alone.mill(air, 200).enter_the_cut(whole).ratio();
    CHECK(with_axes.mill_from(whole, lighter, 2500).ratio() > 1.1F * before);
    CHECK(alone.mill_from(whole, lighter, 2500).ratio() < 1.02F * before_alone);
}

TEST(TickInDrift, believes_the_spindle_alone_again_once_it_is_found_sound_in_air) {
    Milling alone(tick_alone());
    const float before = alone.mill(air, 200).enter_the_cut(whole).ratio();
    alone.mill_from(whole, lighter, 2500).leave_the_cut(lighter).rest();
    CHECK(alone.enter_the_cut(lighter, 6000).ratio() > 1.25F * before);
}

TEST(TickInDrift, takes_what_is_lost_at_the_end_of_a_cut_for_no_fall_of_the_spindle_alone) {
    Milling alone(tick_alone());
    const float before = alone.mill(air, 200).enter_the_cut(whole).ratio();
    alone.leave_the_cut(whole);
    DOUBLES_EQUAL(static_cast<double>(before), static_cast<double>(alone.enter_the_cut(whole).ratio()), 0.05);
}

TEST(TickInDrift, shows_no_engagement_that_the_forces_do_not_determine) {
    Milling milling;
    milling.mill(air, 200).mill({1.0F, -0.67F});  // pushed along the feed: wide, or up milled
    CHECK(milling.tick().control().state == CutState::in_cut);
    CHECK(milling.tick().estimate().engagement.solved);
    CHECK_FALSE(milling.tick().estimate().engagement.immersion_valid);
    CHECK_FALSE(milling.tick().engagement().immersion_valid);
    CHECK_FALSE(milling.tick().engagement().depth_valid);
}

TEST(TickInDrift, does_not_speed_up_by_a_depth_that_is_not_the_declared_one) {
    Parameters p = with_all_currents();
    p.tool.declared_axial_depth_mm = 1.0F;  // of some 8
    Milling milling{Tick(p)};
    milling.mill(air, 200).enter_the_cut(whole);
    CHECK(milling.tick().control().limit == control::Limit::law_misfit);
}
