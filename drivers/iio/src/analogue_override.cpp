// SPDX-License-Identifier: Apache-2.0
#include "iio/analogue_override.hpp"

#include <algorithm>

namespace millforce::iio {

AnalogueOverride::AnalogueOverride(const AnalogueOverrideSettings& settings)
    : settings_(settings), watch_(settings.tick_timeout_us) {
    raw_file_ = settings_.device.file("out_").append(view(settings_.channel)).append("_raw");
}

AnalogueOverride::~AnalogueOverride() {
    if (is_prepared_) {
        int number = 0;
        (void)write_attribute(raw_file_, raw_of(settings_.safe_V), number);
    }
}

void AnalogueOverride::update(const hal::FeedOverride& feed_override, std::uint64_t time_us) {
    watch_.update(feed_override.heartbeat, time_us);
    health_.ticks = watch_.ticks(time_us);
    if (!health_.ticks || hal::demands_stop(feed_override)) {
        put(settings_.safe_V, time_us);
        return;
    }
    const float V = settings_.zero_V + feed_override.ratio * settings_.V_per_ratio;
    put(std::clamp(V, settings_.lowest_V, settings_.highest_V), time_us);
}

void AnalogueOverride::poll(std::uint64_t time_us) {
    health_.ticks = watch_.ticks(time_us);
    if (!health_.ticks) {
        put(settings_.safe_V, time_us);
    }
}

bool AnalogueOverride::prepare() {
    float scale_mV = 0.0F;
    Fault fault = read_shared(settings_.device, "out_", view(settings_.channel), "_scale", scale_mV);
    if (fault.error != IioError::none) {
        fail(fault);
        return false;
    }
    float offset = 0.0F;
    const Fault offset_fault = read_shared(settings_.device, "out_", view(settings_.channel), "_offset", offset);
    if (offset_fault.error != IioError::none && offset_fault.error != IioError::file_missing) {
        fail(offset_fault);
        return false;
    }
    const bool fits =
        scale_mV > 0.0F && settings_.lowest_V < settings_.highest_V && settings_.lowest_raw < settings_.highest_raw;
    if (!fits) {
        fault.error = scale_mV > 0.0F ? IioError::settings : IioError::not_a_number;
        fail(fault);
        return false;
    }
    scale_V_ = scale_mV * 0.001F;
    offset_ = offset;
    return true;
}

std::int64_t AnalogueOverride::raw_of(float V) const {
    const float raw = V / scale_V_ - offset_;
    const auto lowest = static_cast<float>(settings_.lowest_raw);
    const auto highest = static_cast<float>(settings_.highest_raw);
    if (!(raw > lowest)) {  // also for a raw value that is NaN
        return settings_.lowest_raw;
    }
    return raw >= highest ? settings_.highest_raw : static_cast<std::int64_t>(raw + (raw >= 0.0F ? 0.5F : -0.5F));
}

void AnalogueOverride::put(float V, std::uint64_t time_us) {
    const bool is_due = !is_tried_ || time_us >= tried_us_ + settings_.refresh_us;
    if (!is_prepared_) {
        if (!is_due) {
            return;
        }
        is_tried_ = true;
        tried_us_ = time_us;
        is_prepared_ = prepare();
        if (is_prepared_) {
            write(raw_of(V), time_us);
        }
        return;
    }
    const std::int64_t raw = raw_of(V);
    if (is_due || !health_.is_ready || raw != written_raw_) {
        write(raw, time_us);
    }
}

void AnalogueOverride::write(std::int64_t raw, std::uint64_t time_us) {
    tried_us_ = time_us;
    int number = 0;
    const IioError error = write_attribute(raw_file_, raw, number);
    if (error != IioError::none) {
        fail({error, number, raw_file_});
        return;
    }
    written_raw_ = raw;
    health_.is_ready = true;
}

void AnalogueOverride::fail(const Fault& fault) {
    fault_ = fault;
    health_.is_ready = false;
    health_.last_error = fault.number;
    health_.failures += health_.failures < UINT32_MAX ? 1U : 0U;
}

}  // namespace millforce::iio
