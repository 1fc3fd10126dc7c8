// SPDX-License-Identifier: Apache-2.0
#include "files/toml_writer.hpp"

#include <fmt/format.h>

#include <cmath>

namespace millforce::host {

std::string toml_number(double value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) {
        text += ".0";
    }
    return text;
}

std::string toml_string(std::string_view text) {
    std::string result = "\"";
    for (const char letter : text) {
        const auto code = static_cast<unsigned char>(letter);
        if (letter == '"' || letter == '\\') {
            result += '\\';
            result += letter;
        } else if (code < 0x20 || code == 0x7F) {
            result += fmt::format("\\u{:04X}", static_cast<unsigned>(code));
        } else {
            result += letter;
        }
    }
    return result + '"';
}

void TomlWriter::comment(std::string_view text) {
    out_ << "# ";
    for (const char letter : text) {
        // A comment cannot contain a control character; a file name can.
        out_ << (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7F ? '?' : letter);
    }
    out_ << '\n';
}

void TomlWriter::table(std::string_view name) {
    out_ << "\n[" << name << "]\n";
}

void TomlWriter::key(std::string_view name, double value, std::string_view comment) {
    if (std::isfinite(value)) {
        line(name, toml_number(value), comment);
    }
}

void TomlWriter::key(std::string_view name, std::string_view value, std::string_view comment) {
    line(name, toml_string(value), comment);
}

void TomlWriter::integer_key(std::string_view name, std::int64_t value) {
    line(name, fmt::to_string(value), {});
}

void TomlWriter::flag_key(std::string_view name, bool value) {
    line(name, value ? "true" : "false", {});
}

void TomlWriter::line(std::string_view name, const std::string& value, std::string_view comment) {
    out_ << name << " = " << value;
    if (!comment.empty()) {
        out_ << "  # " << comment;
    }
    out_ << '\n';
}

}  // namespace millforce::host
