// SPDX-License-Identifier: Apache-2.0
#include "daemon/local_outputs.hpp"

#include <fmt/format.h>

#include "daemon/local_settings.hpp"

namespace millforce::host {

namespace {

iio::AnalogueOverrideSettings voltage_settings(const LocalIoKeys& keys) {
    iio::AnalogueOverrideSettings settings;
    settings.device = local_path("override_voltage.device", keys.voltage_device);
    settings.channel = local_channel("override_voltage.channel", keys.voltage_channel);
    settings.V_per_ratio = static_cast<float>(keys.V_per_ratio);
    settings.zero_V = static_cast<float>(keys.voltage_zero_V);
    settings.lowest_V = static_cast<float>(keys.lowest_V);
    settings.highest_V = static_cast<float>(keys.highest_V);
    settings.safe_V = static_cast<float>(keys.safe_V);
    settings.lowest_raw = keys.lowest_raw;
    settings.highest_raw = keys.highest_raw;
    return settings;
}

gpio::GpioChipSettings chip_settings(const LocalIoKeys& keys) {
    gpio::GpioChipSettings settings;
    if (!settings.set_chip(keys.chip)) {
        throw InputError(fmt::format("feed_hold_line.chip = \"{}\": expected a path of 1 to {} characters", keys.chip,
                                     settings.chip.size() - 1));
    }
    settings.offsets = {keys.release_line, keys.pulse_line};
    settings.line_count = 2;
    settings.active_low = keys.active_low ? gpio::FeedHoldLine::release_line : 0U;
    return settings;
}

}  // namespace

LocalOutputs::LocalOutputs(const LocalIoKeys& keys) {
    if (keys.has_voltage()) {
        voltage_.emplace(voltage_settings(keys));
    }
    if (keys.has_lines()) {
        chip_.emplace(chip_settings(keys));
        lines_.emplace(gpio::FeedHoldSettings{}, *chip_);
    }
}

void LocalOutputs::update(const hal::FeedOverride& feed_override, std::uint64_t now_us) {
    if (voltage_) {
        voltage_->update(feed_override, now_us);
    }
    if (lines_) {
        lines_->update(feed_override, now_us);
    }
}

void LocalOutputs::poll(std::uint64_t now_us) {
    if (voltage_) {
        voltage_->poll(now_us);
    }
    if (lines_) {
        lines_->poll(now_us);
    }
}

LocalOutputHealth LocalOutputs::health() const {
    if (voltage_ && !voltage_->health().is_ready) {
        return {true, "override_voltage", voltage_->fault(), voltage_->health().last_error};
    }
    if (lines_ && !lines_->health().is_ready) {
        return {true, "feed_hold_line", {}, lines_->health().last_error};
    }
    return {};
}

}  // namespace millforce::host
