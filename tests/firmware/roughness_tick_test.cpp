// SPDX-License-Identifier: Apache-2.0
#include "firmware/tick.hpp"

#include <cmath>
#include <cstdint>
#include <random>

#include <CppUTest/TestHarness.h>

namespace hal = millforce::hal;
using millforce::control::Limit;
using millforce::estimation::RoughnessModel;
using millforce::firmware::ForceControlTick;
using millforce::firmware::step_and_work;
using Parameters = millforce::firmware::Parameters<float>;

namespace {

constexpr float x_mm_s = 20.0F;
constexpr float z_mm_s = 5.0F;
constexpr float turns_per_s = 4000.0F / 60.0F;
constexpr float f_x_N = -150.0F;
constexpr float f_z_N = -200.0F;

/// Fitted around the cut below: 4000 rpm, 0.3 mm/rev, Ø10, 5 mm deep, F_x/F_z = 0.75, where R_a = 2 µm.
RoughnessModel<float> model() {
    RoughnessModel<float> m;
    m.exponent = {0.1F, 0.8F, 0.0F, 0.2F, -1.5F};
    m.reference = {4000.0F, 0.3F, 10.0F, 5.0F, 0.75F};
    m.minimum = {3500.0F, 0.15F, 10.0F, 4.0F, 0.5F};
    m.maximum = {4500.0F, 0.6F, 10.0F, 6.0F, 1.0F};
    m.constant_um = 2.0F;
    for (std::size_t j = 0; j < m.reference.size(); ++j) {
        m.constant_um *= std::pow(m.reference[j], -m.exponent[j]);
        m.leverage[m.pair(j, j)] = 0.3F;
    }
    m.tests = 30.0F;
    m.degrees_of_freedom = 25.0F;
    m.residual_ln_sd = 0.05F;
    m.largest_leverage = 0.4F;
    return m;
}

Parameters parameters_with(const RoughnessModel<float>& roughness) {
    Parameters p;
    p.machine.spindle.K_t1_Nm_per_A = 0.7F;
    p.machine.spindle.K_t2_Nm = -0.95F;
    for (auto& axis : p.machine.axes) {
        axis.K_x3_A = 1.6F;
        axis.K_x4_N_per_A = 120.0F;
        axis.friction_relative_sd = 0.01F;
        axis.gain_relative_sd = 0.02F;
    }
    p.tool.side = millforce::estimation::CutSide::down;
    p.tool.tooth_force_limit_N = 5000.0F;
    p.tool.declared_axial_depth_mm = 5.0F;
    p.tool.control.max_feed_per_tooth_mm = 1.0F;
    p.tool.law = millforce::estimation::linear_edge_law(1650.0F, 22.0F, 620.0F, 28.0F);
    p.tool.law.K_s_relative_sd = 0.5F;  // the forces are made up: the depth is not to be judged by them
    p.tool.roughness = roughness;
    return p;
}

/// A sloping way at 1 kHz and 4000 rpm: 0.2 s of air, then a cut.
hal::DriveSample sample_of(int index, const Parameters& p, float z_velocity_mm_s = z_mm_s) {
    const float turned_rev = static_cast<float>(index) * 0.001F * turns_per_s;
    const float load = index < 200 ? 0.0F : 1.0F;
    hal::DriveSample sample;
    sample.time_us = static_cast<std::uint32_t>(index) * 1000U;
    sample.spindle_count = static_cast<std::uint32_t>(turned_rev * 4096.0F);
    sample.present = hal::all_present;
    sample.spindle_current_A = (load * 250.0F * 0.005F - p.machine.spindle.K_t2_Nm) / p.machine.spindle.K_t1_Nm_per_A;
    sample.axis_current_A[0] = 1.6F + load * f_x_N / 120.0F;
    sample.axis_current_A[2] = (z_velocity_mm_s > 0.0F ? 1.6F : 0.0F) + load * f_z_N / 120.0F;
    sample.axis_velocity_mm_s = {x_mm_s, 0.0F, z_velocity_mm_s};
    return sample;
}

hal::ProgramStatus program() {
    hal::ProgramStatus status;
    status.programmed_feed_mm_s = std::hypot(x_mm_s, z_mm_s);
    return status;
}

void cut(ForceControlTick<float>& tick, const Parameters& p, int from = 0, float z_velocity_mm_s = z_mm_s) {
    for (int k = from; k < from + 800; ++k) {
        step_and_work(tick, sample_of(k, p, z_velocity_mm_s), program());
    }
}

Parameters with_limit(float Ra_limit_um) {
    Parameters p = parameters_with(model());
    p.tool.control.Ra_limit_um = Ra_limit_um;
    return p;
}

/// Its tables take longer to build than a thousand samples: cases begin with copies.
ForceControlTick<float> fresh_tick() {
    static const ForceControlTick<float> tick(parameters_with(model()));
    return tick;
}
constexpr float low_limit_um = 1.8F;
ForceControlTick<float> fresh_tick_with_low_limit() {
    static const ForceControlTick<float> tick(with_limit(low_limit_um));
    return tick;
}

}  // namespace

