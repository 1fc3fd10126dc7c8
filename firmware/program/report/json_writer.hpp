// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace millforce::host {

/// Writes JSON (RFC 8259) that is valid whatever the values are:
/// - a number that is NaN or infinite becomes null;
/// - strings are escaped, bytes that are not UTF-8 become U+FFFD;
/// - `<`, `>`, `&` and U+2028/2029 are escaped as \uXXXX, so that the text can be put inside a <script> element.
///
/// The caller keeps the order begin, key, value, end; commas and line breaks are the writer's. Cost: linear, one
/// growing string.
class JsonWriter {
  public:
    enum class Style : std::uint8_t { compact, indented };

    explicit JsonWriter(Style style = Style::compact) : style_(style) {}

    JsonWriter& begin_object() { return open('{'); }
    JsonWriter& end_object() { return close('}'); }
    JsonWriter& begin_array() { return open('['); }
    JsonWriter& end_array() { return close(']'); }

    JsonWriter& key(std::string_view name);
    JsonWriter& text(std::string_view value);
    JsonWriter& integer(std::int64_t value);
    JsonWriter& unsigned_integer(std::uint64_t value);
    JsonWriter& boolean(bool value);
    JsonWriter& null();
    /// Rounded to `significant_digits` (1…17).
    JsonWriter& number(double value, int significant_digits = 6);
    /// Rounded to a number of decimal places, without trailing zeros: the shortest form for a long column.
    JsonWriter& decimal(double value, int places);

    /// The document so far; complete once every begin has its end.
    const std::string& str() const { return out_; }

  private:
    JsonWriter& open(char bracket);
    JsonWriter& close(char bracket);
    JsonWriter& raw(std::string_view token);
    void before_value();
    void new_line();

    Style style_;
    std::string out_;
    std::vector<bool> has_member_;  ///< one entry per open bracket
    bool after_key_ = false;
};

}  // namespace millforce::host
