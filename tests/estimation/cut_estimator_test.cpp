// SPDX-License-Identifier: Apache-2.0
#include "estimation/cut_estimator.hpp"

#include "estimation/four_flutes.hpp"
#include "estimation/laws.hpp"
#include "estimation/number/fixed_point.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <array>
#include <bit>
#include <climits>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

using namespace millforce::estimation;

namespace {

/// Down milling along +x at 1 kHz with 4 teeth, a tooth's ripple on the load, and each revolution wider than the last.
class Cut {
  public:
    explicit Cut(double revs_per_s) : revs_per_s_(revs_per_s) {}

    template <typename Scalar>
    bool add_next(CutEstimator<Scalar>& estimator) {
        const double rev = revs_per_s_ * 1e-3 * ++index_;
        const double load = 1.0 + 0.3 * std::sin(2.0 * std::numbers::pi * 4.0 * rev);
        DriveSignals<Scalar> signals;
        signals.values[0] = Scalar(static_cast<float>(10.0 * load));
        signals.values[1] = Scalar(static_cast<float>(-(2.0 - 1e-3 * index_) * load));
        signals.values[DriveSignals<Scalar>::first_velocity] = Scalar(20);
        signals.present = 0xFU;
        const Scalar before_s = estimator.since_period_s();
        estimator.add(literal<Scalar>(1e-3L), static_cast<std::uint32_t>(rev * 65536.0), 0, 0, signals);
        return estimator.since_period_s() < before_s;
    }

