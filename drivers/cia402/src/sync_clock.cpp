// SPDX-License-Identifier: Apache-2.0
#include "cia402/sync_clock.hpp"

#include "cia402/magnitude.hpp"

#include <algorithm>

namespace millforce::cia402 {

namespace {

constexpr float grid_gain = 1.0F / 64.0F;
constexpr float drift_gain = grid_gain * grid_gain / 4.0F;  // critically damped
constexpr float position_gain = 1.0F / 4.0F;
constexpr float speed_gain = position_gain * position_gain / (2.0F - position_gain);
constexpr float followed_noise = 0.25F;  // of white noise with variance 1 in what is followed so: a step ahead
constexpr float memory_periods = 1024.0F;
constexpr float enough_periods = 200.0F;
constexpr std::uint32_t settled = 32;  // counts until the spindle is followed well
constexpr std::uint32_t longest_uncounted_periods = 8;
constexpr std::uint64_t longest_grid_periods = 1000;
constexpr float fewest_counts = 4.0F;
constexpr float largest_change = 0.25F;
constexpr float smallest_variance_us2 = 0.1F;
constexpr float contradiction_sd2 = 16.0F;

float square(float value) {
    return value * value;
}

std::int64_t rounded(float value) {
    return static_cast<std::int64_t>(value < 0.0F ? value - 0.5F : value + 0.5F);
}

std::uint64_t shifted(std::uint64_t time_ns, float by_ns) {
    return time_ns + static_cast<std::uint64_t>(rounded(by_ns));
}

}  // namespace

SyncClock::SyncClock(std::uint32_t period_us) : period_ns_(1000ULL * std::max<std::uint32_t>(period_us, 1U)) {}

void SyncClock::restart_at(std::uint64_t stamp_us) {
    grid_ns_ = stamp_us * 1000U;
    drift_ns_ = 0.0F;
    by_stamp_us_ = 0.0F;
    ahead_us_ = 0.0F;
    ahead_us_per_period_ = 0.0F;
    latched_off_us_ = 0.0F;
    has_count_ = false;
}

void SyncClock::on_sync(std::uint64_t stamp_us) {
    const std::uint64_t stamp_ns = stamp_us * 1000U;
    const std::uint64_t before_ns = shifted(grid_ns_, grid_gain * 1000.0F * by_stamp_us_);
    const std::uint64_t periods = stamp_ns < before_ns ? 0 : (stamp_ns - before_ns + period_ns_ / 2) / period_ns_;
    if (grid_ns_ == 0 || periods == 0 || periods > longest_grid_periods) {
        restart_at(stamp_us);
        return;
    }
    drift_ns_ += drift_gain * 1000.0F * by_stamp_us_;
    ahead_us_ -= grid_gain * by_stamp_us_;
    ahead_us_per_period_ -= drift_gain * by_stamp_us_;
    grid_ns_ = shifted(before_ns + periods * period_ns_, static_cast<float>(periods) * drift_ns_);
    const auto off_ns = static_cast<std::int64_t>(stamp_ns - grid_ns_);
    const auto quarter_ns = static_cast<std::int64_t>(period_ns_ / 4);
    if (off_ns > quarter_ns || off_ns < -quarter_ns) {
        restart_at(stamp_us);
        return;
    }
    by_stamp_us_ = static_cast<float>(off_ns) * 0.001F;
    latched_off_us_ = by_stamp_us_;
    follow_stamp(static_cast<float>(periods));
    since_count_ = std::min(since_count_ + static_cast<std::uint32_t>(periods), longest_uncounted_periods + 1);
}

void SyncClock::follow_stamp(float periods) {
    expected_us_ = ahead_us_ + periods * ahead_us_per_period_;
    const float off_us = by_stamp_us_ - expected_us_;
    ahead_us_ = expected_us_ + position_gain * off_us;
    ahead_us_per_period_ += speed_gain * off_us / periods;
}

bool SyncClock::count_follows() const {
    return has_count_ && since_count_ > 0 && since_count_ <= longest_uncounted_periods;
}

void SyncClock::restart_counting(std::uint32_t count) {
    const auto turned = static_cast<float>(static_cast<std::int32_t>(count - last_count_));
    counts_per_period_ = count_follows() ? turned / static_cast<float>(since_count_) : 0.0F;
    ahead_counts_ = 0.0F;
    followed_ = 0;
    last_count_ = count;
    since_count_ = 0;
    has_count_ = true;
}

void SyncClock::on_count(std::uint32_t count) {
    const auto periods = static_cast<float>(since_count_);
    const auto turned = static_cast<float>(static_cast<std::int32_t>(count - last_count_));
    const float off_counts = turned - ahead_counts_ - periods * counts_per_period_;
    const float speed = magnitude(counts_per_period_);
    if (!count_follows() || speed < fewest_counts || magnitude(off_counts) > largest_change * speed) {
        restart_counting(count);
        return;
    }
    if (followed_ == settled) {
        const float by_counts_us = off_counts / counts_per_period_ * static_cast<float>(period_ns_) * 0.001F;
        weigh(by_counts_us);
        learn(by_counts_us);
    }
    followed_ += followed_ < settled ? 1U : 0U;
    ahead_counts_ = (position_gain - 1.0F) * off_counts;
    counts_per_period_ += speed_gain * off_counts / periods;
    last_count_ = count;
    since_count_ = 0;
}

void SyncClock::learn(float by_counts_us) {
    learnt_ = std::min(learnt_ + 1.0F, memory_periods);
    const float share = 1.0F / learnt_;
    const float off_us = by_stamp_us_ - expected_us_;
    mean_ss_us2_ += share * (square(off_us) - mean_ss_us2_);
    mean_cc_us2_ += share * (square(by_counts_us) - mean_cc_us2_);
    mean_sc_us2_ += share * (off_us * by_counts_us - mean_sc_us2_);
    mean_wander_us2_ += share * (square(expected_us_) - mean_wander_us2_);
}

void SyncClock::weigh(float by_counts_us) {
    if (learnt_ < enough_periods) {
        return;
    }
    const float of_sync = std::max(mean_sc_us2_, smallest_variance_us2);
    const float of_stamp = std::max(mean_ss_us2_ - mean_sc_us2_, smallest_variance_us2);
    const float of_counts = std::max(mean_cc_us2_ - mean_sc_us2_, smallest_variance_us2);
    const float wander = std::max(mean_wander_us2_, smallest_variance_us2);
    const float base_us = expected_us_ * std::max(0.0F, 1.0F - followed_noise * of_stamp / wander);
    const float off_us = by_stamp_us_ - base_us;
    const bool contradicts = square(off_us - by_counts_us) > contradiction_sd2 * (of_stamp + of_counts);
    const float counts_weight = contradicts ? 0.0F : 1.0F / of_counts;
    latched_off_us_ = base_us + (off_us / of_stamp + by_counts_us * counts_weight) /
                                    (1.0F / of_stamp + counts_weight + 1.0F / of_sync);
}

std::uint64_t SyncClock::latched_us() const {
    return (shifted(grid_ns_, latched_off_us_ * 1000.0F) + 500U) / 1000U;
}

}  // namespace millforce::cia402
