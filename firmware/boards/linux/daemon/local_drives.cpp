// SPDX-License-Identifier: Apache-2.0
#include "daemon/local_drives.hpp"

#include <fmt/format.h>

#include <cmath>

#include "daemon/local_settings.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

iio::AdcSettings adc_settings(const LocalIoKeys& keys) {
    iio::AdcSettings settings;
    settings.device = local_path("iio.device", keys.device);
    settings.mode = keys.mode == ConverterMode::polled ? iio::AdcMode::polled : iio::AdcMode::buffered;
    if (settings.mode == iio::AdcMode::buffered) {
        settings.buffer = local_path("iio.buffer", keys.buffer);
    }
    settings.configures = keys.configures;
    settings.buffer_scans = keys.buffer_scans;
    settings.sample_period_us = static_cast<std::uint32_t>(keys.sample_period_us);
    settings.stale_us = static_cast<std::uint32_t>(keys.stale_ms * 1e3);
    for (std::size_t place = 0; place < keys.drives.size(); ++place) {
        const LocalDriveKeys& drive = keys.drives[place];
        if (drive.is_used()) {
            settings.channels[place] = {
                local_channel(fmt::format("{}.current_channel", local_drive_tables[place]), drive.current_channel),
                static_cast<float>(drive.A_per_V), static_cast<float>(drive.zero_V),
                static_cast<float>(drive.largest_A)};
        }
    }
    return settings;
}

iio::CounterSettings counter_settings(const char* table, const LocalDriveKeys& drive) {
    iio::CounterSettings settings;
    settings.count_file = local_path(fmt::format("{}.count_file", table), drive.count_file);
    settings.modulus = drive.count_modulus;
    settings.largest_step = drive.largest_count_step;
    settings.reversed = drive.count_reversed;
    settings.mm_per_count = static_cast<float>(drive.mm_per_count);
    return settings;
}

const char* word(iio::AdcState state) {
    constexpr const char* words[] = {"absent", "refused", "silent", "running"};
    return words[static_cast<std::size_t>(state) % 4U];
}

}  // namespace

LocalDrives::LocalDrives(const MachineBus& bus) : complete_(bus.drives.beside_bus) {
    if (!bus.local.has_inputs()) {
        return;
    }
    adc_.emplace(adc_settings(bus.local));
    for (std::size_t place = 0; place < counters_.size(); ++place) {
        const LocalDriveKeys& keys = bus.local.drives[place];
        if (keys.is_used() && keys.has_counter()) {
            counters_[place].emplace(counter_settings(local_drive_tables[place], keys));
        }
        if (place > 0) {
            largest_velocity_mm_s_[place - 1] = bus.drives.drives[place].largest_velocity_mm_s;
        }
    }
}

void LocalDrives::poll(std::uint64_t now_us) {
    if (!adc_) {
        return;
    }
    adc_->poll(now_us);
    iio::CurrentReading currents;
    has_sample_ = adc_->take(currents);
    had_sample_ = had_sample_ || has_sample_;
    sample_ = iio::join(currents, read_motion(now_us));  // without currents, too: the counters stay in step
}

iio::MotionReading LocalDrives::read_motion(std::uint64_t now_us) {
    iio::MotionReading motion;
    if (counters_[0]) {
        iio::read_spindle(*counters_[0], now_us, motion);
    }
    for (std::size_t axis = 0; axis < hal::axis_count; ++axis) {
        if (std::optional<iio::CounterInput>& counter = counters_[1 + axis]; counter) {
            iio::read_axis(*counter, now_us, axis, motion);
            motion.has_velocity[axis] =
                motion.has_velocity[axis] && std::abs(motion.velocity_mm_s[axis]) <= largest_velocity_mm_s_[axis];
        }
    }
    return motion;
}

bool LocalDrives::take_sample(hal::DriveSample& sample) {
    if (!has_sample_) {
        return false;
    }
    has_sample_ = false;
    sample = sample_;
    return true;
}

hal::SourceState LocalDrives::state() const {
    if (!had_sample_) {
        return hal::SourceState::waiting;
    }
    return health().is_failed ? hal::SourceState::silent : hal::SourceState::running;
}

LocalInputHealth LocalDrives::health() const {
    if (!adc_) {
        return {};
    }
    if (const iio::AdcHealth& adc = adc_->health(); adc.state != iio::AdcState::running) {
        if (adc.state == iio::AdcState::absent && adc.fault.error == iio::IioError::none) {
            return {};  // not looked for yet: no SYNC
        }
        const bool has_file = adc.state != iio::AdcState::silent;
        return {true, word(adc.state), has_file ? adc.fault : iio::Fault{}};
    }
    for (const std::optional<iio::CounterInput>& counter : counters_) {
        if (counter && !counter->health().is_ready) {
            return {true, "no count", counter->health().fault};
        }
    }
    return {};
}

}  // namespace millforce::host