  private:
    double revs_per_s_;
    int index_ = 0;
};

template <typename Scalar>
CutEstimator<Scalar> fresh_estimator(CutSide side = CutSide::down, float runout_mm = 0.0F) {
    CutEstimatorSettings<Scalar> settings = millforce::tests::estimator_of_four_flutes<Scalar>();
    settings.side = side;
    settings.runout_mm = Scalar(runout_mm);
    settings.encoder_counts_per_rev = 65536;
    SpindleDriveParameters<Scalar> spindle;
    spindle.K_t1_Nm_per_A = literal<Scalar>(0.13L);
    std::array<FeedDriveParameters<Scalar>, 3> axes{};
    for (auto& axis : axes) {
        axis.K_x4_N_per_A = Scalar(100);
        axis.friction_relative_sd = literal<Scalar>(0.01L);
    }
    return CutEstimator<Scalar>(settings, spindle, axes, millforce::tests::carbide_in_SM45C<Scalar>());
}

std::uint64_t bits_of(float value) {
    return std::bit_cast<std::uint32_t>(value);
}
std::uint64_t bits_of(Fixed value) {
    return static_cast<std::uint64_t>(value.raw());
}

template <typename Scalar>
std::vector<std::uint64_t> bits_of(const CutEstimate<Scalar>& e) {
    std::vector<std::uint64_t> bits{static_cast<std::uint64_t>(e.tooth_periods)};
    for (const Scalar value :
         {e.tangential_N.value, e.tangential_N.variance, e.tooth_tangential_N.value, e.feed_N.value,
          e.engagement.radial_immersion, e.engagement.radial_immersion_sd, e.engagement.axial_depth_mm,
          e.engagement.axial_depth_sd_mm, e.engagement.misfit, e.tooth_force_N.value, e.tooth_force_N.variance,
          e.section_mm2, e.surge.ratio, e.turn.ratio, e.cutting_share}) {
        bits.push_back(bits_of(value));
    }
    return bits;
}

constexpr int unlimited = INT_MAX;
constexpr int samples = 600;

/// The bits of all estimates where each is completed before the next sample.
template <typename Scalar>
std::vector<std::vector<std::uint64_t>> estimates_at_once(CutSide side, int steps_per_slice) {
    CutEstimator<Scalar> estimator = fresh_estimator<Scalar>(side);
    Cut cut(66.7);
    std::vector<std::vector<std::uint64_t>> estimates;
    for (int k = 0; k < samples; ++k) {
        cut.add_next(estimator);
        while (estimator.work_due()) {
            if (estimator.work(steps_per_slice)) {
                estimates.push_back(bits_of(estimator.estimate()));
            }
        }
    }
    CHECK(estimator.estimate().engagement.immersion_valid);
    return estimates;
}

/// The estimates where one slice of the work is done between two samples.
template <typename Scalar>
std::vector<std::vector<std::uint64_t>> estimates_between_samples(double revs_per_s, int steps_per_slice) {
    CutEstimator<Scalar> estimator = fresh_estimator<Scalar>();
    Cut cut(revs_per_s);
    std::vector<std::vector<std::uint64_t>> estimates;
    for (int k = 0; k < samples; ++k) {
        cut.add_next(estimator);
        if (estimator.work(steps_per_slice)) {
            estimates.push_back(bits_of(estimator.estimate()));
        }
    }
    CHECK(estimator.estimate().engagement.immersion_valid);
    return estimates;
}

template <typename Scalar>
void check_slices() {
    for (const CutSide side : {CutSide::down, CutSide::unknown}) {
        const auto expected = estimates_at_once<Scalar>(side, unlimited);
        CHECK(expected.size() > 100);
        for (const int steps : {1, 3, 17}) {
            CHECK(estimates_at_once<Scalar>(side, steps) == expected);
        }
    }
}

/// Estimates of a cut whose four teeth carry unequally, 0.6 to 1.4 of their mean, and of which each tooth carries
/// `step` times as much from the eleventh revolution on, at a feed that is `feed_step` times as high; by a tool whose
/// file states a runout.
std::vector<CutEstimate<float>> cut_by_unequal_teeth(double step, float runout_mm, double feed_step = 1.0) {
    constexpr double revs_per_s = 20.0;
    constexpr int samples_per_rev = 50;
    constexpr std::array<double, 4> share{1.4, 1.1, 0.6, 0.9};
    CutEstimator<float> estimator = fresh_estimator<float>(CutSide::down, runout_mm);
    std::vector<CutEstimate<float>> estimates;
    for (int k = 1; k <= 12 * samples_per_rev; ++k) {
        const double rev = revs_per_s * 1e-3 * k;
        const auto tooth = static_cast<std::size_t>((k - 1) * 4 / samples_per_rev) % share.size();
        DriveSignals<float> signals;
        const bool is_after = k > 10 * samples_per_rev;
        signals.values[0] = static_cast<float>(10.0 * share[tooth] * (is_after ? step : 1.0));
        signals.values[DriveSignals<float>::first_velocity] = static_cast<float>(is_after ? 5.0 * feed_step : 5.0);
        signals.present = 0xFU;
        estimator.add(1e-3F, static_cast<std::uint32_t>(rev * 65536.0), 0, 0, signals);
        while (estimator.work_due()) {
            if (estimator.work()) {
                estimates.push_back(estimator.estimate());
            }
        }
    }
    return estimates;
}

constexpr float much_runout_mm = 0.1F;

}  // namespace

TEST_GROUP(CutEstimator){};

TEST(CutEstimator, takes_teeth_that_carry_unequally_for_no_growth) {
    int estimates = 0;
    for (const CutEstimate<float>& e : cut_by_unequal_teeth(1.0, much_runout_mm)) {
        DOUBLES_EQUAL(e.tangential_N.valid ? 260.0 : 0.0, e.newest_tangential_N, 1.0);
        DOUBLES_EQUAL(0.0, e.tangential_growth_N_per_s, 1e-3);
        estimates += e.tangential_N.valid ? 1 : 0;
    }
    CHECK(estimates > 40);
}

TEST(CutEstimator, takes_what_the_known_runout_does_not_explain_for_a_larger_force) {
    float highest_N = 0.0F;
    for (const CutEstimate<float>& e : cut_by_unequal_teeth(1.0, 0.0F)) {
        highest_N = std::max(highest_N, e.newest_tangential_N);
        DOUBLES_EQUAL(0.0, e.tangential_growth_N_per_s, 1e-3);
    }
    DOUBLES_EQUAL(1.4 * 260.0, highest_N, 3.0);
}

