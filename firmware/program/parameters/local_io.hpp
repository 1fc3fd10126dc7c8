// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

/// Inputs and outputs of this computer, apart from the bus: machine.toml's tables [iio], [iio.spindle], [iio.x] …,
/// [override_voltage] and [feed_hold_line]. They name files of Linux, so they are no part of a chip's parameters; their
/// keys are described here, once, for the reader and for `millforce parameters`. Defaults stand in these structures
/// alone.

namespace millforce::host {

/// How the converter's values are fetched.
enum class ConverterMode : std::uint8_t { buffered, polled };

/// One motor's current by a converter, and where it is wired its encoder by a counter.
struct LocalDriveKeys {
    std::string current_channel;
    std::string count_file;
    double A_per_V = 0.0;
    double zero_V = 0.0;
    double largest_A = 100.0;
    double mm_per_count = 0.0;
    std::uint32_t count_modulus = 0;
    std::uint32_t largest_count_step = 1'048'576;
    bool count_reversed = false;

    [[nodiscard]] bool is_used() const { return !current_channel.empty(); }
    [[nodiscard]] bool has_counter() const { return !count_file.empty(); }
};

struct LocalIoKeys {
    std::string device;
    std::string buffer;
    ConverterMode mode = ConverterMode::buffered;
    bool configures = true;
    std::uint32_t buffer_scans = 1024;
    double sample_period_us = 0.0;
    double stale_ms = 20.0;
    std::array<LocalDriveKeys, 4> drives{};  ///< spindle, x, y, z

    std::string voltage_device;
    std::string voltage_channel;
    double V_per_ratio = 5.0;
    double voltage_zero_V = 0.0;
    double lowest_V = 0.0;
    double highest_V = 10.0;
    double safe_V = 0.0;
    std::int32_t lowest_raw = 0;
    std::int32_t highest_raw = 4095;

    std::string chip;
    std::uint32_t release_line = 0;
    std::uint32_t pulse_line = 1;
    bool active_low = false;

    [[nodiscard]] bool has_inputs() const;
    [[nodiscard]] bool has_voltage() const { return !voltage_device.empty(); }
    [[nodiscard]] bool has_lines() const { return !chip.empty(); }
};

/// A key's field. Its type says what the key holds: a flag, a choice, a whole number, a number.
using LocalField = std::variant<bool*, ConverterMode*, std::uint32_t*, std::int32_t*, double*>;

/// A key whose value is no text. Its default is that of a LocalIoKeys as it is constructed.
struct LocalValueRow {
    const char* table;  ///< "iio.drive" stands for each of "iio.spindle", "iio.x" …
    const char* key;
    const char* unit;
    double minimum;
    double maximum;
    const char* sentence;
    LocalField (*field)(LocalIoKeys& keys, std::size_t drive);
    bool is_required = false;       ///< if the table exists
    const char* choices = nullptr;  ///< the words of a choice, separated by '|'
};

/// A file, a channel.
struct LocalTextRow {
    const char* table;
    const char* key;
    const char* form;  ///< an example
    const char* sentence;
    std::string& (*field)(LocalIoKeys& keys, std::size_t drive);
};

extern const std::array<LocalTextRow, 7> local_texts;
extern const std::array<LocalValueRow, 22> local_values;
inline constexpr std::array<const char*, 4> local_drive_tables{"iio.spindle", "iio.x", "iio.y", "iio.z"};

}  // namespace millforce::host
