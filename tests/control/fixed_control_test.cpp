// SPDX-License-Identifier: Apache-2.0
#include "control/feed_bench.hpp"
#include "control/feed_controller.hpp"
#include "estimation/number/fixed_point.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

// The law in fixed point beside the law in float: 10⁵ operating points, each a controller of its own, brought into the
// cut and asked for its override.

using namespace millforce::control;
using namespace millforce::control::bench;
using millforce::estimation::Fixed;

namespace {

FeedControllerParameters<Fixed> in_fixed(const Parameters& p) {
    FeedControllerParameters<Fixed> q;
    q.tooth_force_limit_N = Fixed(p.tooth_force_limit_N);
    q.setpoint_share = Fixed(p.setpoint_share);
    q.teeth = Fixed(p.teeth);
    q.stale_s = Fixed(p.stale_s);
    q.override_min = Fixed(p.override_min);
    q.override_max = Fixed(p.override_max);
    q.recovery_per_rev = Fixed(p.recovery_per_rev);
    q.slew_up_per_s = Fixed(p.slew_up_per_s);
    q.slew_down_per_s = Fixed(p.slew_down_per_s);
    q.max_feed_per_tooth_mm = Fixed(p.max_feed_per_tooth_mm);
    q.entry_revolutions = Fixed(p.entry_revolutions);
    q.entry_travel_mm = Fixed(p.entry_travel_mm);
    q.contact_force_N = Fixed(p.contact_force_N);
    q.overload_share = Fixed(p.overload_share);
    q.depth_step_ratio = Fixed(p.depth_step_ratio);
    return q;
}

ControlInput<Fixed> in_fixed(const Input& i) {
    ControlInput<Fixed> j;
    j.dt_s = Fixed(i.dt_s);
    j.programmed_feed_mm_s = Fixed(i.programmed_feed_mm_s);
    j.path_speed_mm_s = Fixed(i.path_speed_mm_s);
    j.velocity_x_mm_s = Fixed(i.velocity_x_mm_s);
    j.cut.fresh = i.cut.fresh;
    j.cut.force_valid = i.cut.force_valid;
    j.cut.tangential_N = Fixed(i.cut.tangential_N);
    j.cut.tangential_sd_N = Fixed(i.cut.tangential_sd_N);
    j.cut.tooth_force_valid = i.cut.tooth_force_valid;
    j.cut.tooth_force_N = Fixed(i.cut.tooth_force_N);
    j.cut.cutting_share = Fixed(i.cut.cutting_share);
    j.cut.feed_exponent = Fixed(i.cut.feed_exponent);
    j.cut.feed_mm_s = Fixed(i.cut.feed_mm_s);
    j.cut.spindle_speed_rad_s = Fixed(i.cut.spindle_speed_rad_s);
    j.cut.spindle_turning = i.cut.spindle_turning;
    return j;
}

Input drawn_cut(Dice& dice, const Parameters& parameters) {
    Input input = in_contact();
    input.dt_s = 0.01F;
    input.programmed_feed_mm_s = dice.between(0.5F, 200.0F);
    input.path_speed_mm_s = input.programmed_feed_mm_s * dice.between(0.1F, 1.5F);
    input.velocity_x_mm_s = input.path_speed_mm_s;
    input.cut.feed_mm_s = input.path_speed_mm_s;
    input.cut.tooth_force_N = parameters.tooth_force_limit_N * dice.between(0.1F, 1.3F);
    input.cut.tangential_N = input.cut.tooth_force_N * dice.between(0.2F, 2.0F);
    input.cut.tangential_sd_N = 0.02F * input.cut.tangential_N;
    input.cut.cutting_share = dice.between(0.2F, 1.0F);
    input.cut.feed_exponent = dice.between(0.5F, 1.0F);
    input.cut.spindle_speed_rad_s = dice.between(20.0F, 2500.0F);
    return input;
}

}  // namespace

TEST_GROUP(FixedControl){};

TEST(FixedControl, agrees_with_float_to_0_005_of_the_override_over_the_operating_range) {
    Dice dice(20261121);
    float worst = 0.0F;
    int in_cut = 0;
    constexpr int points = 100000;
    for (int k = 0; k < points; ++k) {
        Parameters parameters = immediate();
        parameters.override_min = 0.05F;
        parameters.override_max = 2.0F;
        parameters.tooth_force_limit_N = std::exp(dice.between(0.0F, 10.0F));
        parameters.depth_step_ratio = dice.between(1.0F, 3.0F);
        parameters.contact_force_N = 0.01F * parameters.tooth_force_limit_N;
        const Input input = drawn_cut(dice, parameters);
        FeedController<float> controller(parameters);
        FeedController<Fixed> fixed(in_fixed(parameters));
        const ControlInput<Fixed> same = in_fixed(input);
        Output output;
        ControlOutput<Fixed> fixed_output;
        for (int step = 0; step < 3; ++step) {
            output = controller.step(input);
            fixed_output = fixed.step(same);
        }
        CHECK_TRUE(output.state == fixed_output.state);
        in_cut += output.state == CutState::in_cut ? 1 : 0;
        const float difference = std::abs(output.ratio - static_cast<float>(fixed_output.ratio));
        worst = difference > worst ? difference : worst;
    }
    CHECK_COMPARE(in_cut, >=, points * 9 / 10);
    CHECK_COMPARE(worst, <, 0.005F);
    UNSIGNED_LONGS_EQUAL(0, millforce::estimation::saturations());
}