/// 130 N more, a revolution lasts 50 ms.
TEST(CutEstimator, sees_a_step_as_growth_with_each_tooth_of_its_revolution_and_no_longer) {
    int growing = 0;
    for (const CutEstimate<float>& e : cut_by_unequal_teeth(1.5, much_runout_mm)) {
        const bool is_growing = e.tangential_growth_N_per_s > 1000.0F;
        growing += is_growing ? 1 : 0;
        CHECK(!is_growing || e.newest_tangential_N > 350.0F);
    }
    LONGS_EQUAL(4, growing);
}

TEST(CutEstimator, takes_what_a_higher_feed_adds_to_the_force_for_no_growth) {
    const auto growth_N_per_s = [](double step, double feed_step) {
        float sum = 0.0F;
        for (const CutEstimate<float>& e : cut_by_unequal_teeth(step, much_runout_mm, feed_step)) {
            sum += e.tangential_growth_N_per_s;
        }
        return static_cast<double>(sum);
    };
    constexpr double feed_step = 1.2;
    constexpr double its_force = 1.1;  // no force grows faster than the feed, edge forces do not grow at all
    DOUBLES_EQUAL(0.0, growth_N_per_s(its_force, feed_step), 1e-3);
    CHECK_COMPARE(growth_N_per_s(its_force, 1.0), >, 1000.0);
    CHECK_COMPARE(growth_N_per_s(1.5, feed_step), >, 0.5 * growth_N_per_s(1.5, 1.0));
    DOUBLES_EQUAL(growth_N_per_s(1.5, 1.0), growth_N_per_s(1.5, 0.8), 0.1 * growth_N_per_s(1.5, 1.0));
}

TEST(CutEstimator, gives_the_same_bits_whatever_the_size_of_a_slice_in_float) {
    check_slices<float>();
}

TEST(CutEstimator, gives_the_same_bits_whatever_the_size_of_a_slice_in_fixed_point) {
    check_slices<Fixed>();
}

TEST(CutEstimator, gives_the_same_bits_where_samples_come_between_the_slices) {
    constexpr double slow_rev_s = 7.0;  // a tooth in 35 samples
    const auto expected = estimates_between_samples<float>(slow_rev_s, unlimited);
    CHECK(expected.size() > 10);
    for (const int steps : {2, 5}) {
        CHECK(estimates_between_samples<float>(slow_rev_s, steps) == expected);
    }
}

TEST(CutEstimator, merges_the_tooth_periods_that_end_while_an_estimate_is_in_work) {
    CutEstimator<float> estimator = fresh_estimator<float>();
    Cut cut(66.7);  // a tooth in 3.75 samples, an estimate in 8
    int ended = 0;
    int estimated = 0;
    int estimates = 0;
    for (int k = 0; k < samples; ++k) {
        ended += cut.add_next(estimator) ? 1 : 0;
        if (estimator.work(5)) {
            estimated += estimator.estimate().tooth_periods;
            ++estimates;
        }
    }
    CHECK(estimates > 50 && estimates < ended * 2 / 3);
    CHECK(ended - estimated >= 0 && ended - estimated <= 6);  // the newest ones are not yet complete
}

TEST(CutEstimator, does_nothing_until_a_tooth_period_has_ended) {
    CutEstimator<float> estimator = fresh_estimator<float>();
    Cut cut(66.7);
    int idle = 0;
    for (int k = 0; k < 50; ++k) {
        const bool has_ended = cut.add_next(estimator);
        CHECK(estimator.work_due() == has_ended);
        idle += estimator.work_due() ? 0 : 1;
        while (estimator.work_due()) {
            estimator.work();
        }
    }
    CHECK(idle > 30);
    CHECK_FALSE(estimator.work());
}

TEST(CutEstimator, forgets_the_estimate_in_work_when_it_restarts) {
    CutEstimator<float> estimator = fresh_estimator<float>();
    Cut cut(66.7);
    for (int k = 0; k < samples || !estimator.work_due(); ++k) {
        while (estimator.work_due()) {
            estimator.work();
        }
        cut.add_next(estimator);
    }
    estimator.work();
    estimator.restart();
    CHECK_FALSE(estimator.work_due());
    CHECK_FALSE(estimator.estimate().tangential_N.valid);
    CHECK_FALSE(estimator.spindle_turns());
}
