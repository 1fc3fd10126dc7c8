// SPDX-License-Identifier: Apache-2.0
#include "iio/scan_format.hpp"

#include <charconv>

namespace millforce::iio {

namespace {

constexpr std::uint8_t largest_repeat = 16;

bool take(std::string_view& text, std::string_view expected) {
    if (!text.starts_with(expected)) {
        return false;
    }
    text.remove_prefix(expected.size());
    return true;
}

bool take_number(std::string_view& text, std::uint8_t& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) {
        return false;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

bool is_possible(const ScanFormat& format) {
    const unsigned storage = format.storage_bits;
    return (storage == 8 || storage == 16 || storage == 32 || storage == 64) && format.bits > 0 &&
           unsigned{format.bits} + format.shift <= storage && format.repeat > 0 && format.repeat <= largest_repeat;
}

}  // namespace

std::optional<ScanFormat> parse_scan_format(std::string_view text) {
    ScanFormat format;
    format.is_big_endian = text.starts_with("be");
    if (!take(text, format.is_big_endian ? "be:" : "le:")) {
        return std::nullopt;
    }
    format.is_signed = text.starts_with('s');
    if (!take(text, format.is_signed ? "s" : "u") || !take_number(text, format.bits) || !take(text, "/") ||
        !take_number(text, format.storage_bits)) {
        return std::nullopt;
    }
    if (take(text, "X") && !take_number(text, format.repeat)) {
        return std::nullopt;
    }
    if (!take(text, ">>") || !take_number(text, format.shift) || !text.empty() || !is_possible(format)) {
        return std::nullopt;
    }
    return format;
}

std::int64_t decode(std::span<const std::uint8_t> data, const ScanFormat& format) {
    const std::size_t bytes = format.storage_bits / 8U;
    std::uint64_t stored = 0;
    for (std::size_t k = 0; k < bytes; ++k) {
        const std::size_t place = format.is_big_endian ? k : bytes - 1 - k;
        stored = (stored << 8U) | (place < data.size() ? data[place] : 0U);
    }
    const unsigned beyond = 64U - format.bits;
    const std::uint64_t on_top = (stored >> format.shift) << beyond;
    return format.is_signed ? static_cast<std::int64_t>(on_top) >> beyond : static_cast<std::int64_t>(on_top >> beyond);
}

bool is_at_rail(std::int64_t raw, const ScanFormat& format) {
    if (format.bits < 2 || format.bits > 62) {
        return false;
    }
    const std::int64_t span = std::int64_t{1} << format.bits;
    return format.is_signed ? raw == -span / 2 || raw == span / 2 - 1 : raw == 0 || raw == span - 1;
}

}  // namespace millforce::iio