TEST_GROUP(RoughnessTick){};

TEST(RoughnessTick, predicts_R_a_with_its_interval_from_the_drives_currents) {
    const Parameters p = parameters_with(model());
    ForceControlTick<float> tick = fresh_tick();
    for (int k = 0; k < 200; ++k) {
        step_and_work(tick, sample_of(k, p), program());
        CHECK_FALSE(tick.roughness().valid);  // in air there is no ratio of forces
    }
    cut(tick, p, 200);
    const auto& R_a = tick.roughness();
    CHECK(R_a.is_sure());
    const double feed_mm_rev = std::hypot(20.0, 5.0) / static_cast<double>(turns_per_s);
    DOUBLES_EQUAL(2.0 * std::pow(feed_mm_rev / 0.3, 0.8), static_cast<double>(R_a.roughness_um), 0.06);
    CHECK(R_a.low_um < 0.9F * R_a.roughness_um && R_a.high_um > 1.1F * R_a.roughness_um);
}

TEST(RoughnessTick, has_no_prediction_where_z_stands_or_no_model_is_there) {
    const Parameters p = parameters_with(model());
    ForceControlTick<float> standing = fresh_tick();
    cut(standing, p, 0, 0.0F);
    CHECK(standing.estimate().feed_N.valid);
    CHECK_FALSE(standing.roughness().valid);
    const Parameters without = parameters_with({});
    ForceControlTick<float> tick(without);
    cut(tick, without);
    CHECK(tick.estimate().z_N.valid);
    CHECK_FALSE(tick.roughness().valid);
}

TEST(RoughnessTick, says_where_the_cut_is_outside_the_fitted_range) {
    RoughnessModel<float> deeper = model();
    deeper.minimum[3] = 7.0F;
    deeper.maximum[3] = 9.0F;
    const Parameters p = parameters_with(deeper);
    ForceControlTick<float> tick(p);
    cut(tick, p);
    CHECK(tick.roughness().valid);
    CHECK_FALSE(tick.roughness().in_range());
    LONGS_EQUAL(1U << millforce::estimation::roughness_axial_depth, tick.roughness().outside & 31U);
}

TEST(RoughnessTick, holds_the_feed_where_the_upper_bound_of_R_a_meets_its_limit) {
    const Parameters p = with_limit(low_limit_um);
    ForceControlTick<float> tick = fresh_tick_with_low_limit();
    cut(tick, p);
    CHECK(tick.control().limit == Limit::roughness);
    const float feed_mm_rev = tick.control().ratio * program().programmed_feed_mm_s / turns_per_s;
    auto predicted = model();
    const millforce::estimation::RoughnessPredictor<float> predictor(predicted);
    const auto then =
        predictor.predict({4000.0F, feed_mm_rev, 10.0F, 5.0F, 0.75F}, tick.estimate().feed_N, tick.estimate().z_N);
    DOUBLES_EQUAL(1.8, static_cast<double>(then.high_um), 0.01);
}

TEST(RoughnessTick, does_not_hold_the_feed_down_for_a_limit_that_is_far_away) {
    const Parameters p = with_limit(50.0F);
    ForceControlTick<float> tick(p);
    cut(tick, p);
    cut(tick, p, 800);
    CHECK(tick.control().ratio > 1.45F);
}

