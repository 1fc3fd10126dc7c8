// SPDX-License-Identifier: Apache-2.0
#include "parameters/local_io_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "parameters/parameter_choices.hpp"

namespace millforce::host {

namespace {

constexpr double largest_raw = 2147483647.0;

}  // namespace

// The rows are data; one row a line keeps them readable as the table that they are.
// clang-format off
// NOLINTBEGIN(bugprone-macro-parentheses): a lambda is one expression already
#define MILLFORCE_KEY(member) [](LocalIoKeys& k, std::size_t) -> auto& { return k.member; }
#define MILLFORCE_LOCAL(member) [](LocalIoKeys& k, std::size_t drive) -> auto& { return k.drives[drive].member; }
#define MILLFORCE_VALUE(member) [](LocalIoKeys& k, std::size_t) -> LocalField { return &k.member; }
#define MILLFORCE_LOCAL_VALUE(member) [](LocalIoKeys& k, std::size_t drive) -> LocalField { return &k.drives[drive].member; }
// NOLINTEND(bugprone-macro-parentheses)

const std::array<LocalTextRow, 7> local_texts{{
    {"iio", "device", "\"/sys/bus/iio/devices/iio:device0\"", "Folder of the analogue-to-digital converter for motor currents.", MILLFORCE_KEY(device)},
    {"iio", "buffer", "\"/dev/iio:device0\"", "Its buffer, for mode = \"buffered\".", MILLFORCE_KEY(buffer)},
    {"iio.drive", "current_channel", "\"voltage0\"", "Channel of the motor's current; not given: the current comes over the bus.", MILLFORCE_LOCAL(current_channel)},
    {"iio.drive", "count_file", "\"/sys/bus/counter/devices/counter0/count0/count\"", "Count of the encoder of spindle or axis; not given: the motion comes over the bus.", MILLFORCE_LOCAL(count_file)},
    {"override_voltage", "device", "\"/sys/bus/iio/devices/iio:device1\"", "Folder of the digital-to-analogue converter that gives the override as a voltage.", MILLFORCE_KEY(voltage_device)},
    {"override_voltage", "channel", "\"voltage0\"", "Its channel.", MILLFORCE_KEY(voltage_channel)},
    {"feed_hold_line", "chip", "\"/dev/gpiochip0\"", "Chip of the lines for feed release and life pulse.", MILLFORCE_KEY(chip)},
}};

const std::array<LocalValueRow, 22> local_values{{
    {"iio", "mode", "", 0.0, 1.0, "Every value from the buffer, sampled by the device's trigger; or one value per SYNC from in_…_raw.", MILLFORCE_VALUE(mode), may_be_left_out, "buffered|polled"},
    {"iio", "configures", "", 0.0, 1.0, "Switch on the buffer's elements and the buffer; else the system has done so.", MILLFORCE_VALUE(configures)},
    {"iio", "buffer_scans", "1", 2.0, 1048576.0, "Length of the buffer.", MILLFORCE_VALUE(buffer_scans)},
    {"iio", "sample_period_us", "µs", 0.0, 1e6, "Period of the device's samples, to detect gaps; 0: gaps are not detected.", MILLFORCE_VALUE(sample_period_us)},
    {"iio", "stale_ms", "ms", 1.0, 10000.0, "If no value comes for this long, the converter counts as silent.", MILLFORCE_VALUE(stale_ms)},

    {"iio.drive", "A_per_V", "A/V", -1e5, 1e5, "Motor current, rms, per volt at the converter; negative: the sensor counts against the motor.", MILLFORCE_LOCAL_VALUE(A_per_V), must_be_given},
    {"iio.drive", "zero_V", "V", -100.0, 100.0, "Voltage at 0 A.", MILLFORCE_LOCAL_VALUE(zero_V)},
    {"iio.drive", "largest_A", "A", 1e-3, 1e4, "A larger current is not used.", MILLFORCE_LOCAL_VALUE(largest_A)},
    {"iio.drive", "mm_per_count", "mm", -100.0, 100.0, "Axes: travel per count; negative: the count falls in + direction.", MILLFORCE_LOCAL_VALUE(mm_per_count)},
    {"iio.drive", "count_modulus", "1", 0.0, 4294967295.0, "Counts after which the counter starts again at 0, its `ceiling` plus 1; 0: 2³².", MILLFORCE_LOCAL_VALUE(count_modulus)},
    {"iio.drive", "largest_count_step", "1", 1.0, 1073741824.0, "A step of more counts per SYNC is not used.", MILLFORCE_LOCAL_VALUE(largest_count_step)},
    {"iio.drive", "count_reversed", "", 0.0, 1.0, "Spindle: the count falls in the cutting direction (M3).", MILLFORCE_LOCAL_VALUE(count_reversed)},

    {"override_voltage", "V_per_ratio", "V", -100.0, 100.0, "Voltage per override of 1 (100 %).", MILLFORCE_VALUE(V_per_ratio)},
    {"override_voltage", "zero_V", "V", -100.0, 100.0, "Voltage at an override of 0.", MILLFORCE_VALUE(voltage_zero_V)},
    {"override_voltage", "lowest_V", "V", -100.0, 100.0, "Lowest voltage for an override.", MILLFORCE_VALUE(lowest_V)},
    {"override_voltage", "highest_V", "V", -100.0, 100.0, "Highest voltage for an override.", MILLFORCE_VALUE(highest_V)},
    {"override_voltage", "safe_V", "V", -100.0, 100.0, "Voltage at which the CNC stops the feed: at hold, at any fault, without ticks.", MILLFORCE_VALUE(safe_V)},
    {"override_voltage", "lowest_raw", "1", -largest_raw, largest_raw, "Lowest value of the converter.", MILLFORCE_VALUE(lowest_raw)},
    {"override_voltage", "highest_raw", "1", -largest_raw, largest_raw, "Highest value of the converter.", MILLFORCE_VALUE(highest_raw)},

    {"feed_hold_line", "release_line", "", 0.0, 1023.0, "Offset on the chip of the line that releases the feed.", MILLFORCE_VALUE(release_line)},
    {"feed_hold_line", "pulse_line", "", 0.0, 1023.0, "Offset of the line that pulses at 100 Hz while ticks come.", MILLFORCE_VALUE(pulse_line)},
    {"feed_hold_line", "active_low", "", 0.0, 1.0, "Release is a low level.", MILLFORCE_VALUE(active_low)},
}};
// clang-format on

namespace {

using TableOf = std::function<TomlFile::Table&(const std::string& name)>;

std::vector<std::string> tables_of(std::string_view table) {
    if (table == "iio.drive") {
        return {local_drive_tables.begin(), local_drive_tables.end()};
    }
    return {std::string(table)};
}

/// What stands in the field already is the default.
template <typename Field>
void read_value(const LocalValueRow& row, TomlFile::Table& table, Field& field) {
    const std::optional<Field> fallback = row.is_required ? std::nullopt : std::optional(field);
    if constexpr (std::is_same_v<Field, bool>) {
        field = table.choice(row.key, {"false", "true"}, field ? 1 : 0) == 1;  // true, or in quotes
    } else if constexpr (std::is_enum_v<Field>) {
        field = static_cast<Field>(table.choice(row.key, words_of(row.choices), static_cast<std::size_t>(field)));
    } else if constexpr (std::is_integral_v<Field>) {
        field = static_cast<Field>(table.integer(row.key, static_cast<std::int64_t>(row.minimum),
                                                 static_cast<std::int64_t>(row.maximum), fallback));
    } else {
        field = table.number(row.key, row.minimum, row.maximum, fallback);
    }
}

void check_drive(const LocalIoKeys& keys, std::size_t drive, TomlFile::Table& table) {
    const LocalDriveKeys& local = keys.drives[drive];
    if (!table.exists()) {
        return;
    }
    if (!local.is_used()) {
        table.fail("current_channel", "is missing, expected a channel of the converter, e.g. \"voltage0\"");
    }
    if (keys.device.empty()) {
        table.fail("current_channel", "has no converter, expected [iio] device");
    }
    if (local.A_per_V == 0.0) {
        table.fail("A_per_V", "0, expected the current per volt");
    }
    if (drive > 0 && local.has_counter() && local.mm_per_count == 0.0) {
        table.fail("mm_per_count", "0, expected the travel per count with count_file");
    }
}

void check_devices(const LocalIoKeys& keys, const TableOf& table_of) {
    const bool has_channel =
        std::any_of(keys.drives.begin(), keys.drives.end(), [](const LocalDriveKeys& d) { return d.is_used(); });
    if (!keys.device.empty() && !has_channel) {
        table_of("iio").fail("device", "has no channel, expected [iio.spindle], [iio.x] … with current_channel");
    }
    if (has_channel && keys.mode == ConverterMode::buffered && keys.buffer.empty()) {
        table_of("iio").fail("buffer",
                             "is missing, expected its file, e.g. \"/dev/iio:device0\", or mode = \"polled\"");
    }
    TomlFile::Table& voltage = table_of("override_voltage");
    if (voltage.exists() && (keys.voltage_device.empty() || keys.voltage_channel.empty())) {
        voltage.fail(keys.voltage_device.empty() ? "device" : "channel", "is missing, expected both");
    }
    if (keys.has_voltage() && (keys.lowest_V >= keys.highest_V || keys.V_per_ratio == 0.0)) {
        voltage.fail("highest_V", "expected more than lowest_V, and V_per_ratio other than 0");
    }
    if (keys.has_voltage() && keys.lowest_raw >= keys.highest_raw) {
        voltage.fail("highest_raw", "expected more than lowest_raw");
    }
    TomlFile::Table& lines = table_of("feed_hold_line");
    if (lines.exists() && keys.chip.empty()) {
        lines.fail("chip", "is missing, expected e.g. \"/dev/gpiochip0\"");
    }
    if (keys.has_lines() && keys.release_line == keys.pulse_line) {
        lines.fail("pulse_line", "is the release's, expected another");
    }
}

}  // namespace

bool LocalIoKeys::has_inputs() const {
    return std::any_of(drives.begin(), drives.end(), [](const LocalDriveKeys& drive) { return drive.is_used(); });
}

LocalIoKeys read_local_io(const TableOf& table_of) {
    LocalIoKeys keys;
    for (const LocalTextRow& row : local_texts) {
        const auto tables = tables_of(row.table);
        for (std::size_t k = 0; k < tables.size(); ++k) {
            row.field(keys, k) = table_of(tables[k]).text(row.key, "");
        }
    }
    for (const LocalValueRow& row : local_values) {
        const auto tables = tables_of(row.table);
        for (std::size_t k = 0; k < tables.size(); ++k) {
            TomlFile::Table& table = table_of(tables[k]);
            if (table.exists()) {
                std::visit([&](auto* field) { read_value(row, table, *field); }, row.field(keys, k));
            }
        }
    }
    for (std::size_t drive = 0; drive < keys.drives.size(); ++drive) {
        check_drive(keys, drive, table_of(local_drive_tables[drive]));
    }
    check_devices(keys, table_of);
    return keys;
}

}  // namespace millforce::host
