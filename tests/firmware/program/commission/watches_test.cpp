// SPDX-License-Identifier: Apache-2.0
#include "commission/air_watch.hpp"
#include "commission/cut_watch.hpp"
#include "commission/idle_watch.hpp"
#include "temporary_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

using namespace millforce;
using namespace millforce::host;
using namespace millforce::test;

namespace {

constexpr std::uint32_t counts = 8192;

/// A spindle and an axis that do what the test says, sampled at 1 kHz with 0.1 A of noise.
class MadeMachine {
  public:
    explicit MadeMachine(StepWatch& watch) : watch_(watch) {}

    double rpm = 3000.0;
    double spindle_A = 1.0;
    double x_mm_s = 0.0;
    double x_A = 0.0;
    double y_mm_s = 0.0;

    void run(double duration_s) {
        for (int k = 0; k < static_cast<int>(std::lround(duration_s * 1000.0)); ++k) {
            time_s_ += 0.001;
            angle_ += rpm / 60.0 * 0.001;
            TimedSample timed;
            timed.time_s = time_s_;
            timed.sample.spindle_count = static_cast<std::uint32_t>(static_cast<std::int64_t>(angle_ * counts));
            timed.sample.spindle_current_A = static_cast<float>(spindle_A + noise_(random_));
            timed.sample.axis_current_A = {static_cast<float>(x_A + noise_(random_)), 0.0F, 0.0F};
            timed.sample.axis_velocity_mm_s = {static_cast<float>(x_mm_s), static_cast<float>(y_mm_s), 0.0F};
            timed.sample.present = hal::all_present;
            watch_.add(timed);
        }
    }
    /// Friction of 1.5 A + 0.02 A·s/mm, and 0.1 A of weight.
    void travel(double mm_s, double duration_s) {
        x_mm_s = mm_s;
        x_A = mm_s == 0.0 ? 0.1 : std::copysign(1.5, mm_s) + 0.02 * mm_s + 0.1;
        run(duration_s);
    }

  private:
    StepWatch& watch_;
    double time_s_ = 0.0;
    double angle_ = 0.0;
    std::mt19937 random_{7};
    std::normal_distribution<double> noise_{0.0, 0.1};
};

std::string all_news(StepWatch& watch) {
    std::string text;
    for (const std::string& line : watch.take_news()) {
        text += line + "\n";
    }
    return text;
}

/// Two passes along x at 1200 and 600 mm/min.
CutWatchSettings two_passes() {
    CutWatchSettings settings;
    settings.counts_per_rev = counts;
    settings.passes = {{1200.0, 10.0, 1.0}, {600.0, 10.0, 1.0}};
    settings.tool_diameter_mm = 8.0;
    settings.flutes = 4;
    settings.travel_per_motor_turn_mm = 10.0;
    settings.smallest_rise_A = 0.5;
    return settings;
}

/// 30 mm of air, then 30 mm of cut that takes `rise_A` more.
void pass(MadeMachine& machine, double mm_s, double rise_A) {
    machine.travel(mm_s, 30.0 / mm_s);
    machine.spindle_A += rise_A;
    machine.travel(mm_s, 30.0 / mm_s);
    machine.spindle_A -= rise_A;
    machine.travel(0.0, 0.3);
}

}  // namespace

TEST_GROUP(IdleWatch) {
    IdleWatch watch{counts, 3, 2.0};
    MadeMachine machine{watch};

    void idle(double rpm, double duration_s) {
        machine.rpm = rpm;
        machine.spindle_A = 0.8 + 0.002 * rpm * std::numbers::pi / 30.0;
        machine.run(duration_s);
    }
};

TEST(IdleWatch, fits_the_idle_current_over_the_speed_within_its_standard_error) {
    for (const double rpm : {1000.0, 2000.0, 4000.0}) {
        CHECK_FALSE(watch.is_enough());
        idle(rpm, 3.0);
    }
    CHECK(watch.is_enough());
    STRCMP_EQUAL("", watch.lacks().c_str());
    const IdleFit fit = watch.fit().value();
    DOUBLES_EQUAL(0.8, fit.offset_A, 4.0 * fit.offset_se + 1e-3);
    DOUBLES_EQUAL(0.002, fit.slope_A_s, 4.0 * fit.slope_se + 1e-6);
    CHECK(fit.offset_se < 0.02);
    DOUBLES_EQUAL(0.1, fit.noise_A, 0.005);
    CHECK(contains(all_news(watch), "fit of 3 speeds"));
}

