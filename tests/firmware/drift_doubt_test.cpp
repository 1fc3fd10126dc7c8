// SPDX-License-Identifier: Apache-2.0
#include "firmware/drift_doubt_impl.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <initializer_list>

#include "estimation/cut_estimate.hpp"
#include "firmware/default_parameters.hpp"

using DriftDoubt = millforce::firmware::DriftDoubt<float>;
using millforce::estimation::CutEstimate;
using millforce::firmware::DoubtStage;
using Parameters = millforce::firmware::Parameters<float>;

namespace {

constexpr float usual_feed_mm_s = 10.0F;
constexpr float tooth_period_s = 0.01F;
constexpr DoubtStage in_cut{true, true, false, false};

Parameters parameters() {
    Parameters p = millforce::firmware::default_parameters<float>();
    p.machine.spindle_rated_current_A = 12.0F;
    p.machine.axis_rated_current_A = {12.0F, 12.0F, 12.0F};
    p.machine.axes[0].K_x4_N_per_A = p.machine.axes[1].K_x4_N_per_A = 100.0F;
    p.tool.control.entry_feed_per_tooth_mm = 0.02F;
    return p;
}

/// A cut whose feed follows the bound. Its width makes the force on a tooth smaller by `widening`.
class Milling {
  public:
    explicit Milling(const Parameters& with = parameters()) : doubt_(with) {}

    float programmed_mm_s = usual_feed_mm_s;
    float period_s = tooth_period_s;
    float tangential_N = 300.0F;
    float feed_N = 150.0F;
    float feed_drift_N = 0.0F;
    float widening = 1.0F;
    float deepening = 1.0F;
    DoubtStage stage = in_cut;

    float mill(int estimates) {
        float tooth_N = 0.0F;
        for (int k = 0; k < estimates; ++k) {
            const float bound_mm_s = doubt_.bound_mm_s();
            const float last_feed_mm_s = feed_mm_s_;
            feed_mm_s_ = bound_mm_s > 0.0F ? std::fmin(bound_mm_s, programmed_mm_s) : programmed_mm_s;
            lowest_mm_s_ = std::fmin(lowest_mm_s_, feed_mm_s_);
            dips_ += feed_mm_s_ < last_feed_mm_s ? 1 : 0;
            const CutEstimate<float> e = estimate();
            tooth_N = doubt_.follow(e, e.tooth_force_N.value, period_s, stage).tooth_N / e.tangential_N.value;
        }
        return tooth_N;
    }
    [[nodiscard]] bool may_still_cut() const { return doubt_.may_still_cut(estimate()); }
    [[nodiscard]] float lowest_mm_s() const { return lowest_mm_s_; }
    [[nodiscard]] int dips() const { return dips_; }
    DriftDoubt& doubt() { return doubt_; }

  private:
    [[nodiscard]] CutEstimate<float> estimate() const {
        const float share = std::sqrt(feed_mm_s_ / usual_feed_mm_s);
        CutEstimate<float> e;
        e.feed_mm_s = feed_mm_s_;
        e.feed_per_tooth_mm = feed_mm_s_ * tooth_period_s;
        e.tooth_periods = 1;
        e.tangential_N = {true, tangential_N * share, 1.0F, 1.0F};
        e.feed_N = {true, feed_N * share + feed_drift_N, 1.0F, 1.0F};
        e.x_N = e.feed_N;
        e.tooth_force_N = {true, 2.0F * e.tangential_N.value / widening, 1.0F, 1.0F};
        e.engagement.immersion_valid = true;
        e.engagement.radial_immersion = 0.5F * widening;
        e.engagement.radial_immersion_sd = 0.05F;
        e.engagement.depth_valid = true;
        e.engagement.axial_depth_mm = 5.0F * deepening;
        return e;
    }

