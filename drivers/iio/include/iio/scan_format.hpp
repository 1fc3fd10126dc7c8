// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace millforce::iio {

/// How one element lies in a scan: the content of in_voltage0_type, `[be|le]:[s|u]bits/storage[Xrepeat]>>shift`
/// (Linux, Documentation/ABI/testing/sysfs-bus-iio), e.g. `le:s12/16>>4`: 12 bits with sign, in 16, four to the right.
struct ScanFormat {
    bool is_big_endian = false;
    bool is_signed = false;
    std::uint8_t bits = 0;          ///< 1…64
    std::uint8_t storage_bits = 0;  ///< 8, 16, 32 or 64
    std::uint8_t repeat = 1;        ///< values of this kind, 1…16
    std::uint8_t shift = 0;         ///< bits + shift ≤ storage_bits

    [[nodiscard]] std::uint32_t bytes() const { return storage_bits / 8U * repeat; }
    [[nodiscard]] bool operator==(const ScanFormat&) const = default;
};

[[nodiscard]] std::optional<ScanFormat> parse_scan_format(std::string_view text);

/// The first value. Missing bytes read as 0.
[[nodiscard]] std::int64_t decode(std::span<const std::uint8_t> data, const ScanFormat& format);

/// At the lowest or highest value that the bits can hold: the converter is beyond its range, or its input is broken.
[[nodiscard]] bool is_at_rail(std::int64_t raw, const ScanFormat& format);

}  // namespace millforce::iio
