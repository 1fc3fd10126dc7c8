// SPDX-License-Identifier: Apache-2.0
#include "report/json_writer.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/utf8.hpp"

namespace millforce::host {

namespace {

void append_ascii(std::string& out, char character) {
    switch (character) {
        case '"':
            out += "\\\"";
            return;
        case '\\':
            out += "\\\\";
            return;
        case '\n':
            out += "\\n";
            return;
        case '\t':
            out += "\\t";
            return;
        default:
            break;
    }
    const auto code = static_cast<unsigned char>(character);
    if (code < 0x20 || code == 0x7F || character == '<' || character == '>' || character == '&') {
        out += fmt::format("\\u{:04x}", static_cast<unsigned>(code));
    } else {
        out += character;
    }
}

std::string quoted(std::string_view text) {
    std::string out = "\"";
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const std::string_view sequence = text.substr(0, length);
        if (length == 0) {
            out += "\\ufffd";
        } else if (length == 1) {
            append_ascii(out, text.front());
        } else if (sequence == "\u2028") {
            out += "\\u2028";
        } else if (sequence == "\u2029") {
            out += "\\u2029";
        } else {
            out += sequence;
        }
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return out += '"';
}

}  // namespace

JsonWriter& JsonWriter::key(std::string_view name) {
    before_value();
    out_ += quoted(name);
    out_ += style_ == Style::indented ? ": " : ":";
    after_key_ = true;
    return *this;
}

JsonWriter& JsonWriter::text(std::string_view value) {
    return raw(quoted(value));
}

JsonWriter& JsonWriter::integer(std::int64_t value) {
    return raw(fmt::to_string(value));
}

JsonWriter& JsonWriter::unsigned_integer(std::uint64_t value) {
    return raw(fmt::to_string(value));
}

JsonWriter& JsonWriter::boolean(bool value) {
    return raw(value ? "true" : "false");
}

JsonWriter& JsonWriter::null() {
    return raw("null");
}

JsonWriter& JsonWriter::number(double value, int significant_digits) {
    return std::isfinite(value) ? raw(fmt::format("{:.{}g}", value, significant_digits)) : null();
}

JsonWriter& JsonWriter::decimal(double value, int places) {
    if (!std::isfinite(value)) {
        return null();
    }
    if (std::abs(value) >= 1e15) {
        return number(value);  // fixed notation of such a value is hundreds of digits that mean nothing
    }
    std::string digits = fmt::format("{:.{}f}", value, places);
    if (digits.find('.') != std::string::npos) {
        digits.erase(digits.find_last_not_of('0') + 1);
        if (digits.back() == '.') {
            digits.pop_back();
        }
    }
    return raw(digits == "-0" ? "0" : digits);
}

JsonWriter& JsonWriter::open(char bracket) {
    before_value();
    out_ += bracket;
    has_member_.push_back(false);
    return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
    const bool had_member = has_member_.back();
    has_member_.pop_back();
    if (had_member) {
        new_line();
    }
    out_ += bracket;
    return *this;
}

JsonWriter& JsonWriter::raw(std::string_view token) {
    before_value();
    out_ += token;
    return *this;
}

void JsonWriter::before_value() {
    if (after_key_) {
        after_key_ = false;
        return;
    }
    if (has_member_.empty()) {
        return;
    }
    if (has_member_.back()) {
        out_ += ',';
    }
    has_member_.back() = true;
    new_line();
}

void JsonWriter::new_line() {
    if (style_ == Style::indented) {
        out_ += '\n';
        out_.append(2 * has_member_.size(), ' ');
    }
}

}  // namespace millforce::host