TEST(RoughnessTick, does_not_raise_the_feed_under_a_limit_without_a_prediction) {
    Parameters p = with_limit(low_limit_um);
    ForceControlTick<float> tick = fresh_tick_with_low_limit();
    cut(tick, p);
    const float held = tick.control().ratio;
    cut(tick, p, 800, 0.0F);
    CHECK_FALSE(tick.roughness().valid);
    CHECK(tick.control().ratio <= held);
    p.tool.roughness.measure = millforce::estimation::RoughnessMeasure::Rz;  // a model of R_z says nothing about R_a
    ForceControlTick<float> other(p);
    cut(other, p);
    const float at_contact = other.control().ratio;
    CHECK(other.roughness().valid);
    cut(other, p, 800);
    CHECK(other.control().ratio <= at_contact);
}

TEST(RoughnessTick, keeps_the_upper_bound_below_its_limit_in_a_loop_whose_surface_grows_rough) {
    Parameters p = with_limit(2.0F);
    p.tool.law.K_s_relative_sd = 1.0F;  // these forces stay as they are whatever the feed, and no law explains that
    p.tool.law.r_1_relative_sd = 1.0F;
    ForceControlTick<float> tick(p);
    float speed_share = 0.5F;  // of the programmed feed; follows the override with a lag of 20 ms
    float slowest = 10.0F;
    for (int k = 0; k < 6000; ++k) {
        const float z_share = k < 3000 ? 1.0F : 1.15F;  // F_x/F_z falls from 0.75 to 0.65: R_a grows by a fourth
        hal::DriveSample sample = sample_of(k, p);
        sample.axis_current_A[2] += k < 200 ? 0.0F : (z_share - 1.0F) * f_z_N / 120.0F;
        for (float& velocity : sample.axis_velocity_mm_s) {
            velocity *= speed_share;
        }
        speed_share += 0.05F * (step_and_work(tick, sample, program()).ratio - speed_share);
        const bool is_settled = (k > 2000 && k < 3000) || k > 3500;
        if (is_settled) {
            CHECK(tick.roughness().is_sure());
            CHECK(tick.roughness().high_um < 1.005F * 2.0F);
            CHECK(tick.roughness().high_um > 0.97F * 2.0F);  // and no slower than that takes
            CHECK(tick.control().limit == Limit::roughness);
        }
        slowest = k < 3000 ? speed_share : slowest;
    }
    CHECK(speed_share < 0.9F * slowest);
}

TEST(RoughnessTick, gives_a_sound_ratio_and_no_rise_for_the_roughness_sake_whatever_the_sample_says) {
    std::mt19937 engine(815);
    const auto anything = [&engine](float sensible) {
        const float extremes[] = {std::nanf(""), INFINITY, -INFINITY, 3e38F, -3e38F, 1e-40F, 0.0F, -1.0F};
        return engine() % 8U == 0U ? extremes[engine() % 8U] : sensible;
    };
    Parameters p = with_limit(low_limit_um);
    p.tool.control.turn_radial_immersion = 0.0F;  // these axes follow no override, which would count as braking
    ForceControlTick<float> limited(p);
    p.tool.control.Ra_limit_um = 0.0F;
    ForceControlTick<float> free(p);
    for (int k = 0; k < 20000; ++k) {
        hal::DriveSample sample = sample_of(k % 3000, p);
        sample.spindle_count = static_cast<std::uint32_t>(static_cast<float>(k) * 273.07F);
        sample.time_us = static_cast<std::uint32_t>(k) * 1000U;
        sample.axis_current_A[2] = anything(sample.axis_current_A[2]);
        sample.axis_current_A[0] = anything(sample.axis_current_A[0]);
        sample.axis_velocity_mm_s[2] = anything(sample.axis_velocity_mm_s[2]);
        const float ratio = step_and_work(limited, sample, program()).ratio;
        CHECK(ratio >= 0.1F && ratio <= step_and_work(free, sample, program()).ratio + 1e-6F);
        if (limited.roughness().valid) {
            CHECK(limited.roughness().roughness_um > 0.0F && std::isfinite(limited.roughness().roughness_um));
        }
    }
}
