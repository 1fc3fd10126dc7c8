// SPDX-License-Identifier: Apache-2.0
#include "estimation/signal/tooth_repetition.hpp"

#include <CppUTest/TestHarness.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>

using millforce::estimation::ToothRepetition;

namespace {

constexpr int teeth = 4;
constexpr float tooth_sd_A = 0.05F;                         // of a tooth's mean
constexpr float noise_A2 = 2.0F * tooth_sd_A * tooth_sd_A;  // of a difference

/// Teeth in a row, each compared with itself a revolution before. The tool runs out: no tooth is like the next one.
class Spindle {
  public:
    explicit Spindle(unsigned seed = 1, float sd_A = 0.0F) : engine_(seed), sd_A_(sd_A) { turn(0.0F, nullptr); }

    /// A revolution, in which each tooth takes `growth_A` more than the one before it.
    void turn(float growth_A, ToothRepetition<float>* repetition) {
        for (std::size_t k = 0; k < teeth; ++k) {
            load_A_ += growth_A;
            const float tooth_A = load_A_ + run_out_A[k] + noise_A();
            if (repetition != nullptr) {
                repetition->follow(tooth_A, last_A_[k]);
            }
            last_A_[k] = tooth_A;
        }
    }
    void load(float more_A) { load_A_ += more_A; }

  private:
    static constexpr std::array<float, teeth> run_out_A{0.0F, 0.8F, -0.5F, 0.3F};

    /// A sum of twelve even numbers: the same on every machine, and near enough to a normal distribution.
    float noise_A() {
        float sum = -6.0F;
        for (int k = 0; k < 12; ++k) {
            sum += static_cast<float>(engine_() >> 8U) / 16777216.0F;
        }
        return sd_A_ * sum;
    }

    std::mt19937 engine_;
    float sd_A_;
    float load_A_ = 5.0F;
    std::array<float, teeth> last_A_{};
};

ToothRepetition<float> started_with(float noise, float least_change_A) {
    ToothRepetition<float> repetition(teeth);
    repetition.set_scale(noise, least_change_A);
    repetition.start();
    return repetition;
}

ToothRepetition<float> started() {
    return started_with(noise_A2, 0.0F);
}

}  // namespace

TEST_GROUP(ToothRepetition){};

TEST(ToothRepetition, a_tool_that_runs_out_repeats_itself) {
    Spindle spindle;
    auto repetition = started();
    for (int k = 0; k < 100; ++k) {
        spindle.turn(0.0F, &repetition);
    }
    CHECK_FALSE(repetition.has_changed());
}

TEST(ToothRepetition, a_jump_shows_in_the_first_tooth) {
    for (const float jump_A : {0.22F, -0.22F}) {  // 3.1 deviations
        auto repetition = started();
        repetition.follow(5.0F + jump_A, 5.0F);
        CHECK(repetition.has_changed());
    }
    auto repetition = started();
    repetition.follow(5.2F, 5.0F);  // 2.8
    CHECK_FALSE(repetition.has_changed());
}

TEST(ToothRepetition, a_jump_is_remembered_though_the_teeth_behind_it_repeat_themselves) {
    Spindle spindle;
    auto repetition = started();
    spindle.load(0.5F);
    spindle.turn(0.0F, &repetition);
    spindle.turn(0.0F, &repetition);
    CHECK(repetition.has_changed());
    repetition.start();
    spindle.turn(0.0F, &repetition);
    CHECK_FALSE(repetition.has_changed());
}

TEST(ToothRepetition, a_change_that_creeps_shows_in_the_sum_before_it_could_in_a_tooth) {
    constexpr float growth_A = 0.02F;  // in a revolution 0.08 A, a little over one deviation
    Spindle spindle;
    auto repetition = started();
    int revolutions = 0;
    while (!repetition.has_changed() && revolutions < 100) {
        spindle.turn(growth_A, &repetition);
        ++revolutions;
    }
    // By then a revolution's mean has grown by no more than three of its own deviations.
    CHECK(revolutions <= 2);
    CHECK(teeth * growth_A * static_cast<float>(revolutions) < 3.0F * std::sqrt(noise_A2));
}

TEST(ToothRepetition, the_sum_is_that_of_the_revolutions_means_however_long_it_gets) {
    Spindle spindle;
    auto repetition = started();
    for (int k = 0; k < 50; ++k) {  // to and fro by two deviations of a mean, and never beyond
        spindle.turn(k % 2 == 0 ? 0.01F : -0.01F, &repetition);
    }
    CHECK_FALSE(repetition.has_changed());
}

TEST(ToothRepetition, noise_alone_is_a_change_in_less_than_one_tooth_of_a_hundred) {
    Spindle spindle(7, tooth_sd_A);
    int changes = 0;
    constexpr int revolutions = 20'000;
    auto repetition = started();
    for (int k = 0; k < revolutions; ++k) {
        spindle.turn(0.0F, &repetition);
        if (repetition.has_changed()) {
            ++changes;
            repetition.start();
        }
    }
    CHECK(changes > 0);
    CHECK(changes < revolutions * teeth / 100);
}

TEST(ToothRepetition, below_the_least_change_there_is_none_however_fine_the_current) {
    auto repetition = started_with(1e-6F, 0.1F);
    for (int k = 0; k < 3 * teeth; ++k) {
        repetition.follow(k < teeth ? 5.09F : 5.0F, 5.0F);
    }
    CHECK_FALSE(repetition.has_changed());
    repetition.follow(5.11F, 5.0F);
    CHECK(repetition.has_changed());
}

TEST(ToothRepetition, what_creeps_by_more_than_the_least_change_is_one) {
    auto repetition = started_with(1e-6F, 0.1F);
    for (int k = 0; k < 6; ++k) {  // each by 0.06 A
        repetition.follow(5.06F, 5.0F);
        CHECK_FALSE(repetition.has_changed());
    }
    repetition.follow(5.06F, 5.0F);  // the mean of a revolution by 0.105 A
    CHECK(repetition.has_changed());
}

TEST(ToothRepetition, knows_nothing_before_the_start_nor_without_a_tooth_to_compare_with_nor_of_what_is_no_number) {
    CHECK(ToothRepetition<float>(teeth).has_changed());
    auto lost = started();
    lost.lose();
    CHECK(lost.has_changed());
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        auto repetition = started();
        repetition.follow(bad, 5.0F);
        CHECK(repetition.has_changed());
    }
    auto noisy = started_with(std::numeric_limits<float>::quiet_NaN(), 0.0F);
    noisy.follow(5.1F, 5.0F);
    CHECK(noisy.has_changed());
}