TEST(IdleWatch, does_not_count_a_speed_that_was_short_that_came_before_or_while_an_axis_moved) {
    idle(1000.0, 3.0);
    idle(2000.0, 1.5);
    idle(1010.0, 3.0);
    machine.x_mm_s = 10.0;
    idle(4000.0, 3.0);
    UNSIGNED_LONGS_EQUAL(1, watch.plateaus().size());
    STRCMP_EQUAL("2 of 3 speeds, each for 2 s with the axes at rest", watch.lacks().c_str());
}

TEST_GROUP(AirWatch) {
    AirWatch watch{{0}, {0.6, 1.2, 2.4, 3.0}};
    MadeMachine machine{watch};
};

TEST(AirWatch, names_the_feeds_that_are_missing_and_shows_the_fit_as_it_forms) {
    for (const double mm_s : {10.0, 20.0, 40.0, 50.0}) {
        machine.travel(mm_s, 1.0);
        machine.travel(0.0, 0.2);
    }
    CHECK_FALSE(watch.is_enough());
    STRCMP_EQUAL("x: -600 -1200 -2400 -3000 mm/min", watch.lacks().c_str());
    for (const double mm_s : {-10.0, -20.0, -40.0, -50.0}) {
        machine.travel(mm_s, 1.0);
        machine.travel(0.0, 0.2);
    }
    CHECK(watch.is_enough());
    UNSIGNED_LONGS_EQUAL(8, watch.found(0).size());
    DOUBLES_EQUAL(0.1, watch.current_noise_A(0).value(), 0.005);
    const std::string news = all_news(watch);
    CHECK(contains(news, "x +600 mm/min: "));
    CHECK(contains(news, "friction so far: K_x3 1.5"));
}

TEST(AirWatch, says_at_what_feed_the_axis_moved_where_a_unit_is_wrong) {
    machine.travel(1.0, 3.0);  // a tenth of what the program says
    machine.travel(0.0, 0.2);
    CHECK(contains(watch.lacks(), "(it moved at +60)"));
}

TEST_GROUP(CutWatch) {
    CutWatch watch{two_passes()};
    MadeMachine machine{watch};
};

TEST(CutWatch, finds_air_and_cut_of_each_pass_in_whole_turns_of_the_screw) {
    machine.travel(0.0, 1.0);
    pass(machine, 20.0, 1.0);
    machine.travel(-100.0, 0.6);  // back, at a feed that no pass has
    pass(machine, 10.0, 0.6);
    CHECK(watch.is_enough());
    UNSIGNED_LONGS_EQUAL(4, watch.stretches().size());
    const FoundStretch& air = watch.stretches()[0];
    const FoundStretch& cut = watch.stretches()[1];
    DOUBLES_EQUAL(0.0, air.axial_depth_mm, 0.0);
    DOUBLES_EQUAL(10.0, cut.axial_depth_mm, 0.0);
    for (const FoundStretch& stretch : watch.stretches()) {
        const double mm_s = &stretch < &watch.stretches()[2] ? 20.0 : 10.0;
        const double turns = (stretch.end_s - stretch.start_s) * mm_s / 10.0;
        DOUBLES_EQUAL(std::round(turns), turns, 1e-9);
        CHECK(turns >= 0.5);
    }
    CHECK(air.start_s > 1.0 && air.end_s < 2.5);
    CHECK(cut.start_s > 2.5 && cut.end_s < 4.0);
}

TEST(CutWatch, waits_for_the_pass_that_comes_next_and_leaves_other_moves_out) {
    machine.travel(0.0, 1.0);
    pass(machine, 10.0, 1.0);  // the second pass first
    machine.y_mm_s = 5.0;
    pass(machine, 20.0, 1.0);  // two axes
    machine.y_mm_s = 0.0;
    pass(machine, 20.0, 0.05);  // no cut
    UNSIGNED_LONGS_EQUAL(0, watch.stretches().size());
    STRCMP_EQUAL("2 of 2 cuts, next 1200 mm/min, 10 mm deep, 1 mm wide, after air at the same feed",
                 watch.lacks().c_str());
    pass(machine, 20.0, 1.0);
    UNSIGNED_LONGS_EQUAL(2, watch.stretches().size());
    CHECK_FALSE(watch.is_enough());
}

TEST(CutWatch, an_idle_current_that_drifts_is_no_cut) {
    machine.travel(0.0, 1.0);
    for (int k = 0; k < 10; ++k) {
        machine.spindle_A -= 0.08;  // more than a cut in all
        pass(machine, k == 9 ? 20.0 : 15.0, k == 9 ? 1.0 : 0.0);
    }
    UNSIGNED_LONGS_EQUAL(2, watch.stretches().size());
}
