// SPDX-License-Identifier: Apache-2.0
#include "control/spindle_torque.hpp"

#include <CppUTest/TestHarness.h>

#include <limits>

using namespace millforce::control;

namespace {

constexpr float full_rad_s = 400.0F;
constexpr float step_s = 0.01F;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// A spindle in a cut of 300 N.
class Spindle {
  public:
    Spindle() { turns_at(full_rad_s, CutState::air); }

    void turns_at(float speed_rad_s, CutState state = CutState::in_cut) {
        cut_.spindle_speed_rad_s = speed_rad_s;
        torque_.follow(cut_, state, step_s);
    }
    void stays_at(float speed_rad_s, float time_s) {
        for (float t_s = 0.0F; t_s < time_s; t_s += step_s) {
            turns_at(speed_rad_s);
        }
    }
    void carries(float tangential_N, bool is_valid = true, bool is_fresh = true) {
        cut_.tangential_N = tangential_N;
        cut_.force_valid = is_valid;
        cut_.fresh = is_fresh;
    }
    [[nodiscard]] const SpindleTorque<float>& torque() const { return torque_; }

  private:
    SpindleTorque<float> torque_{};
    CutEstimateForControl<float> cut_ = [] {
        CutEstimateForControl<float> cut;
        cut.fresh = true;
        cut.force_valid = true;
        cut.tangential_N = 300.0F;
        return cut;
    }();
};

}  // namespace

TEST_GROUP(SpindleTorque) {
    Spindle spindle;
};

TEST(SpindleTorque, takes_five_per_cent_less_speed_for_the_drives_own_control) {
    spindle.turns_at(0.951F * full_rad_s);
    CHECK_FALSE(spindle.torque().is_slow());
    spindle.turns_at(0.949F * full_rad_s);
    CHECK(spindle.torque().is_slow());
}

TEST(SpindleTorque, learns_the_force_that_the_spindle_can_give_once_a_lower_feed_has_brought_the_speed_back) {
    spindle.turns_at(0.94F * full_rad_s);
    spindle.turns_at(0.97F * full_rad_s);
    CHECK(spindle.torque().is_slow());
    DOUBLES_EQUAL(0.0, spindle.torque().largest_tangential_N(), 0.0);
    spindle.turns_at(0.985F * full_rad_s);
    CHECK_FALSE(spindle.torque().is_slow());
    DOUBLES_EQUAL(270.0, spindle.torque().largest_tangential_N(), 0.01);
}

TEST(SpindleTorque, learns_the_force_from_the_loss_on_and_none_where_there_is_no_estimate) {
    spindle.carries(20.0F);
    spindle.turns_at(full_rad_s);
    spindle.turns_at(0.94F * full_rad_s);
    spindle.carries(500.0F, false);
    spindle.turns_at(0.95F * full_rad_s);
    spindle.carries(not_a_number, false);
    spindle.turns_at(0.95F * full_rad_s);
    spindle.carries(500.0F, true, false);
    spindle.turns_at(0.95F * full_rad_s);
    spindle.turns_at(full_rad_s);
    DOUBLES_EQUAL(0.0, spindle.torque().largest_tangential_N(), 0.0);
    spindle.turns_at(0.94F * full_rad_s);
    spindle.carries(200.0F);
    spindle.turns_at(0.95F * full_rad_s);
    spindle.carries(240.0F);
    spindle.turns_at(0.97F * full_rad_s);
    spindle.carries(50.0F);
    spindle.turns_at(full_rad_s);
    DOUBLES_EQUAL(0.9 * 210.0, spindle.torque().largest_tangential_N(), 0.01);
}

TEST(SpindleTorque, keeps_what_it_has_learnt_through_a_loss_without_an_estimate) {
    for (const bool has_estimate : {true, false}) {
        spindle.carries(300.0F, has_estimate);
        spindle.turns_at(0.94F * full_rad_s);
        spindle.turns_at(0.95F * full_rad_s);
        spindle.turns_at(full_rad_s);
        DOUBLES_EQUAL(270.0, spindle.torque().largest_tangential_N(), 0.01);
    }
}

TEST(SpindleTorque, counts_from_the_highest_speed_of_the_cut) {
    spindle.turns_at(1.2F * full_rad_s);
    spindle.turns_at(1.12F * full_rad_s);
    CHECK(spindle.torque().is_slow());
}

TEST(SpindleTorque, takes_a_speed_that_stays_for_a_second_for_the_one_that_was_asked_for_and_learns_no_force) {
    spindle.stays_at(0.8F * full_rad_s, 0.9F);
    CHECK(spindle.torque().is_slow());
    spindle.stays_at(0.8F * full_rad_s, 0.2F);
    CHECK_FALSE(spindle.torque().is_slow());
    DOUBLES_EQUAL(0.0, spindle.torque().largest_tangential_N(), 0.0);
    spindle.turns_at(0.77F * full_rad_s);
    CHECK_FALSE(spindle.torque().is_slow());
}

TEST(SpindleTorque, does_not_take_a_speed_that_goes_on_changing_for_one_that_was_asked_for) {
    float speed_rad_s = 0.94F * full_rad_s;
    for (const float per_step : {0.9997F, 1.0003F}) {  // 3 % in a second
        for (int i = 0; i < 300; ++i) {
            spindle.turns_at(speed_rad_s);
            CHECK(spindle.torque().is_slow());
            speed_rad_s *= per_step;
        }
    }
}

TEST(SpindleTorque, stalls_where_two_thirds_of_the_speed_are_lost) {
    spindle.turns_at(0.9F * full_rad_s);
    spindle.turns_at(0.34F * full_rad_s);
    CHECK_FALSE(spindle.torque().stalls());
    spindle.turns_at(0.33F * full_rad_s);
    CHECK(spindle.torque().stalls());
}

TEST(SpindleTorque, asks_nothing_of_a_spindle_out_of_the_cut_or_while_the_feed_is_held) {
    for (const CutState state : {CutState::air, CutState::exit, CutState::hold}) {
        spindle.turns_at(full_rad_s);
        spindle.turns_at(0.5F * full_rad_s, state);
        CHECK_FALSE(spindle.torque().is_slow());
        spindle.turns_at(0.48F * full_rad_s);
        CHECK_FALSE(spindle.torque().is_slow());
    }
}

TEST(SpindleTorque, keeps_what_it_knows_where_the_speed_is_not_known) {
    spindle.turns_at(0.9F * full_rad_s);
    spindle.turns_at(0.0F);
    CHECK(spindle.torque().is_slow());
    CHECK_FALSE(spindle.torque().stalls());
}