    DriftDoubt doubt_;
    float feed_mm_s_ = usual_feed_mm_s;
    float lowest_mm_s_ = usual_feed_mm_s;
    int dips_ = 0;
};

/// Half of the force along the feed is drift, and the cut seems to have changed in width and depth.
void mill_into_doubt(Milling& milling) {
    milling.widening = 1.4F;
    milling.deepening = 0.7F;
    milling.feed_N = 75.0F;
    milling.feed_drift_N = 75.0F;
    milling.mill(40);
}
void jump(Milling& milling, int estimates) {
    milling.tangential_N = 450.0F;
    milling.feed_N = 150.0F;
    milling.mill(estimates);
}

void check_bound(float bound_mm_s, Milling& milling) {
    DOUBLES_EQUAL(static_cast<double>(bound_mm_s), static_cast<double>(milling.doubt().bound_mm_s()), 1e-4);
}
void check_free(Milling& milling) {
    DOUBLES_EQUAL(0.0, static_cast<double>(milling.doubt().bound_mm_s()), 0.0);
}
/// A wall converges, until the feed dips.
void mill_into_dip(Milling& milling) {
    milling.widening = 1.4F;
    milling.mill(20);
    check_bound(7.0F, milling);
}
/// Of a cut that seems to widen, while the force along the feed doubles within a second.
bool asks_about_a_sudden_force(const Parameters& p) {
    Milling milling(p);
    milling.mill(40);
    milling.widening = 1.4F;
    milling.feed_N = 300.0F;
    milling.mill(60);
    return milling.dips() > 0;
}

}  // namespace

// clang-format off
TEST_GROUP(DriftDoubt) {
    Milling milling;
    void setup() override { milling.mill(40); }
};
// clang-format on

TEST(DriftDoubt, bounds_no_feed_of_a_cut_that_stays) {
    milling.mill(200);
    check_free(milling);
    DOUBLES_EQUAL(10.0, static_cast<double>(milling.lowest_mm_s()), 1e-6);
}

TEST(DriftDoubt, believes_a_wall_whose_forces_both_follow_a_dip_of_the_feed) {
    milling.widening = 1.4F;
    DOUBLES_EQUAL(2.0 / 1.4, static_cast<double>(milling.mill(100)), 1e-3);
    DOUBLES_EQUAL(7.0, static_cast<double>(milling.lowest_mm_s()), 1e-3);
    milling.mill(100);
    check_free(milling);
}

TEST(DriftDoubt, lets_the_force_of_no_wall_count_that_is_a_drift_of_an_axis) {
    milling.widening = 1.4F;
    milling.feed_N = 80.0F;
    milling.feed_drift_N = 70.0F;
    DOUBLES_EQUAL(2.0, static_cast<double>(milling.mill(100)), 1e-3);
}

TEST(DriftDoubt, asks_again_after_a_pause_and_no_more_once_the_forces_are_alike) {
    milling.widening = 1.4F;
    milling.feed_N = 80.0F;
    milling.feed_drift_N = 70.0F;
    milling.mill(60);
    check_free(milling);
    milling.feed_N = 150.0F;
    milling.feed_drift_N = 0.0F;
    DOUBLES_EQUAL(2.0 / 1.4, static_cast<double>(milling.mill(400)), 1e-3);
    LONGS_EQUAL(2, milling.dips());
}

TEST(DriftDoubt, asks_nothing_of_a_cut_that_a_map_knows_or_force_drops_show) {
    for (const DoubtStage& known : {DoubtStage{true, true, true, false}, DoubtStage{true, true, false, true}}) {
        Milling other;
        other.stage = known;
        other.mill(40);
        other.widening = 1.4F;
        other.mill(200);
        DOUBLES_EQUAL(10.0, static_cast<double>(other.lowest_mm_s()), 1e-6);
    }
}

TEST(DriftDoubt, asks_nothing_of_a_cut_that_ends) {
    milling.widening = 1.4F;
    milling.mill(20);
    CHECK_COMPARE(milling.doubt().bound_mm_s(), >, 0.0F);
    milling.stage.in_cut = false;
    milling.mill(1);
    check_free(milling);
}

TEST(DriftDoubt, sees_no_air_where_the_force_of_the_spindle_alone_has_gone) {
    milling.tangential_N = 0.0F;
    CHECK_TRUE(milling.may_still_cut());
    milling.feed_N = 60.0F;
    CHECK_FALSE(milling.may_still_cut());
    milling.feed_N = 150.0F;
    milling.doubt().clear();
    CHECK_FALSE(milling.may_still_cut());
}

