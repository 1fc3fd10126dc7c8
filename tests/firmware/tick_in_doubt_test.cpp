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

/// So little of the cut of tick_bench.hpp that it may be drift as well.
constexpr float hardly_a_cut = 0.03F;
constexpr double its_force_N = 250.0 * static_cast<double>(hardly_a_cut);

hal::DriveSample with_share_of_force(int index, float share) {
    hal::DriveSample sample = sample_of(index);
    const float idle_A = sample_of(0).spindle_current_A;
    sample.spindle_current_A = idle_A + share * (sample.spindle_current_A - idle_A);
    return sample;
}

hal::DriveSample at_rest(int index) {
    hal::DriveSample sample = with_share_of_force(index, 0.0F);
    sample.axis_velocity_mm_s = {};
    sample.axis_current_A = {};
    return sample;
}

/// From the third second on the spindle's current loses half of what the cut asks for within 2.5 s.
hal::DriveSample fading(int index) {
    const int faded = std::clamp(index - 3000, 0, 2500);
    return with_share_of_force(index, 1.0F - 0.5F * static_cast<float>(faded) / 2500.0F);
}

control::WayAhead<float> with_cut(bool may_cut) {
    control::WayAhead<float> way;
    way.may_cut = may_cut;
    return way;
}

}  // namespace

TEST_GROUP(TickInDoubt) {
    Tick tick = fresh_tick();

    /// What is left of a light cut behind a rest in air.
    double force_in_light_cut_N(const control::WayAhead<float>& way) {
        for (int k = 0; k < 300; ++k) {
            step_and_work(tick, at_rest(k), program());
        }
        tick.set_way_ahead(way);
        for (int k = 300; k < 2300; ++k) {
            step_and_work(tick, with_share_of_force(k, hardly_a_cut), program());
        }
        return static_cast<double>(tick.estimate().steady_tangential_N.value);
    }
};

TEST(TickInDoubt, learns_no_force_as_drift_where_the_map_may_have_a_cut) {
    DOUBLES_EQUAL(its_force_N, force_in_light_cut_N(with_cut(true)), 0.2 * its_force_N);
}

TEST(TickInDoubt, learns_a_small_force_where_the_map_has_air) {
    DOUBLES_EQUAL(0.0, force_in_light_cut_N(with_cut(false)), 0.2 * its_force_N);
}

TEST(TickInDoubt, shows_an_engagement_in_the_cut_alone_and_while_it_is_held) {
    bool was_in_entry = false;
    for (int k = 0; k < 900; ++k) {
        step_and_work(tick, sample_of(k), program());
        was_in_entry = was_in_entry || tick.control().state == CutState::entry;
        CHECK(tick.control().state == CutState::in_cut || !tick.engagement().immersion_valid);
    }
    CHECK(was_in_entry);
    CHECK(tick.engagement().immersion_valid);
    hal::ProgramStatus held = program();
    held.feed_hold = true;
    for (int k = 900; k < 1000; ++k) {
        step_and_work(tick, sample_of(k), held);
    }
    CHECK(tick.control().state == CutState::hold);
    CHECK(tick.engagement().immersion_valid);
}

/// Forces along the feed that stay contradict it. The axes of this cut do not determine its width: the tooth force is a
/// bound, some twice F_at.
TEST(TickInDoubt, hardly_speeds_up_on_a_spindle_current_that_fades_while_the_axes_carry_what_they_did) {
    float before = 0.0F;
    float highest = 0.0F;
    for (int k = 0; k < 7000; ++k) {
        step_and_work(tick, fading(k), program());
        before = k == 3000 ? tick.control().ratio : before;
        highest = k > 3000 ? std::max(highest, tick.control().ratio) : highest;
    }
    CHECK(tick.control().fault == control::Fault::none);
    CHECK(before > 0.5F);
    CHECK(highest < 1.15F * before);
}
