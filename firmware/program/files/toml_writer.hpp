// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>

namespace millforce::host {

/// The shortest decimal text that reads back as the same number, always with a point or an exponent, so that TOML takes
/// it for a float: 1 → "1.0". Not for NaN or infinity.
std::string toml_number(double value);

/// A TOML basic string with its quotes, escaped.
std::string toml_string(std::string_view text);

/// Writes a flat TOML document: comments, tables, keys with values.
class TomlWriter {
  public:
    explicit TomlWriter(std::ostream& out) : out_(out) {}

    void comment(std::string_view text);
    void table(std::string_view name);
    /// key = value, with an optional comment behind it. A value that is not finite is left out: TOML files of this
    /// project have no NaN.
    void key(std::string_view name, double value, std::string_view comment = {});
    void key(std::string_view name, std::string_view value, std::string_view comment = {});
    void integer_key(std::string_view name, std::int64_t value);
    void flag_key(std::string_view name, bool value);

  private:
    void line(std::string_view name, const std::string& value, std::string_view comment);

    std::ostream& out_;
};

}  // namespace millforce::host
