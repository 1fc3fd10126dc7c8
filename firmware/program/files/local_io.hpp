// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

/// Inputs and outputs of this computer, apart from the bus: machine.toml's tables [iio], [iio.spindle], [iio.x] …,
/// [override_voltage] and [feed_hold_line]. They name files of Linux, so they are no part of a chip's parameters; their
/// keys are described here, once, for the reader and for `millforce parameters`.

namespace millforce::host {

/// One motor's current by a converter, and where it is wired its encoder by a counter.
struct LocalDriveKeys {
    std::string current_channel;
    std::string count_file;
    double A_per_V = 0.0;
    double zero_V = 0.0;
    double largest_A = 100.0;
    double mm_per_count = 0.0;
    double count_modulus = 0.0;
    double largest_count_step = 1'048'576.0;
    double count_reversed = 0.0;

    [[nodiscard]] bool is_used() const { return !current_channel.empty(); }
    [[nodiscard]] bool has_counter() const { return !count_file.empty(); }
};

struct LocalIoKeys {
    std::string device;
    std::string buffer;
    double mode = 0.0;  ///< index into iio::AdcMode
    double configures = 1.0;
    double buffer_scans = 1024.0;
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
    double lowest_raw = 0.0;
    double highest_raw = 4095.0;

    std::string chip;
    double release_line = 0.0;
    double pulse_line = 1.0;
    double active_low = 0.0;

    [[nodiscard]] bool has_inputs() const;
    [[nodiscard]] bool has_voltage() const { return !voltage_device.empty(); }
    [[nodiscard]] bool has_lines() const { return !chip.empty(); }
};

/// A number, or a word if there are choices.
struct LocalNumberRow {
    const char* table;  ///< "iio.drive" stands for each of "iio.spindle", "iio.x" …
    const char* key;
    const char* unit;
    double default_value;  ///< NaN: required if the table exists
    double minimum;
    double maximum;
    const char* sentence;
    double& (*field)(LocalIoKeys& keys, std::size_t drive);
    const char* choices = nullptr;
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
extern const std::array<LocalNumberRow, 22> local_numbers;
inline constexpr std::array<const char*, 4> local_drive_tables{"iio.spindle", "iio.x", "iio.y", "iio.z"};

}  // namespace millforce::host
