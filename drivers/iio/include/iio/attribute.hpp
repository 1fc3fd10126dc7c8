// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// Files of sysfs: one short value each. Their content is read as hostile. No heap.

namespace millforce::iio {

inline constexpr std::size_t path_capacity = 160;
inline constexpr std::size_t attribute_capacity = 64;

enum class IioError : std::uint8_t {
    none,
    path_too_long,     ///< more than 159 characters, or an empty path
    file_missing,      ///< no such file: the device is not there, or has no such channel
    file_unreadable,   ///< not allowed, a folder, in use by another, or failing
    file_unwritable,   ///< the same, for what is written at start
    not_a_number,      ///< empty, longer than 63 characters, not finite, or not a number
    scan_format,       ///< a `_type` that cannot be read, or that a channel cannot have
    scan_layout,       ///< two elements with one index, more than 16 of them, or more than 256 bytes
    channel_disabled,  ///< the channel's scan element is off, and `configures` is false
    clock,             ///< current_timestamp_clock names no clock of Linux
    settings,          ///< nothing is wired, or a factor is 0 or not finite
};
[[nodiscard]] std::string_view name_of(IioError error);

class Path {
  public:
    Path() = default;
    /// A path that does not fit is empty, and every use of it path_too_long.
    explicit Path(std::string_view text) { append(text); }

    Path& append(std::string_view text);
    [[nodiscard]] Path file(std::string_view name) const { return Path(*this).append("/").append(name); }
    [[nodiscard]] const char* c_str() const { return text_.data(); }
    [[nodiscard]] std::string_view view() const { return {text_.data(), size_}; }

  private:
    std::array<char, path_capacity> text_{};
    std::size_t size_ = 0;
    bool is_too_long_ = false;
};

/// What went wrong last, and with which file.
struct Fault {
    IioError error = IioError::none;
    int number = 0;  ///< errno, 0 where the content is at fault
    Path file{};
};

/// Content of a file without the white space at its end.
struct Attribute {
    IioError error = IioError::none;
    int number = 0;
    std::array<char, attribute_capacity> text{};
    std::size_t size = 0;

    [[nodiscard]] std::string_view view() const { return {text.data(), size}; }
};

[[nodiscard]] Attribute read_attribute(const Path& path);
/// Of a file that is open: from its begin, as sysfs wants it.
[[nodiscard]] Attribute read_attribute(int descriptor);
/// Each writes `value` only where it returns `none`.
[[nodiscard]] IioError parse(std::string_view text, float& value);
[[nodiscard]] IioError parse(std::string_view text, std::int64_t& value);
/// `number`: errno of a failure.
[[nodiscard]] IioError write_attribute(const Path& path, std::string_view text, int& number);
[[nodiscard]] IioError write_attribute(const Path& path, std::int64_t value, int& number);

/// Reads `<prefix><name><suffix>`, e.g. in_voltage0_scale, or, if that is missing, the one shared by channels of its
/// kind: in_voltage_scale. If both are missing `value` stays, and the answer is file_missing.
[[nodiscard]] Fault read_shared(const Path& device, std::string_view prefix, std::string_view name,
                                std::string_view suffix, float& value);

}  // namespace millforce::iio
