// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "iio/adc_currents.hpp"

/// From a device's files to a device that is open.

namespace millforce::iio {

namespace {

bool is_factor(float value) {
    return value - value == 0.0F && (value > 0.0F || value < 0.0F);
}

int open_to_read(const Path& path, Fault& fault) {
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        fault = {
            errno == ENOENT || errno == ENODEV || errno == ENXIO ? IioError::file_missing : IioError::file_unreadable,
            errno, path};
    }
    return descriptor;
}

struct NamedClock {
    std::string_view name;
    int clock;
};

}  // namespace

void AdcCurrents::open(std::uint64_t now_us) {
    const Fault fault = prepare();
    if (fault.error != IioError::none) {
        fail(fault);
        return;
    }
    ++health_.opened;
    health_.state = AdcState::silent;
    heard_us_ = now_us;
    byte_count_ = 0;
    last_time_ns_ = 0;
    means_ = {};
    has_new_ = false;
}

void AdcCurrents::fail(const Fault& fault) {
    close();
    health_.fault = fault;
    health_.state = fault.error == IioError::file_missing ? AdcState::absent : AdcState::refused;
}

Fault AdcCurrents::prepare() {
    bool any = false;
    for (std::size_t place = 0; place < drive_capacity; ++place) {
        if (is_wired(place)) {
            any = true;
            const Fault fault = read_conversion(place);
            if (fault.error != IioError::none) {
                return fault;
            }
        }
    }
    if (!any) {
        return {IioError::settings, 0, settings_.device};
    }
    return settings_.mode == AdcMode::buffered ? prepare_buffer() : open_raw_files();
}

Fault AdcCurrents::read_conversion(std::size_t place) {
    const AdcChannel& channel = settings_.channels[place];
    if (!is_factor(channel.A_per_V) || !(channel.zero_V - channel.zero_V == 0.0F) || !(channel.largest_A > 0.0F)) {
        return {IioError::settings, 0, settings_.device};
    }
    float scale_mV = 0.0F;
    Fault fault = read_shared(settings_.device, "in_", view(channel.name), "_scale", scale_mV);
    if (fault.error != IioError::none) {
        return fault;
    }
    if (!is_factor(scale_mV)) {
        return {IioError::not_a_number, 0, fault.file};
    }
    Conversion conversion;
    conversion.scale_V = scale_mV * 0.001F;
    fault = read_shared(settings_.device, "in_", view(channel.name), "_offset", conversion.offset);
    if (fault.error != IioError::none && fault.error != IioError::file_missing) {  // many converters have none
        return fault;
    }
    conversions_[place] = conversion;
    return {};
}

Fault AdcCurrents::prepare_buffer() {
    std::array<ChannelName, drive_capacity> wanted{};
    std::size_t count = 0;
    for (const AdcChannel& channel : settings_.channels) {
        if (channel.name[0] != '\0') {
            wanted[count++] = channel.name;
        }
    }
    if (settings_.configures) {
        const Path enable = settings_.device.file("buffer/enable");
        int number = 0;
        const IioError error = write_attribute(enable, 0, number);  // nothing can be changed while it runs
        if (error != IioError::none) {
            return {error, number, enable};
        }
    }
    Fault fault = layout_.read(settings_.device, std::span(wanted).first(count), settings_.configures);
    if (fault.error != IioError::none) {
        return fault;
    }
    timestamp_ = layout_.find(timestamp_name);
    for (std::size_t place = 0; place < drive_capacity; ++place) {
        if (is_wired(place)) {
            const ScanElement* element = layout_.find(view(settings_.channels[place].name));
            conversions_[place].format = element->format;
            conversions_[place].first_byte = element->first_byte;
        }
    }
    fault = read_clock();
    return fault.error == IioError::none ? start_buffer() : fault;
}

Fault AdcCurrents::start_buffer() {
    if (settings_.configures) {
        for (const auto& [name, value] : {std::pair{"buffer/length", static_cast<std::int64_t>(settings_.buffer_scans)},
                                          std::pair{"buffer/enable", std::int64_t{1}}}) {
            const Path file = settings_.device.file(name);
            int number = 0;
            const IioError error = write_attribute(file, value, number);
            if (error != IioError::none) {
                return {error, number, file};
            }
        }
    }
    Fault fault;
    buffer_file_ = open_to_read(settings_.buffer, fault);
    return fault;
}

Fault AdcCurrents::open_raw_files() {
    for (std::size_t place = 0; place < drive_capacity; ++place) {
        if (!is_wired(place)) {
            continue;
        }
        const Path file = settings_.device.file("in_").append(view(settings_.channels[place].name)).append("_raw");
        Fault fault;
        raw_files_[place] = open_to_read(file, fault);
        if (fault.error != IioError::none) {
            return fault;
        }
    }
    return {};
}

Fault AdcCurrents::read_clock() {
    static constexpr std::array<NamedClock, 7> clocks{{{"realtime", CLOCK_REALTIME},
                                                       {"monotonic", CLOCK_MONOTONIC},
                                                       {"monotonic_raw", CLOCK_MONOTONIC_RAW},
                                                       {"realtime_coarse", CLOCK_REALTIME_COARSE},
                                                       {"monotonic_coarse", CLOCK_MONOTONIC_COARSE},
                                                       {"boottime", CLOCK_BOOTTIME},
                                                       {"tai", CLOCK_TAI}}};
    const Path file = settings_.device.file("current_timestamp_clock");
    const Attribute text = read_attribute(file);
    if (text.error == IioError::file_missing) {
        clock_ = CLOCK_REALTIME;  // what kernels use that have no choice
        return {};
    }
    if (text.error != IioError::none) {
        return {text.error, text.number, file};
    }
    const auto* const found =
        std::find_if(clocks.begin(), clocks.end(), [&](const NamedClock& known) { return known.name == text.view(); });
    if (found == clocks.end()) {
        return {IioError::clock, 0, file};
    }
    clock_ = found->clock;
    return {};
}

void AdcCurrents::close() {
    for (int& file : raw_files_) {
        if (file >= 0) {
            ::close(file);
        }
        file = -1;
    }
    if (buffer_file_ >= 0) {
        ::close(buffer_file_);
        if (settings_.configures) {
            int number = 0;
            (void)write_attribute(settings_.device.file("buffer/enable"), 0, number);
        }
    }
    buffer_file_ = -1;
}

}  // namespace millforce::iio
