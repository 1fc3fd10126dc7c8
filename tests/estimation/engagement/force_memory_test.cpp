// SPDX-License-Identifier: Apache-2.0
#include "estimation/engagement/force_memory.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>

using namespace millforce::estimation;

namespace {

using Memory = ForceMemory<float>;
using Forces = AverageForceMeasurement<float>;

constexpr float feed_mm_s = 20.0F;
constexpr float exponent = 0.75F;
constexpr float sd_N = 10.0F;

Forces forces_of(float tangential_N) {
    Forces forces;
    forces.tangential_N = {true, tangential_N, 4.0F * sd_N * sd_N, sd_N * sd_N};
    forces.x_N = {true, -tangential_N, 4.0F * sd_N * sd_N, sd_N * sd_N};
    forces.y_N = {true, 0.5F * tangential_N, 4.0F * sd_N * sd_N, sd_N * sd_N};
    return forces;
}

Forces blended(Memory& memory, Forces forces, float feed = feed_mm_s, bool is_new_revolution = true) {
    memory.blend(forces, feed, exponent, is_new_revolution);
    return forces;
}

Memory with_revolutions(int revolutions) {
    Memory memory;
    for (int k = 0; k < revolutions; ++k) {
        blended(memory, forces_of(400.0F));
    }
    return memory;
}

/// Revolutions of eight that are left where the tangential force alone is off by `deviations` of its difference.
float left_after(float deviations) {
    Memory memory = with_revolutions(8);
    Forces off = forces_of(400.0F);
    off.tangential_N.value += deviations * sd_N * std::sqrt(1.0F + 1.0F / 8.0F);
    memory.blend(off, feed_mm_s, exponent, false);
    return memory.revolutions();
}

}  // namespace

TEST_GROUP(ForceMemory){};

TEST(ForceMemory, takes_the_noise_out_of_a_cut_that_stays_and_leaves_what_is_common) {
    Memory memory = with_revolutions(8);
    Forces now = forces_of(400.0F);
    now.tangential_N.value += sd_N;
    now.x_N.value += sd_N;
    now.y_N.value += sd_N;
    const Forces mean = blended(memory, now);
    DOUBLES_EQUAL(400.0 + 10.0 / 9.0, static_cast<double>(mean.tangential_N.value), 1e-3);
    DOUBLES_EQUAL(-400.0 + 10.0 / 9.0, static_cast<double>(mean.x_N.value), 1e-3);
    DOUBLES_EQUAL(200.0 + 10.0 / 9.0, static_cast<double>(mean.y_N.value), 1e-3);
    DOUBLES_EQUAL(300.0 + 100.0 / 9.0, static_cast<double>(mean.tangential_N.variance), 1e-2);
    DOUBLES_EQUAL(8.0, static_cast<double>(memory.revolutions()), 1e-6);
}

TEST(ForceMemory, weighs_each_of_its_first_revolutions_alike) {
    Memory memory = with_revolutions(2);
    Forces now = forces_of(400.0F);
    now.tangential_N.value += sd_N;
    DOUBLES_EQUAL(400.0 + 10.0 / 3.0, static_cast<double>(blended(memory, now).tangential_N.value), 1e-3);
    DOUBLES_EQUAL(3.0, static_cast<double>(memory.revolutions()), 1e-6);
}

TEST(ForceMemory, keeps_the_doubt_of_what_it_holds_though_the_present_forces_have_less) {
    Memory memory = with_revolutions(8);
    Forces now = forces_of(400.0F);
    now.tangential_N.variance = 1.5F * sd_N * sd_N;
    const double held_N2 = 300.0 + 100.0 / 8.0;
    DOUBLES_EQUAL(held_N2 * 8.0 / 9.0, static_cast<double>(blended(memory, now).tangential_N.variance), 1e-2);
}

TEST(ForceMemory, carries_nothing_from_or_to_a_feed_that_is_none) {
    for (const float before_mm_s : {0.0F, feed_mm_s}) {
        Memory memory;
        for (int k = 0; k < 8; ++k) {
            blended(memory, forces_of(400.0F), before_mm_s);
        }
        blended(memory, forces_of(400.0F), feed_mm_s - before_mm_s);
        DOUBLES_EQUAL(8.0, static_cast<double>(memory.revolutions()), 1e-6);
    }
}

TEST(ForceMemory, averages_the_forces_of_one_axis_until_another_is_known_as_well) {
    Forces without_y = forces_of(400.0F);
    without_y.y_N.valid = false;
    Memory memory;
    for (int k = 0; k < 8; ++k) {
        blended(memory, without_y);
    }
    DOUBLES_EQUAL(8.0, static_cast<double>(memory.revolutions()), 1e-6);
    blended(memory, forces_of(400.0F));
    DOUBLES_EQUAL(1.0, static_cast<double>(memory.revolutions()), 1e-6);
}

TEST(ForceMemory, carries_what_it_holds_to_another_feed) {
    Memory memory = with_revolutions(8);
    const float ratio = 1.5F;
    const Forces now = forces_of(400.0F * std::pow(ratio, exponent));
    const Forces mean = blended(memory, now, ratio * feed_mm_s);
    DOUBLES_EQUAL(8.0, static_cast<double>(memory.revolutions()), 1e-6);
    DOUBLES_EQUAL(static_cast<double>(now.x_N.value), static_cast<double>(mean.x_N.value), 0.05);
}

TEST(ForceMemory, fades_with_disagreement_and_has_no_threshold) {
    DOUBLES_EQUAL(8.0, static_cast<double>(left_after(1.99F)), 1e-6);
    DOUBLES_EQUAL(8.0 * 7.0 / 12.0, static_cast<double>(left_after(3.0F)), 1e-2);
    float last = left_after(2.0F);
    for (float deviations = 2.0F; deviations < 3.98F; deviations += 0.01F) {
        const float left = left_after(deviations);
        CHECK(left <= last + 1e-4F);
        CHECK(left > last - 0.06F);
        last = left;
    }
}

TEST(ForceMemory, starts_anew_in_another_cut) {
    DOUBLES_EQUAL(1.0, static_cast<double>(left_after(4.01F)), 1e-6);
    Memory turned = with_revolutions(8);
    Forces along_y = forces_of(400.0F);
    along_y.feed_direction_x = 0.0F;
    along_y.feed_direction_y = 1.0F;
    turned.blend(along_y, feed_mm_s, exponent, false);
    DOUBLES_EQUAL(1.0, static_cast<double>(turned.revolutions()), 1e-6);
    Memory blind = with_revolutions(8);
    Forces without_y = forces_of(400.0F);
    without_y.y_N.valid = false;
    const Forces mean = blended(blind, without_y, feed_mm_s, false);
    DOUBLES_EQUAL(1.0, static_cast<double>(blind.revolutions()), 1e-6);
    DOUBLES_EQUAL(400.0, static_cast<double>(mean.tangential_N.value), 1e-6);
}

TEST(ForceMemory, starts_anew_from_what_is_no_number) {
    Memory memory = with_revolutions(8);
    Forces broken = forces_of(400.0F);
    broken.x_N.value = std::nanf("");
    memory.blend(broken, feed_mm_s, exponent, false);
    const Forces sound = blended(memory, forces_of(400.0F));
    DOUBLES_EQUAL(-400.0, static_cast<double>(sound.x_N.value), 1e-3);
}
