// SPDX-License-Identifier: Apache-2.0
#include "gpio/gpio_chip.hpp"

#include <linux/gpio.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <string>

#include "gpio/feed_hold_line.hpp"

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::gpio;

namespace {

constexpr int chip_descriptor = 100;
constexpr int lines_descriptor = 101;
constexpr std::uint32_t lines_on_chip = 32;

/// A chip as the kernel's uapi v2 has it: lines are asked for once, levels are those of the wires. It reads what is
/// asked from it as gpio.h describes it.
struct FakeKernel {
    std::map<std::uint32_t, bool> wires{};
    gpio_v2_line_request taken{};
    bool is_chip_open = false;
    bool are_lines_open = false;
    bool is_unplugged = false;

    /// Of the request's n-th line.
    [[nodiscard]] std::uint64_t flags(std::uint32_t line) const {
        std::uint64_t flags = taken.config.flags;
        for (std::uint32_t k = 0; k < taken.config.num_attrs; ++k) {
            const gpio_v2_line_config_attribute& attribute = taken.config.attrs[k];
            if (attribute.attr.id == GPIO_V2_LINE_ATTR_ID_FLAGS && (attribute.mask >> line & 1U) != 0) {
                flags = attribute.attr.flags;
            }
        }
        return flags;
    }
    void drive(std::uint64_t bits, std::uint64_t mask) {
        for (std::uint32_t line = 0; line < taken.num_lines; ++line) {
            if ((mask >> line & 1U) != 0) {
                const bool is_inverted = (flags(line) & GPIO_V2_LINE_FLAG_ACTIVE_LOW) != 0;
                wires[taken.offsets[line]] = ((bits >> line & 1U) != 0) != is_inverted;
            }
        }
    }
    int take(gpio_v2_line_request& request) {
        for (std::uint32_t k = 0; k < request.num_lines; ++k) {
            if (request.offsets[k] >= lines_on_chip) {
                return fail(EINVAL);
            }
        }
        if (are_lines_open) {
            return fail(EBUSY);
        }
        taken = request;
        are_lines_open = true;
        for (std::uint32_t k = 0; k < request.config.num_attrs; ++k) {
            if (request.config.attrs[k].attr.id == GPIO_V2_LINE_ATTR_ID_OUTPUT_VALUES) {
                drive(request.config.attrs[k].attr.values, request.config.attrs[k].mask);
            }
        }
        request.fd = lines_descriptor;
        return 0;
    }
    static int fail(int error) {
        errno = error;
        return -1;
    }
};

FakeKernel kernel;

int open_fake(const char* file) {
    if (std::strcmp(file, "/dev/gpiochip7") != 0 || kernel.is_unplugged) {
        return FakeKernel::fail(ENOENT);
    }
    kernel.is_chip_open = true;
    return chip_descriptor;
}

int call_fake(int descriptor, unsigned long request, void* argument) {
    if (kernel.is_unplugged) {
        return FakeKernel::fail(ENODEV);
    }
    if (descriptor == chip_descriptor && request == GPIO_V2_GET_LINE_IOCTL) {
        return kernel.take(*static_cast<gpio_v2_line_request*>(argument));
    }
    if (descriptor == lines_descriptor && request == GPIO_V2_LINE_SET_VALUES_IOCTL) {
        const auto& values = *static_cast<gpio_v2_line_values*>(argument);
        kernel.drive(values.bits, values.mask);
        return 0;
    }
    return FakeKernel::fail(ENOTTY);
}

void close_fake(int descriptor) {
    (descriptor == chip_descriptor ? kernel.is_chip_open : kernel.are_lines_open) = false;
}

constexpr ChipCalls fake_calls{open_fake, call_fake, close_fake};

GpioChipSettings two_lines(std::uint32_t active_low = 0) {
    GpioChipSettings settings;
    settings.set_chip("/dev/gpiochip7");
    settings.offsets = {17, 4};
    settings.line_count = 2;
    settings.active_low = active_low;
    return settings;
}

}  // namespace

TEST_GROUP(GpioChip){void setup() override{kernel = {};
}
void teardown() override {
    kernel = {};
}
}
;

