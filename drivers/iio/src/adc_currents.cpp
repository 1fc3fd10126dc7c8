// SPDX-License-Identifier: Apache-2.0
#include "iio/adc_currents.hpp"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace millforce::iio {

namespace {

/// Most reads in one call: a device may be faster than its reader.
constexpr int most_reads_per_call = 64;
constexpr std::int64_t longest_age_ns = 1'000'000'000;

/// Of a timestamp on CLOCK_MONOTONIC; one that is not within the last second counts as now.
std::uint64_t monotonic_time_us(std::int64_t time_ns, int clock, std::uint64_t now_us) {
    timespec now{};
    clock_gettime(clock, &now);
    const std::int64_t now_ns = std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
    const bool is_plausible = time_ns > 0 && time_ns <= now_ns && now_ns - time_ns <= longest_age_ns;
    const std::uint64_t age_us = is_plausible ? static_cast<std::uint64_t>(now_ns - time_ns) / 1000U : 0U;
    return age_us <= now_us ? now_us - age_us : now_us;
}

}  // namespace

void AdcCurrents::poll(std::uint64_t now_us) {
    const bool is_open = buffer_file_ >= 0 || health_.state == AdcState::silent || health_.state == AdcState::running;
    if (!is_open) {
        if (now_us < next_look_us_) {
            return;
        }
        next_look_us_ = now_us + settings_.look_period_us;
        open(now_us);
        if (health_.state != AdcState::silent) {
            return;
        }
    }
    if (settings_.mode == AdcMode::buffered) {
        fetch_scans(now_us);
    } else {
        read_raw_files(now_us);
    }
    if (health_.state == AdcState::running && now_us > heard_us_ + settings_.stale_us) {
        health_.state = AdcState::silent;
    }
}

void AdcCurrents::fetch_scans(std::uint64_t now_us) {
    for (int reads = 0; reads < most_reads_per_call; ++reads) {
        const ssize_t got = read(buffer_file_, bytes_.data() + byte_count_, bytes_.size() - byte_count_);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0 && errno != EAGAIN) {
            // The device may have been unplugged; the failed access says why.
            fail({IioError::file_missing, errno, settings_.buffer});
            return;
        }
        if (got <= 0) {
            return;
        }
        byte_count_ += static_cast<std::size_t>(got);
        std::size_t used = 0;
        for (; byte_count_ - used >= layout_.bytes(); used += layout_.bytes()) {
            take_scan(std::span(bytes_).subspan(used, layout_.bytes()), now_us);
        }
        byte_count_ -= used;
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(used), byte_count_, bytes_.begin());
    }
}

void AdcCurrents::take_scan(std::span<const std::uint8_t> scan, std::uint64_t now_us) {
    newest_us_ = now_us;
    if (timestamp_ != nullptr) {
        const std::int64_t time_ns = decode(scan.subspan(timestamp_->first_byte), timestamp_->format);
        newest_us_ = monotonic_time_us(time_ns, clock_, now_us);
        watch_gap(time_ns);
    }
    for (std::size_t place = 0; place < drive_capacity; ++place) {
        if (!is_wired(place)) {
            continue;
        }
        const Conversion& conversion = conversions_[place];
        const std::int64_t raw = decode(scan.subspan(conversion.first_byte), conversion.format);
        if (is_at_rail(raw, conversion.format)) {
            reject(AdcReject::at_rail);
        } else {
            add(place, raw);
        }
    }
    ++health_.scans;
    has_new_ = true;
    heard_us_ = now_us;
    health_.state = AdcState::running;
}

void AdcCurrents::watch_gap(std::int64_t time_ns) {
    const std::int64_t period_ns = std::int64_t{settings_.sample_period_us} * 1000;
    // Unsigned, so that absurd stamps cannot overflow.
    const auto elapsed_ns =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(time_ns) - static_cast<std::uint64_t>(last_time_ns_));
    if (period_ns > 0 && last_time_ns_ > 0 && elapsed_ns > period_ns + period_ns / 2) {
        const std::int64_t missing = (elapsed_ns + period_ns / 2) / period_ns - 1;
        const std::uint32_t room = UINT32_MAX - health_.overruns;
        health_.overruns += missing < std::int64_t{room} ? static_cast<std::uint32_t>(missing) : room;
    }
    last_time_ns_ = time_ns;
}

void AdcCurrents::read_raw_files(std::uint64_t now_us) {
    for (std::size_t place = 0; place < drive_capacity; ++place) {
        if (!is_wired(place)) {
            continue;
        }
        const Attribute text = read_attribute(raw_files_[place]);
        if (text.error == IioError::file_missing) {
            fail({text.error, text.number, settings_.device});
            return;
        }
        std::int64_t raw = 0;
        if (text.error != IioError::none || parse(text.view(), raw) != IioError::none) {
            reject(AdcReject::unreadable);
            continue;
        }
        add(place, raw);
        ++health_.scans;
        has_new_ = true;
        newest_us_ = heard_us_ = now_us;
        health_.state = AdcState::running;
    }
}

void AdcCurrents::add(std::size_t place, std::int64_t raw) {
    const AdcChannel& channel = settings_.channels[place];
    const Conversion& conversion = conversions_[place];
    const float V = (static_cast<float>(raw) + conversion.offset) * conversion.scale_V;
    const float current_A = (V - channel.zero_V) * channel.A_per_V;
    if (!(current_A <= channel.largest_A && current_A >= -channel.largest_A)) {
        reject(AdcReject::current_range);
        return;
    }
    means_[place].sum_A += current_A;
    ++means_[place].count;
}

void AdcCurrents::reject(AdcReject reason) {
    std::uint32_t& count = health_.rejects[static_cast<std::size_t>(reason)];
    count += count < UINT32_MAX ? 1U : 0U;
}

bool AdcCurrents::take(CurrentReading& reading) {
    if (!has_new_) {
        return false;
    }
    reading = {};
    reading.time_us = newest_us_;
    for (std::size_t place = 0; place < drive_capacity; ++place) {
        const Mean& mean = means_[place];
        reading.has[place] = mean.count > 0;
        reading.current_A[place] = mean.count > 0 ? mean.sum_A / static_cast<float>(mean.count) : 0.0F;
    }
    means_ = {};
    has_new_ = false;
    return true;
}

}  // namespace millforce::iio
