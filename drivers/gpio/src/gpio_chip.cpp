// SPDX-License-Identifier: Apache-2.0
#include "gpio/gpio_chip.hpp"

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace millforce::gpio {

namespace {

constexpr std::string_view consumer = "millforce feed hold";

gpio_v2_line_attribute flags_attribute(std::uint64_t flags) {
    gpio_v2_line_attribute attribute{};
    attribute.id = GPIO_V2_LINE_ATTR_ID_FLAGS;
    attribute.flags = flags;
    return attribute;
}

gpio_v2_line_attribute levels_attribute(std::uint32_t levels) {
    gpio_v2_line_attribute attribute{};
    attribute.id = GPIO_V2_LINE_ATTR_ID_OUTPUT_VALUES;
    attribute.values = levels;
    return attribute;
}

int open_chip(const char* file) {
    return ::open(file, O_RDWR | O_CLOEXEC);
}
int call_chip(int descriptor, unsigned long request, void* argument) {
    return ::ioctl(descriptor, request, argument);
}
void close_chip(int descriptor) {
    ::close(descriptor);
}

constexpr ChipCalls calls_of_linux{open_chip, call_chip, close_chip};

}  // namespace

const ChipCalls& linux_calls() {
    return calls_of_linux;
}

bool GpioChipSettings::set_chip(std::string_view name) {
    if (name.empty() || name.size() >= chip.size()) {
        return false;
    }
    chip = {};
    std::copy(name.begin(), name.end(), chip.begin());
    return true;
}

bool GpioChip::open(std::uint32_t levels) {
    close();
    if (settings_.line_count == 0 || settings_.line_count > line_capacity) {
        last_error_ = EINVAL;
        return false;
    }
    const int chip = calls_.open(settings_.chip.data());
    if (chip < 0) {
        last_error_ = errno;
        return false;
    }
    gpio_v2_line_request request{};
    std::copy_n(settings_.offsets.begin(), settings_.line_count, std::begin(request.offsets));
    std::copy(consumer.begin(), consumer.end(), std::begin(request.consumer));
    request.num_lines = static_cast<std::uint32_t>(settings_.line_count);
    request.config.flags = GPIO_V2_LINE_FLAG_OUTPUT;
    request.config.attrs[request.config.num_attrs++] = {levels_attribute(levels), all_lines()};
    if ((settings_.active_low & all_lines()) != 0) {
        request.config.attrs[request.config.num_attrs++] = {
            flags_attribute(GPIO_V2_LINE_FLAG_OUTPUT | GPIO_V2_LINE_FLAG_ACTIVE_LOW),
            settings_.active_low & all_lines()};
    }
    const bool is_taken = calls_.ioctl(chip, GPIO_V2_GET_LINE_IOCTL, &request) == 0;
    last_error_ = is_taken ? 0 : errno;
    calls_.close(chip);
    lines_ = is_taken ? request.fd : -1;
    return is_taken;
}

bool GpioChip::set(std::uint32_t levels) {
    gpio_v2_line_values values{levels, all_lines()};
    if (lines_ >= 0 && calls_.ioctl(lines_, GPIO_V2_LINE_SET_VALUES_IOCTL, &values) == 0) {
        return true;
    }
    last_error_ = lines_ >= 0 ? errno : ENODEV;
    close();
    return false;
}

void GpioChip::close() {
    if (lines_ >= 0) {
        calls_.close(lines_);
    }
    lines_ = -1;
}

}  // namespace millforce::gpio
