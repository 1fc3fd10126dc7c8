// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "control/ceilings_impl.hpp"
#include "control/cut_states_impl.hpp"
#include "control/cut_trend_impl.hpp"
#include "control/feed_controller_impl.hpp"
#include "control/feed_law_impl.hpp"
#include "control/path_turn_impl.hpp"
#include "control/spindle_torque_impl.hpp"
#include "estimation/cut_estimator_impl.hpp"
#include "estimation/cutting/peak_table_impl.hpp"
#include "estimation/number/circle.hpp"
#include "estimation/number/fixed_point.hpp"
#include "estimation/surface/roughness_impl.hpp"
#include "firmware/parameters_in_impl.hpp"
#include "firmware/signal_supervisor_impl.hpp"
#include "firmware/tick_impl.hpp"
#include "instructions/synthetic_cut.hpp"

#include <CppUTest/TestHarness.h>

// The tick in fixed point beside the tick in float, on the same samples, over the operating range: tools from 3 to 80
// mm and 1 to 8 teeth, soft and hard materials, 300 to 24 000 rpm, any immersion, side and direction of feed. Each new
// estimate of the engagement is an operating point. MILLFORCE_FIXED_TOOLS names another number of tools than 10, of 150
// points each, MILLFORCE_FIXED_SEED another seed.

using namespace millforce;
using estimation::CutSide;

namespace {

/// Sees every result of every operation in the tick.
struct Range {
    static inline std::int64_t largest = 0;
    static inline std::uint32_t saturations = 0;
    static constexpr void saturated() {
        if (!std::is_constant_evaluated()) {
            ++saturations;
        }
    }
    static constexpr void saw(std::int64_t result) {
        if (!std::is_constant_evaluated()) {
            const std::int64_t size = result < 0 ? -result : result;
            largest = size > largest ? size : largest;
        }
    }
};
using Watched = estimation::FixedPoint<Range>;

class Draw {
  public:
    explicit Draw(std::uint32_t seed) : engine_(seed) {}
    float between(float low, float high) {
        return low + (high - low) * static_cast<float>(engine_() >> 8U) / 16777216.0F;
    }
    float log_between(float low, float high) { return std::exp(between(std::log(low), std::log(high))); }
    unsigned below(unsigned count) { return static_cast<unsigned>(engine_() % count); }