TEST(GpioChip, takes_its_lines_as_outputs_with_their_first_levels_and_sets_them_together) {
    GpioChip chip(two_lines(), fake_calls);
    CHECK(chip.open(0b10));
    CHECK_FALSE(kernel.is_chip_open);  // the lines are a descriptor of their own
    UNSIGNED_LONGS_EQUAL(2, kernel.taken.num_lines);
    CHECK((kernel.flags(0) & GPIO_V2_LINE_FLAG_OUTPUT) != 0);
    CHECK((kernel.flags(1) & GPIO_V2_LINE_FLAG_OUTPUT) != 0);
    STRCMP_EQUAL("millforce feed hold", kernel.taken.consumer);
    CHECK(!kernel.wires.at(17) && kernel.wires.at(4));
    CHECK(chip.set(0b01));
    CHECK(kernel.wires.at(17) && !kernel.wires.at(4));
    LONGS_EQUAL(0, chip.last_error());
}

TEST(GpioChip, with_an_active_low_line_drives_its_wire_low_where_it_is_on_and_leaves_the_other_as_it_is) {
    GpioChip chip(two_lines(0b01), fake_calls);
    CHECK(chip.open(0b11));
    CHECK(!kernel.wires.at(17) && kernel.wires.at(4));
    CHECK(chip.set(0b00));
    CHECK(kernel.wires.at(17) && !kernel.wires.at(4));
    CHECK((kernel.flags(0) & GPIO_V2_LINE_FLAG_OUTPUT) != 0);
}

TEST(GpioChip, gives_its_lines_up_at_its_end) {
    {
        GpioChip chip(two_lines(), fake_calls);
        CHECK(chip.open(0));
        CHECK(kernel.are_lines_open);
    }
    CHECK_FALSE(kernel.are_lines_open);
}

TEST(GpioChip, whose_lines_another_program_has_says_so_and_takes_them_when_they_are_free) {
    kernel.are_lines_open = true;
    GpioChip chip(two_lines(), fake_calls);
    CHECK_FALSE(chip.open(0));
    LONGS_EQUAL(EBUSY, chip.last_error());
    kernel.are_lines_open = false;
    CHECK(chip.open(0));
}

TEST(GpioChip, that_was_unplugged_gives_its_lines_up_and_opens_again) {
    GpioChip chip(two_lines(), fake_calls);
    CHECK(chip.open(0));
    kernel.is_unplugged = true;
    CHECK_FALSE(chip.set(1));
    LONGS_EQUAL(ENODEV, chip.last_error());
    CHECK_FALSE(kernel.are_lines_open);
    CHECK_FALSE(chip.set(1));
    kernel.is_unplugged = false;
    CHECK(chip.open(1));
    CHECK(kernel.wires.at(17));
}

TEST(GpioChip, under_a_feed_hold_line_releases_with_the_tick_holds_without_it_and_holds_at_the_end) {
    {
        GpioChip chip(two_lines(), fake_calls);
        FeedHoldLine line({}, chip);
        line.poll(1'000);
        CHECK_FALSE(kernel.wires.at(17));
        line.update({0.8F, false, 3, 0, 1}, 2'000);
        CHECK(kernel.wires.at(17));
        line.poll(2'000 + 20'001);
        CHECK_FALSE(kernel.wires.at(17));
        line.update({0.8F, false, 3, 0, 2}, 30'000);
        CHECK(kernel.wires.at(17));
    }
    CHECK_FALSE(kernel.wires.at(17));
}

TEST(GpioChip, that_is_not_there_or_is_none_is_an_error_with_its_number) {
    GpioChipSettings settings;
    CHECK_FALSE(settings.set_chip(""));
    CHECK(settings.set_chip("/dev/gpiochip_none"));
    GpioChip without_lines(settings);
    CHECK_FALSE(without_lines.open(0));
    LONGS_EQUAL(EINVAL, without_lines.last_error());
    settings.line_count = 2;
    GpioChip missing(settings);
    CHECK_FALSE(missing.open(0));
    LONGS_EQUAL(ENOENT, missing.last_error());
    CHECK_FALSE(missing.set(1));
    CHECK(settings.set_chip("/dev/null"));
    GpioChip no_chip(settings);
    CHECK_FALSE(no_chip.open(0));
    LONGS_EQUAL(ENOTTY, no_chip.last_error());
    GpioChipSettings beyond = two_lines();
    beyond.offsets[1] = lines_on_chip;
    GpioChip no_such_line(beyond, fake_calls);
    CHECK_FALSE(no_such_line.open(0));
    LONGS_EQUAL(EINVAL, no_such_line.last_error());
}
