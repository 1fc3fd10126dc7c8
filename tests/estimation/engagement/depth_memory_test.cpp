// SPDX-License-Identifier: Apache-2.0
#include "estimation/engagement/depth_memory.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>

using namespace millforce::estimation;

namespace {

EngagementEstimate<double> depth_told_by_forces(double depth_mm, double sd_mm = 0.4) {
    EngagementEstimate<double> e;
    e.depth_valid = true;
    e.axial_depth_mm = depth_mm;
    e.axial_depth_force_sd_mm = sd_mm;
    return e;
}

DepthMemory<double> memory_of(double depth_mm, int estimates = 20) {
    DepthMemory<double> memory;
    for (int k = 0; k < estimates; ++k) {
        memory.learn(depth_told_by_forces(depth_mm + (k % 2 == 0 ? 0.2 : -0.2)));
    }
    return memory;
}

}  // namespace

TEST_GROUP(DepthMemory){};

TEST(DepthMemory, has_none_before_the_forces_told_one) {
    DepthMemory<double> memory;
    EngagementEstimate<double> no_depth;
    no_depth.axial_depth_mm = 6.0;
    memory.learn(no_depth);
    DOUBLES_EQUAL(0.0, memory.depth().depth_mm, 0.0);
}

TEST(DepthMemory, keeps_the_mean_of_the_last_estimates) {
    const auto depth = memory_of(6.0).depth();
    DOUBLES_EQUAL(6.0, depth.depth_mm, 0.05);
    DOUBLES_EQUAL(0.4 / 6.0, depth.relative_sd, 0.003);
    CHECK_FALSE(depth.K_s_is_in_doubt);
}

TEST(DepthMemory, takes_the_first_depth_at_once) {
    DOUBLES_EQUAL(6.2, memory_of(6.0, 1).depth().depth_mm, 1e-9);
}

TEST(DepthMemory, follows_a_depth_that_changes_a_little_however_long_it_was_another) {
    DepthMemory<double> memory = memory_of(6.0, 1000);
    for (int k = 0; k < 100; ++k) {
        memory.learn(depth_told_by_forces(6.3));
    }
    DOUBLES_EQUAL(6.3, memory.depth().depth_mm, 0.01);
}

TEST(DepthMemory, doubts_more_with_the_way_and_forgets_with_the_height) {
    for (const double half_a_depth_mm : {-3.0, 3.0}) {
        DepthMemory<double> memory = memory_of(6.0);
        memory.follow(100.0, 0.0);
        DOUBLES_EQUAL(std::hypot(0.4 / 6.0, 0.2), memory.depth().relative_sd, 0.005);
        memory.follow(0.0, half_a_depth_mm);
        DOUBLES_EQUAL(0.0, memory.depth().depth_mm, 0.0);
    }
}

TEST(DepthMemory, believes_another_depth_only_when_told_sixteen_times_in_a_row) {
    DepthMemory<double> memory = memory_of(6.0);
    for (int k = 0; k < 15; ++k) {
        memory.learn(depth_told_by_forces(2.0));
    }
    DOUBLES_EQUAL(6.0, memory.depth().depth_mm, 0.05);
    memory.learn(depth_told_by_forces(6.0));
    for (int k = 0; k < 15; ++k) {
        memory.learn(depth_told_by_forces(2.0));
    }
    DOUBLES_EQUAL(6.0, memory.depth().depth_mm, 0.05);
    memory.learn(depth_told_by_forces(2.0));
    DOUBLES_EQUAL(2.0, memory.depth().depth_mm, 1e-9);
}

TEST(DepthMemory, learns_nothing_from_a_depth_in_great_doubt) {
    DepthMemory<double> memory = memory_of(6.0);
    for (int k = 0; k < 40; ++k) {
        memory.learn(depth_told_by_forces(19.5, 6.5));
    }
    DOUBLES_EQUAL(6.0, memory.depth().depth_mm, 0.05);
}