  private:
    std::mt19937 engine_;
};

struct Shop {
    firmware::Parameters<float> parameters;
    float spindle_speed_rad_s;
    float programmed_feed_mm_s;
};

constexpr float largest_force_N = 10000.0F;

Shop drawn_shop(Draw& draw) {
    Shop shop{};
    auto& p = shop.parameters;
    p = instructions::machine_and_tool();
    p.tool.diameter_mm = draw.log_between(3.0F, 80.0F);
    p.tool.teeth = static_cast<std::uint8_t>(1U + draw.below(8));
    p.tool.helix_deg = draw.between(0.0F, 45.0F);
    p.tool.flute_length_mm = 2.0F * p.tool.diameter_mm;
    p.tool.side = draw.below(2) == 0 ? CutSide::down : CutSide::up;
    const float chip_mm = p.tool.diameter_mm * draw.between(0.003F, 0.008F);
    const float K_s = draw.log_between(600.0F, 4000.0F);
    p.tool.law = estimation::linear_edge_law(K_s, 0.013F * K_s, 0.35F * K_s, 0.016F * K_s);
    p.tool.law.p_s = draw.between(-0.3F, 0.0F);
    p.tool.law.K_s_relative_sd = draw.between(0.02F, 0.3F);
    p.tool.law.r_1_relative_sd = draw.between(0.02F, 0.1F);
    p.tool.control.entry_feed_per_tooth_mm = 0.5F * chip_mm;
    p.tool.control.air_feed_per_tooth_mm = 0.5F * chip_mm;
    p.tool.control.max_feed_per_tooth_mm = 2.0F * chip_mm;
    const float full_load_N = 0.6F * K_s * chip_mm * p.tool.diameter_mm;
    p.tool.tooth_force_limit_N = full_load_N < largest_force_N ? full_load_N : largest_force_N;
    p.tool.control.contact_force_N = 0.02F * p.tool.tooth_force_limit_N;
    shop.spindle_speed_rad_s = draw.log_between(31.0F, 2513.0F);
    shop.programmed_feed_mm_s = chip_mm * p.tool.teeth * shop.spindle_speed_rad_s / estimation::turn_rad<float>;
    // The drives fit the tool: full load is a few tens of amperes on each.
    const float force_N = 2.0F * p.tool.tooth_force_limit_N;
    p.machine.spindle.K_t1_Nm_per_A = force_N * p.tool.diameter_mm * 0.0005F / 30.0F;
    p.machine.spindle.K_t2_Nm = -2.0F * p.machine.spindle.K_t1_Nm_per_A;
    p.machine.spindle.idle_torque_sd_Nm = 0.2F * p.machine.spindle.K_t1_Nm_per_A;
    p.machine.spindle.inertia_kg_m2 = 1e-6F * p.tool.diameter_mm * p.tool.diameter_mm;
    for (auto& axis : p.machine.axes) {
        axis.K_x4_N_per_A = force_N / 20.0F;
        axis.velocity_floor_mm_s = 0.05F * shop.programmed_feed_mm_s;
    }
    return shop;
}

/// A sample rate that sees each tooth a few times at any speed.
float sample_interval_s(const Shop& shop) {
    const float tooth_s = estimation::turn_rad<float> / (shop.spindle_speed_rad_s * shop.parameters.tool.teeth);
    return tooth_s < 0.004F ? 0.001F : (tooth_s > 0.04F ? 0.01F : 0.25F * tooth_s);
}

struct Cut {
    float immersion = 0.0F;
    float depth_mm = 0.0F;
    float direction_rad = 0.0F;
};

struct Clock {
    float time_s = 0.0F;
    float turned_counts = 0.0F;
    std::uint32_t time_us = 0;
    std::uint32_t count = 0;
};

/// A cut that keeps the mean force below twice the tooth's limit.
Cut drawn_cut(const Shop& shop, bool in_air, Draw& draw) {
    const auto& tool = shop.parameters.tool;
    Cut cut;
    cut.immersion = in_air ? 0.0F : draw.between(0.03F, 2.0F);
    cut.direction_rad = draw.between(-3.14F, 3.14F);
    const float share = draw.log_between(0.2F, 2.0F);
    const auto per_mm = estimation::average_forces(
        tool.law, estimation::CutConditions<float>{2.0F * tool.control.entry_feed_per_tooth_mm, 1.0F,
                                                   estimation::engagement_angles(tool.side, cut.immersion, 0.0F),
                                                   static_cast<float>(tool.teeth)});
    const float most_mm = tool.flute_length_mm;
    const float depth_mm = in_air ? 0.0F : share * tool.tooth_force_limit_N / per_mm.tangential_N;
    cut.depth_mm = depth_mm < most_mm ? depth_mm : most_mm;
    return cut;
}

/// What the drives show of a cut at this feed, with 2 % of noise.
hal::DriveSample sample_of(const Shop& shop, const Cut& cut, float feed_mm_s, Clock& clock, Draw& draw) {
    const auto& p = shop.parameters;
    const float dt_s = sample_interval_s(shop);
    clock.time_us += static_cast<std::uint32_t>(dt_s * 1e6F);
    clock.turned_counts += dt_s * shop.spindle_speed_rad_s / estimation::turn_rad<float> *
                           static_cast<float>(p.machine.encoder_counts_per_rev);
    const auto whole = static_cast<std::uint32_t>(clock.turned_counts);
    clock.count += whole;
    clock.turned_counts -= static_cast<float>(whole);
    const float feed_per_tooth_mm = feed_mm_s * estimation::turn_rad<float> / (shop.spindle_speed_rad_s * p.tool.teeth);
    const auto forces = estimation::average_forces(
        p.tool.law, estimation::CutConditions<float>{feed_per_tooth_mm, cut.depth_mm,
                                                     estimation::engagement_angles(p.tool.side, cut.immersion, 0.0F),
                                                     static_cast<float>(p.tool.teeth)});
    const float c = std::cos(cut.direction_rad);
    const float s = std::sin(cut.direction_rad);
    const float force_N[] = {c * forces.feed_N - s * forces.normal_N, s * forces.feed_N + c * forces.normal_N, 0.0F};
    const float velocity_mm_s[] = {c * feed_mm_s, s * feed_mm_s, 0.0F};
    hal::DriveSample sample;
    sample.time_us = clock.time_us;
    sample.spindle_count = clock.count;
    sample.present = hal::all_present;
    const auto noisy = [&draw](float current_A) { return current_A + draw.between(-0.1F, 0.1F); };
    const float torque_Nm = forces.tangential_N * p.tool.diameter_mm * 0.0005F;
    sample.spindle_current_A = noisy((torque_Nm - p.machine.spindle.K_t2_Nm) / p.machine.spindle.K_t1_Nm_per_A);
    for (std::size_t k = 0; k < hal::axis_count; ++k) {
        const auto& axis = p.machine.axes[k];
        const float speed_m_min = std::abs(velocity_mm_s[k]) * 0.06F;
        const float friction_A = speed_m_min > 0.0F ? axis.positive.at(speed_m_min) + axis.K_x3_A : 0.0F;
        sample.axis_velocity_mm_s[k] = velocity_mm_s[k];
        sample.axis_current_A[k] =
            noisy((velocity_mm_s[k] < 0.0F ? -friction_A : friction_A) + force_N[k] / axis.K_x4_N_per_A);
    }
    return sample;
}

struct Agreement {
    int points = 0;
    int with_depth = 0;
    int doubtful = 0;          ///< one of both says "no estimate"
    int apart = 0;             ///< immersion by 0.01 or more, depth by 1 % or more
    float worst_in_sd = 0.0F;  ///< of the immersion
    int other_state = 0;       ///< samples at which one of both has not yet decided what the other has
    int samples = 0;
};

template <typename Scalar>
void compare(const firmware::SmallTick<float>& a, const firmware::SmallTick<Scalar>& b, Agreement& agreement) {
    const auto& in_float = a.estimate().engagement;
    const auto& in_fixed = b.estimate().engagement;
    if (in_float.immersion_valid != in_fixed.immersion_valid || in_float.depth_valid != in_fixed.depth_valid) {
        ++agreement.doubtful;
        return;
    }
    if (!in_float.immersion_valid) {
        return;
    }
    ++agreement.points;
    const float immersions_apart = std::abs(in_float.radial_immersion - static_cast<float>(in_fixed.radial_immersion));
    float depths_apart = 0.0F;
    if (in_float.depth_valid) {
        ++agreement.with_depth;
        const float depth_mm = in_float.axial_depth_mm;
        depths_apart = std::abs(depth_mm - static_cast<float>(in_fixed.axial_depth_mm)) / depth_mm;
    }
    agreement.apart += immersions_apart < 0.01F && depths_apart < 0.01F ? 0 : 1;
    agreement.worst_in_sd = std::max(agreement.worst_in_sd, immersions_apart / in_float.radial_immersion_sd);
}

unsigned number_from_environment(const char* name, unsigned usual) {
    const char* text = std::getenv(name);
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : usual;
}

constexpr int samples_per_cut = 120;

/// Mills with one tool until so many operating points are seen. Both ticks see the same machine, which follows float.
template <typename Scalar>
void mill(Draw& draw, int points, Agreement& agreement) {
    const Shop shop = drawn_shop(draw);
    firmware::SmallTick<float> in_float(shop.parameters);
    firmware::SmallTick<Scalar> in_fixed(firmware::parameters_in<Scalar>(shop.parameters));
    hal::ProgramStatus program;
    program.programmed_feed_mm_s = shop.programmed_feed_mm_s;
    Clock clock;
    Cut cut;
    float override_ratio = 0.5F;
    const int wanted = agreement.points + points;
    const int most_samples = 40 * points;
    for (int k = 0; agreement.points < wanted && k < most_samples; ++k) {
        if (k % samples_per_cut == 0) {
            cut = drawn_cut(shop, k % (10 * samples_per_cut) == 0, draw);
        }
        const float feed_mm_s = override_ratio * shop.programmed_feed_mm_s;
        const hal::DriveSample sample = sample_of(shop, cut, feed_mm_s, clock, draw);
        const float before_s = in_float.estimator().since_period_s();
        const hal::FeedOverride a = firmware::step_and_work(in_float, sample, program);
        const hal::FeedOverride b = firmware::step_and_work(in_fixed, sample, program);
        ++agreement.samples;
        agreement.other_state += a.state != b.state || a.fault != b.fault ? 1 : 0;
        override_ratio = a.ratio;
        if (in_float.estimator().since_period_s() < before_s) {
            compare(in_float, in_fixed, agreement);
        }
    }
}

}  // namespace

