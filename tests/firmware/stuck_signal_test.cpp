// SPDX-License-Identifier: Apache-2.0
#include "firmware/stuck_signal.hpp"

#include <cmath>
#include <random>

#include <CppUTest/TestHarness.h>

using millforce::firmware::StuckSignal;

namespace {

/// Noise about 10 with a resolution of 0.01.
class NoisySignal {
  public:
    explicit NoisySignal(float sd) : noise_(10.0F, sd) {}
    float next() { return 0.01F * std::round(noise_(random_) * 100.0F); }

  private:
    std::mt19937 random_{1};
    std::normal_distribution<float> noise_;
};

/// How many equal values it takes from now on; 10 000: never.
int values_until_stuck(StuckSignal& signal, float value, void (StuckSignal::*see)(float) = &StuckSignal::add) {
    int count = 0;
    while (!signal.is_stuck() && count < 10'000) {
        (signal.*see)(value);
        ++count;
    }
    return count;
}

}  // namespace

TEST_GROUP(StuckSignal){};

TEST(StuckSignal, notices_a_noisy_signal_that_freezes_within_some_thirty_samples) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 100'000; ++k) {
        signal.add(noisy.next());
        CHECK_FALSE(signal.is_stuck());
    }
    const int count = values_until_stuck(signal, noisy.next());
    CHECK(count > 30 && count < 40);
}

TEST(StuckSignal, is_judged_by_what_it_learnt_before_where_it_only_watches) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 1000; ++k) {
        signal.add(noisy.next());
    }
    signal.pause();
    const int count = values_until_stuck(signal, noisy.next(), &StuckSignal::watch);
    CHECK(count > 30 && count < 40);
}

TEST(StuckSignal, learns_nothing_where_it_only_watches) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 1000; ++k) {
        signal.watch(noisy.next());
    }
    CHECK_FALSE(signal.has_learnt());
}

TEST(StuckSignal, lets_a_slow_source_repeat_itself_and_still_notices_that_it_hangs) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    float value = 0.0F;
    for (int k = 0; k < 100'000; ++k) {
        value = k % 20 == 0 ? noisy.next() : value;  // a field bus of 50 Hz, sampled at 1 kHz
        signal.add(value);
        CHECK_FALSE(signal.is_stuck());
    }
    const int count = values_until_stuck(signal, value);
    CHECK(count > 8 * 20 && count < 8 * 64);
}

TEST(StuckSignal, does_not_judge_a_signal_whose_noise_is_below_its_resolution) {
    StuckSignal signal;
    NoisySignal noisy(0.003F);  // dithers between two values
    for (int k = 0; k < 100'000; ++k) {
        signal.add(noisy.next());
    }
    LONGS_EQUAL(10'000, values_until_stuck(signal, 10.0F));
}

TEST(StuckSignal, does_not_judge_before_it_knows_the_signal) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 100; ++k) {
        signal.add(noisy.next());
    }
    LONGS_EQUAL(10'000, values_until_stuck(signal, 10.0F));
}

TEST(StuckSignal, notices_a_converter_at_its_end) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    const auto load = [&](int k, float rise) {
        return noisy.next() + rise + std::sin(0.05F * static_cast<float>(k));  // ripple of the teeth
    };
    for (int k = 0; k < 10'000; ++k) {
        signal.add(std::fmin(load(k, 0.0F), 12.0F));
        CHECK_FALSE(signal.is_stuck());
    }
    bool was_stuck = false;
    for (int k = 0; k < 200; ++k) {
        signal.add(std::fmin(load(k, 2.0F), 12.0F));
        was_stuck = was_stuck || signal.is_stuck();
    }
    CHECK(was_stuck);
}

TEST(StuckSignal, begins_anew_after_a_pause) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 1000; ++k) {
        signal.add(noisy.next());
    }
    values_until_stuck(signal, 10.0F);
    signal.pause();
    CHECK_FALSE(signal.is_stuck());
}

TEST(StuckSignal, takes_as_many_values_after_a_pause_as_before_though_the_first_is_the_last_again) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 1000; ++k) {
        signal.add(noisy.next());
    }
    signal.add(10.0F);
    signal.pause();
    LONGS_EQUAL(1 + 32, values_until_stuck(signal, 10.0F));
}

TEST(StuckSignal, learns_nothing_across_a_pause) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 1000; ++k) {
        signal.pause();
        signal.add(noisy.next());
    }
    CHECK_FALSE(signal.has_learnt());
}

TEST(StuckSignal, learns_nothing_from_values_that_no_current_has) {
    StuckSignal signal;
    for (int k = 0; k < 1000; ++k) {
        signal.add(1.1e5F + static_cast<float>(k * k % 97));
    }
    CHECK_FALSE(signal.has_learnt());
}

TEST(StuckSignal, judges_by_the_longest_run_and_not_by_the_last) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    float value = 0.0F;
    for (int k = 0; k < 4000; ++k) {
        value = k > 2000 || k % 20 == 0 ? noisy.next() : value;
        signal.add(value);
    }
    CHECK(values_until_stuck(signal, value) > 8 * 19);
}

TEST(StuckSignal, knows_noise_by_one_step_that_is_larger_than_all_others_whenever_it_comes) {
    for (const int large : {1, 128, 256}) {
        StuckSignal signal;
        float value = 0.0F;
        signal.add(value);
        for (int step = 1; step <= 256; ++step) {
            value += step == large ? 5.0F : 1.0F;
            signal.add(value);
        }
        CHECK(signal.has_learnt());
        LONGS_EQUAL(32, values_until_stuck(signal, value));
    }
}

TEST(StuckSignal, stays_stuck_however_long_it_lasts) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 1000; ++k) {
        signal.add(noisy.next());
    }
    values_until_stuck(signal, 10.0F);
    for (int k = 0; k < 70'000; ++k) {
        signal.add(10.0F);
        CHECK(signal.is_stuck());
    }
}

TEST(StuckSignal, begins_anew_where_the_signal_had_no_reason_to_vary) {
    StuckSignal signal;
    NoisySignal noisy(0.1F);
    for (int k = 0; k < 1000; ++k) {
        signal.follow(noisy.next(), true);
    }
    for (int k = 0; k < 60; ++k) {
        signal.follow(10.0F, k != 30);
        CHECK_FALSE(signal.is_stuck());
    }
}
