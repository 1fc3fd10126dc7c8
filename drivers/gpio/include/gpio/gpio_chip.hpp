// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "gpio/line_port.hpp"

namespace millforce::gpio {

inline constexpr std::size_t line_capacity = 4;

struct GpioChipSettings {
    std::array<char, 64> chip{};                         ///< /dev/gpiochip0
    std::array<std::uint32_t, line_capacity> offsets{};  ///< places of the lines on the chip
    std::size_t line_count = 0;
    std::uint32_t active_low = 0;  ///< bits of lines whose level is the opposite

    /// False where the name is empty or longer than 63 characters.
    bool set_chip(std::string_view name);
};

/// The calls to the kernel, each as its name says: -1 and errno where it fails.
struct ChipCalls {
    int (*open)(const char* file);
    int (*ioctl)(int descriptor, unsigned long request, void* argument);
    void (*close)(int descriptor);
};
[[nodiscard]] const ChipCalls& linux_calls();

/// Lines of a GPIO chip of Linux, by its character device (uapi v2, Linux 5.10). No heap; a call is one ioctl.
class GpioChip final : public LinePort {
  public:
    /// `calls` outlive this object.
    explicit GpioChip(const GpioChipSettings& settings, const ChipCalls& calls = linux_calls())
        : settings_(settings), calls_(calls) {
        settings_.chip.back() = '\0';
    }
    ~GpioChip() { close(); }
    GpioChip(const GpioChip&) = delete;
    GpioChip& operator=(const GpioChip&) = delete;

    [[nodiscard]] bool open(std::uint32_t levels) override;
    [[nodiscard]] bool set(std::uint32_t levels) override;
    [[nodiscard]] int last_error() const override { return last_error_; }

  private:
    [[nodiscard]] std::uint32_t all_lines() const { return (1U << settings_.line_count) - 1U; }
    void close();

    GpioChipSettings settings_;
    const ChipCalls& calls_;
    int lines_ = -1;
    int last_error_ = 0;
};

}  // namespace millforce::gpio