TEST_GROUP(FixedTick){};

TEST(FixedTick, agrees_with_float_over_the_operating_range) {
    Draw draw(number_from_environment("MILLFORCE_FIXED_SEED", 20261121));
    Agreement agreement;
    const int tools = static_cast<int>(number_from_environment("MILLFORCE_FIXED_TOOLS", 10));
    constexpr int points_per_tool = 150;
    for (int tool = 0; tool < tools; ++tool) {
        mill<estimation::Fixed>(draw, points_per_tool, agreement);
    }
    CHECK_COMPARE(agreement.points, >=, tools * points_per_tool / 2);
    CHECK_COMPARE(agreement.with_depth, >=, agreement.points / 2);
    // None of 1 200. Of 10⁵ one or two lie in a misfit so flat that the last digits decide, within its standard
    // deviation.
    CHECK_COMPARE(agreement.apart, <=, agreement.points / 10000);
    CHECK_COMPARE(agreement.worst_in_sd, <, 1.0F);
    // Where a force stands at a threshold the two may decide a sample apart, or one may see no estimate.
    CHECK_COMPARE(agreement.doubtful, <=, agreement.points / 500);
    CHECK_COMPARE(agreement.other_state, <=, agreement.samples / 2000);
    UNSIGNED_LONGS_EQUAL(0, estimation::saturations());
}

TEST(FixedTick, no_intermediate_overflows_anywhere_in_the_operating_range) {
    Draw draw(4);
    Agreement agreement;
    Range::saturations = 0;
    for (int tool = 0; tool < 8; ++tool) {
        mill<Watched>(draw, 60, agreement);
    }
    CHECK_COMPARE(agreement.points, >=, 150);
    UNSIGNED_LONGS_EQUAL(0, Range::saturations);
    // The highest bit of the range was never used.
    CHECK_COMPARE(Range::largest, <, INT64_MAX / 2);
}
