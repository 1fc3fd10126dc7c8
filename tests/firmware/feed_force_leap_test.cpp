// SPDX-License-Identifier: Apache-2.0
#include "firmware/feed_force_leap.hpp"

#include <CppUTest/TestHarness.h>

using millforce::estimation::CutEstimate;
using FeedForceLeap = millforce::firmware::FeedForceLeap<float>;

namespace {

constexpr float teeth = 4.0F;
constexpr float radius_mm = 5.0F;
constexpr float feed_per_tooth_mm = 0.01F;  // 0.12 mm in three revolutions
constexpr float noise_N = 4.0F;             // of a revolution's force along the feed

/// A light cut.
CutEstimate<float> cut(float feed_N, float tangential_N = 80.0F) {
    CutEstimate<float> e;
    e.feed_N = {true, feed_N, noise_N * noise_N, noise_N * noise_N};
    e.tangential_N = {true, tangential_N, 1.0F, 1.0F};
    e.feed_per_tooth_mm = feed_per_tooth_mm;
    e.feed_mm_s = 2.0F;
    e.spindle_speed_rad_s = 5.0F;
    return e;
}

class Followed {
  public:
    explicit Followed(float hidden_N = 0.0F) : leap_(teeth, 1.0F / radius_mm, hidden_N / (2.0F * 5.0F)) {}
    Followed& turns(const CutEstimate<float>& e, int revolutions) {
        for (int k = 0; k < revolutions; ++k) {
            is_found = leap_.follow(e) || is_found;
        }
        return *this;
    }
    bool is_found = false;

  private:
    FeedForceLeap leap_;
};

/// What a leap must exceed while F_at stays: 3 (s/R) F_at, and five deviations of the difference of two revolutions.
constexpr float most_N = 3.0F * (3.0F * teeth * feed_per_tooth_mm / radius_mm) * 80.0F + 5.0F * 1.4142F * noise_N;

}  // namespace

TEST_GROUP(FeedForceLeap){};

TEST(FeedForceLeap, is_an_axis_force_that_changes_while_F_at_stays) {
    for (const float sign : {-1.0F, 1.0F}) {
        CHECK_TRUE(Followed().turns(cut(-40.0F), 3).turns(cut(-40.0F + sign * 1.05F * most_N), 2).is_found);
        CHECK_FALSE(Followed().turns(cut(-40.0F), 3).turns(cut(-40.0F + sign * 0.95F * most_N), 2).is_found);
    }
}

TEST(FeedForceLeap, is_seen_while_the_cut_begins) {
    Followed begun;
    for (int k = 1; k <= 5; ++k) {
        begun.turns(cut(-8.0F * static_cast<float>(k), 16.0F * static_cast<float>(k)), 1);
    }
    CHECK_FALSE(begun.is_found);
    CHECK_TRUE(begun.turns(cut(100.0F), 2).is_found);
}

TEST(FeedForceLeap, is_none_where_F_at_changes_half_as_much) {
    CHECK_FALSE(Followed().turns(cut(-40.0F, 80.0F), 3).turns(cut(-240.0F, 180.0F), 5).is_found);
    CHECK_FALSE(Followed().turns(cut(-240.0F, 180.0F), 3).turns(cut(-40.0F, 80.0F), 5).is_found);
    CHECK_TRUE(Followed().turns(cut(-40.0F, 80.0F), 3).turns(cut(-240.0F, 100.0F), 5).is_found);
}

TEST(FeedForceLeap, is_none_that_lasts_for_one_revolution) {
    CHECK_FALSE(Followed().turns(cut(-40.0F), 3).turns(cut(200.0F), 1).turns(cut(-40.0F), 5).is_found);
}

TEST(FeedForceLeap, leaves_room_for_the_inertia_that_a_feed_may_hide) {
    CHECK_FALSE(Followed(20.1F).turns(cut(-40.0F), 3).turns(cut(-20.0F + most_N), 5).is_found);
    CHECK_TRUE(Followed(19.0F).turns(cut(-40.0F), 3).turns(cut(-20.0F + most_N), 5).is_found);
}

TEST(FeedForceLeap, begins_anew_after_a_force_that_is_not_known) {
    CutEstimate<float> without_axis = cut(0.0F);
    without_axis.feed_N.valid = false;
    CutEstimate<float> without_spindle = cut(0.0F);
    without_spindle.tangential_N.valid = false;
    for (const CutEstimate<float>& unknown : {without_axis, without_spindle}) {
        CHECK_FALSE(Followed().turns(cut(-40.0F), 3).turns(unknown, 1).turns(cut(200.0F), 5).is_found);
    }
}

TEST(FeedForceLeap, compares_nothing_until_two_revolutions_are_known) {
    CHECK_FALSE(Followed().turns(cut(-40.0F), 1).turns(cut(200.0F), 5).is_found);
    CHECK_TRUE(Followed().turns(cut(-40.0F), 2).turns(cut(200.0F), 5).is_found);
}