TEST(DriftDoubt, holds_the_feed_after_a_jump_in_a_cut_in_doubt_until_a_dip_finds_the_forces_alike) {
    mill_into_doubt(milling);
    check_free(milling);
    jump(milling, 100);
    CHECK_COMPARE(milling.doubt().bound_mm_s(), >, 0.0F);
    milling.feed_drift_N = 0.0F;
    milling.mill(300);
    check_free(milling);
}

TEST(DriftDoubt, holds_it_no_lower_than_at_an_entry_and_not_once_air_has_found_the_currents_sound) {
    mill_into_doubt(milling);
    jump(milling, 1);
    CHECK_COMPARE(milling.doubt().bound_mm_s(), >=, 0.02F / tooth_period_s);
    milling.doubt().clear();
    check_free(milling);
}

TEST(DriftDoubt, asks_nothing_about_a_force_that_no_current_can_have_drifted_by) {
    CHECK_FALSE(asks_about_a_sudden_force(parameters()));
    for (const std::size_t k : {0U, 1U}) {
        Parameters p = parameters();
        p.machine.axes[k].K_x4_N_per_A = 1000.0F;
        CHECK_TRUE(asks_about_a_sudden_force(p));
    }
}

TEST(DriftDoubt, asks_about_any_force_where_the_rated_current_of_a_drive_is_not_stated) {
    Parameters without_spindle = parameters();
    without_spindle.machine.spindle_rated_current_A = 0.0F;
    CHECK_TRUE(asks_about_a_sudden_force(without_spindle));
    for (const std::size_t k : {0U, 1U}) {
        Parameters p = parameters();
        p.machine.axis_rated_current_A[k] = 0.0F;
        CHECK_TRUE(asks_about_a_sudden_force(p));
    }
}

TEST(DriftDoubt, believes_the_wall_while_it_asks) {
    mill_into_dip(milling);
    DOUBLES_EQUAL(2.0 / 1.4, static_cast<double>(milling.mill(1)), 1e-3);
    check_bound(7.0F, milling);
}

TEST(DriftDoubt, asks_at_once_about_the_next_wall_after_one_that_it_has_believed) {
    milling.widening = 1.4F;
    milling.mill(60);
    check_free(milling);
    milling.widening = 2.0F;
    milling.mill(60);
    LONGS_EQUAL(2, milling.dips());
}

TEST(DriftDoubt, asks_no_more_once_air_a_map_or_force_drops_have_answered) {
    mill_into_dip(milling);
    milling.doubt().clear();
    check_free(milling);
    for (const DoubtStage& known : {DoubtStage{true, true, true, false}, DoubtStage{true, true, false, true}}) {
        Milling other;
        other.mill(40);
        mill_into_dip(other);
        other.stage = known;
        other.mill(1);
        check_free(other);
    }
}

TEST(DriftDoubt, asks_no_more_about_a_cut_that_another_has_followed) {
    mill_into_dip(milling);
    milling.tangential_N = 450.0F;
    milling.feed_N = 225.0F;
    milling.mill(1);
    check_free(milling);
}

TEST(DriftDoubt, holds_the_feed_of_the_first_jump_or_that_of_an_entry_if_it_is_higher) {
    mill_into_doubt(milling);
    jump(milling, 1);
    check_bound(usual_feed_mm_s, milling);

    Parameters p = parameters();
    p.tool.control.entry_feed_per_tooth_mm = 0.15F;
    Milling of_fast_entry(p);
    of_fast_entry.mill(40);
    mill_into_doubt(of_fast_entry);
    jump(of_fast_entry, 1);
    check_bound(15.0F, of_fast_entry);
}

TEST(DriftDoubt, holds_it_no_lower_where_a_slower_cut_jumps_in_doubt_once_more) {
    mill_into_doubt(milling);
    jump(milling, 100);
    milling.widening = 2.0F;
    milling.deepening = 0.4F;
    milling.mill(40);
    milling.programmed_mm_s = 5.0F;
    milling.tangential_N = 700.0F;
    milling.feed_N = 400.0F;
    milling.mill(1);
    check_bound(usual_feed_mm_s, milling);
}

TEST(DriftDoubt, holds_no_feed_where_the_time_of_a_tooth_is_not_known) {
    mill_into_doubt(milling);
    milling.period_s = 0.0F;
    jump(milling, 1);
    check_free(milling);
}
