// SPDX-License-Identifier: Apache-2.0
#include "cia402/sync_clock.hpp"

#include <CppUTest/TestHarness.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace millforce;
using namespace millforce::cia402;

namespace {

constexpr std::uint64_t start_us = 1'700'000'000'000'000;
constexpr double counts_per_us = 0.0819;  // 4096 per revolution at 1200 rpm

/// Errors of the latch times against the truth, once the clock has had a second to learn.
struct Errors {
    double mean_us = 0.0;
    double rms_us = 0.0;
    bool increases = true;
};

struct Lateness {
    double sync_us = 0.0;  ///< the drives latch with it
    double stamp_us = 0.0;
};

double steadily(double time_us) {
    return time_us;
}

/// Every half second the spindle loses 5 % of its speed within 10 ms, and regains it within 100 ms.
double under_shocks(double time_us) {
    const double whole = std::floor(time_us / 500'000.0);
    const double since_us = time_us - whole * 500'000.0;
    const double falling_us = std::min(since_us, 10'000.0);
    const double rising_us = std::clamp(since_us - 10'000.0, 0.0, 100'000.0);
    const double lost_us = 0.05 * (falling_us * falling_us / 20'000.0 + rising_us - rising_us * rising_us / 200'000.0);
    return time_us - lost_us - whole * 0.05 * 55'000.0;
}

std::uint64_t stamped(double time_us) {
    return start_us + static_cast<std::uint64_t>(std::llround(time_us));
}

template <typename LatenessOf>
Errors errors(double period_us, LatenessOf late, double (*turned_us)(double) = steadily) {
    constexpr int periods = 6000;
    SyncClock clock(1000);
    Errors errors;
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    std::uint64_t before_us = 0;
    for (int k = 0; k < periods; ++k) {
        const Lateness lateness = late(k);
        const double latched_us = k * period_us + lateness.sync_us;
        clock.on_sync(stamped(latched_us + lateness.stamp_us));
        clock.on_count(static_cast<std::uint32_t>(std::llround(turned_us(latched_us) * counts_per_us)));
        const std::uint64_t got_us = clock.latched_us();
        errors.increases = errors.increases && got_us > before_us;
        before_us = got_us;
        if (k >= 1000) {
            const double off = static_cast<double>(got_us - start_us) - latched_us;
            sum += off;
            squares += off * off;
            ++count;
        }
    }
    errors.mean_us = sum / count;
    errors.rms_us = std::sqrt(squares / count - errors.mean_us * errors.mean_us);
    return errors;
}

constexpr double uniform_to_60_rms_us = 17.3;

}  // namespace

TEST_GROUP(SyncClock) {
    std::mt19937 random{7};
    SyncClock clock{1000};
    double up_to(double largest) {
        return std::uniform_real_distribution<double>(0.0, largest)(random);
    }
};

TEST(SyncClock, stamps_on_time_are_taken_as_they_are) {
    const Errors got = errors(1000.0, [](int) { return Lateness{}; });
    DOUBLES_EQUAL(0.0, got.rms_us, 1e-3);
    DOUBLES_EQUAL(0.0, got.mean_us, 1e-3);
}

TEST(SyncClock, what_only_stamps_are_late_by_is_smoothed) {
    const Errors rare = errors(1000.0, [](int k) { return Lateness{0.0, k % 50 == 0 ? 20.0 : 0.0}; });
    CHECK(rare.rms_us < 1.0);
    const Errors always = errors(1000.0, [this](int) { return Lateness{0.0, up_to(60.0)}; });
    CHECK(always.rms_us < uniform_to_60_rms_us / 5.0);
    CHECK(always.increases);
}

TEST(SyncClock, what_the_drives_latch_late_with_is_believed) {
    const Errors rare = errors(1000.0, [](int k) { return Lateness{k % 50 == 0 ? 20.0 : 0.0, 0.0}; });
    CHECK(rare.rms_us < 1.0);
    const Errors always = errors(1000.0, [this](int) { return Lateness{up_to(60.0), 0.0}; });
    CHECK(always.rms_us < 2.0);
}

TEST(SyncClock, a_producer_that_wanders_is_believed_at_any_pace) {
    for (const int periods : {3, 8, 20, 60, 200, 1000}) {
        const auto wander = [periods](int k) { return Lateness{60.0 * std::sin(6.2832 * k / periods), 0.0}; };
        CHECK(errors(1000.0, wander).rms_us < 42.4 / 8.0);
    }
}

TEST(SyncClock, of_both_at_once_the_counts_tell_one_from_the_other) {
    const Errors rare = errors(1000.0, [this](int k) {
        return Lateness{k % 50 == 0 ? 20.0 : 0.0, k % 20 == 0 ? 60.0 : up_to(20.0)};
    });
    CHECK(rare.rms_us < 4.0);
    const Errors always = errors(1000.0, [this](int) { return Lateness{up_to(60.0), up_to(60.0)}; });
    CHECK(always.rms_us < uniform_to_60_rms_us / 2.5);
    CHECK(always.increases);
}

TEST(SyncClock, a_spindle_under_shocks_is_not_taken_for_a_clock) {
    const Errors exact = errors(
        1000.0, [](int) { return Lateness{}; }, under_shocks);
    CHECK(exact.rms_us < 0.5);
    const Errors late = errors(
        1000.0,
        [this](int) {
            return Lateness{up_to(60.0), 0.0};
        },
        under_shocks);
    CHECK(late.rms_us < 2.0);
    const Errors stamped_late = errors(
        1000.0,
        [this](int) {
            return Lateness{0.0, up_to(60.0)};
        },
        under_shocks);
    CHECK(stamped_late.rms_us < uniform_to_60_rms_us / 3.0);
    CHECK(stamped_late.increases);
}

TEST(SyncClock, a_period_that_is_not_the_nominal_one_is_followed) {
    const Errors got = errors(1000.2, [this](int) { return Lateness{0.0, up_to(60.0)}; });
    CHECK(got.rms_us < uniform_to_60_rms_us / 5.0);
    DOUBLES_EQUAL(30.0, got.mean_us, 3.0);
}

TEST(SyncClock, at_standstill_stamps_are_trusted) {
    for (std::uint64_t k = 0; k < 3000; ++k) {
        const std::uint64_t stamp_us = start_us + k * 1000 + (k % 7) * 10;
        clock.on_sync(stamp_us);
        clock.on_count(5);
        CHECK(clock.latched_us() == stamp_us);
    }
}

TEST(SyncClock, gaps_and_a_clock_that_was_set_begin_a_new_grid) {
    std::uint64_t stamp_us = start_us;
    for (std::uint32_t k = 0; k < 2000; ++k) {
        clock.on_sync(stamp_us + (k % 2 == 0 ? 20U : 0U));
        clock.on_count(k * 82U);
        stamp_us += 1000;
    }
    const auto off_us = static_cast<double>(clock.latched_us()) - static_cast<double>(stamp_us - 1000);
    DOUBLES_EQUAL(10.0, off_us, 3.0);
    for (const std::uint64_t jump_us : {std::uint64_t{400}, std::uint64_t{5'000'400}}) {
        stamp_us += jump_us;
        clock.on_sync(stamp_us);
        CHECK(clock.latched_us() == stamp_us);
        stamp_us += 1000;
    }
    clock.on_sync(start_us);
    CHECK(clock.latched_us() == start_us);
}

TEST(SyncClock, missed_SYNCs_and_missed_counts_keep_the_grid) {
    double largest_us = 0.0;
    for (std::uint32_t k = 0; k < 5000; ++k) {
        if (k % 10 == 3) {
            continue;
        }
        const std::uint64_t true_us = start_us + k * std::uint64_t{1000};
        clock.on_sync(true_us + (k % 50 == 0 ? 20U : 0U));
        if (k % 10 != 7) {
            clock.on_count(k * 82U);
        }
        if (k > 2000) {
            largest_us =
                std::max(largest_us, std::fabs(static_cast<double>(clock.latched_us()) - static_cast<double>(true_us)));
        }
    }
    CHECK(largest_us < 3.0);
}
