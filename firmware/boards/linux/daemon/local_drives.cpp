// SPDX-License-Identifier: Apache-2.0
#include "daemon/local_drives.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "daemon/local_settings.hpp"
#include "files/input_error.hpp"

namespace millforce::host {

namespace {

/// Little-endian, as CANopen has it.
void append(hal::CanFrame& frame, std::uint32_t value) {
    for (unsigned k = 0; k < 4; ++k) {
        frame.data[frame.length++] = static_cast<std::uint8_t>(value >> (8U * k));
    }
}

/// Saturated; the controller's limits are far below.
std::uint32_t milli(float value) {
    constexpr float largest = 2e9F;
    const float scaled = std::fmin(std::fmax(value * 1000.0F, -largest), largest);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(scaled)));
}

iio::AdcSettings adc_settings(const LocalIoKeys& keys) {
    iio::AdcSettings settings;
    settings.device = local_path("iio.device", keys.device);
    settings.mode = static_cast<iio::AdcMode>(std::lround(keys.mode));
    if (settings.mode == iio::AdcMode::buffered) {
        settings.buffer = local_path("iio.buffer", keys.buffer);
    }
    settings.configures = keys.configures > 0.5;
    settings.buffer_scans = static_cast<std::uint32_t>(keys.buffer_scans);
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
    settings.modulus = static_cast<std::uint32_t>(drive.count_modulus);
    settings.largest_step = static_cast<std::uint32_t>(drive.largest_count_step);
    settings.reversed = drive.count_reversed > 0.5;
    settings.mm_per_count = static_cast<float>(drive.mm_per_count);
    return settings;
}

const char* word(iio::AdcState state) {
    constexpr const char* words[] = {"absent", "refused", "silent", "running"};
    return words[static_cast<std::size_t>(state) % 4U];
}

}  // namespace

LocalDrives::LocalDrives(const MachineBus& bus) {
    if (!bus.local.has_inputs()) {
        return;
    }
    adc_.emplace(adc_settings(bus.local));
    for (std::size_t place = 0; place < drives_.size(); ++place) {
        const LocalDriveKeys& keys = bus.local.drives[place];
        if (!keys.is_used()) {
            continue;
        }
        drives_[place].id = bus.drives.drives[place].pdos[local_pdo].id;
        if (keys.has_counter()) {
            drives_[place].counter.emplace(counter_settings(local_drive_tables[place], keys));
        }
    }
}

void LocalDrives::on_sync(std::uint64_t now_us) {
    if (!adc_) {
        return;
    }
    outgoing_count_ = taken_ = 0;
    adc_->poll(now_us);
    iio::CurrentReading currents;
    const bool has_currents = adc_->take(currents);
    for (std::size_t place = 0; place < drives_.size(); ++place) {
        if (has_currents) {
            read(place, currents, now_us);
        } else if (drives_[place].counter) {
            (void)drives_[place].counter->read(now_us);  // stays in step
        }
    }
}

void LocalDrives::read(std::size_t place, const iio::CurrentReading& currents, std::uint64_t now_us) {
    Drive& drive = drives_[place];
    hal::CanFrame frame;
    frame.id = drive.id;
    if (drive.counter) {
        const bool has_count = drive.counter->read(now_us);
        if (!has_count || (place > 0 && !drive.counter->has_velocity())) {
            return;
        }
        append(frame, place == 0 ? drive.counter->count() : milli(drive.counter->velocity_mm_s()));
    }
    if (drive.id != 0 && currents.has[place]) {
        append(frame, milli(currents.current_A[place]));
        outgoing_[outgoing_count_++] = frame;
    }
}

bool LocalDrives::take_frame(hal::CanFrame& frame) {
    if (taken_ >= outgoing_count_) {
        return false;
    }
    frame = outgoing_[taken_++];
    return true;
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
    for (const Drive& drive : drives_) {
        if (drive.counter && !drive.counter->health().is_ready) {
            return {true, "no count", drive.counter->health().fault};
        }
    }
    return {};
}

}  // namespace millforce::host
