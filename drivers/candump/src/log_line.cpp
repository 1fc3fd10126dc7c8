// SPDX-License-Identifier: Apache-2.0
#include "candump/log_line.hpp"

#include <algorithm>

namespace millforce::candump {

namespace {

constexpr std::uint32_t error_frame_flag = 0x2000'0000U;
constexpr std::uint32_t largest_extended_id = 0x1FFF'FFFFU;
constexpr std::uint64_t longest_time_s = 100'000'000'000ULL;
constexpr std::size_t longest_interface_name = 15;
constexpr unsigned longest_fd_data = 64;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    if (c >= 'A' && c <= 'F') {
        return c - 'A' + 10;
    }
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// A place in the line; past its end there is '\0'.
class Cursor {
  public:
    explicit Cursor(std::string_view text) : text_(text) {}

    [[nodiscard]] char at() const { return place_ < text_.size() ? text_[place_] : '\0'; }
    [[nodiscard]] bool is_at_end() const { return place_ >= text_.size(); }
    [[nodiscard]] std::size_t place() const { return place_; }
    [[nodiscard]] std::string_view since(std::size_t begin) const { return {text_.data() + begin, place_ - begin}; }
    bool take(char c) {
        const bool is_there = !is_at_end() && text_[place_] == c;
        place_ += is_there ? 1U : 0U;
        return is_there;
    }
    /// -1, without moving on, if the next character is not a hexadecimal digit.
    int take_hex() {
        const int digit = is_at_end() ? -1 : hex_digit(text_[place_]);
        place_ += digit >= 0 ? 1U : 0U;
        return digit;
    }
    bool skip_spaces() {
        const std::size_t begin = place_;
        while (!is_at_end() && is_space(text_[place_])) {
            ++place_;
        }
        return place_ > begin;
    }
    void skip_word() {
        while (!is_at_end() && !is_space(text_[place_])) {
            ++place_;
        }
    }

  private:
    std::string_view text_;
    std::size_t place_ = 0;
};

LogLine malformed(LineError error, const Cursor& cursor) {
    LogLine line;
    line.error = error;
    line.column = static_cast<std::uint32_t>(cursor.place() + 1);
    return line;
}

/// `(seconds.fraction)`, the fraction of any length; digits beyond µs are dropped.
bool read_time(Cursor& cursor, std::uint64_t& time_us) {
    std::uint64_t seconds = 0;
    if (!cursor.take('(') || cursor.at() < '0' || cursor.at() > '9') {
        return false;
    }
    while (cursor.at() >= '0' && cursor.at() <= '9' && seconds < longest_time_s) {
        seconds = 10 * seconds + static_cast<std::uint64_t>(cursor.take_hex());
    }
    std::uint64_t fraction_us = 0;
    if (cursor.take('.')) {
        std::uint64_t weight_us = 100'000;
        while (cursor.at() >= '0' && cursor.at() <= '9') {
            fraction_us += weight_us * static_cast<std::uint64_t>(cursor.take_hex());
            weight_us /= 10;
        }
    }
    time_us = seconds * 1'000'000 + fraction_us;
    return seconds < longest_time_s && cursor.take(')');
}

/// Three or eight digits up to the `#`.
bool read_id(Cursor& cursor, std::uint32_t& id, bool& has_eight_digits) {
    unsigned digits = 0;
    id = 0;
    while (digits < 8 && hex_digit(cursor.at()) >= 0) {
        id = (id << 4U) | static_cast<std::uint32_t>(cursor.take_hex());
        ++digits;
    }
    has_eight_digits = digits == 8;
    const std::uint32_t largest =
        has_eight_digits ? error_frame_flag | largest_extended_id : hal::largest_standard_can_id;
    return (digits == 3 || digits == 8) && id <= largest && cursor.at() == '#';
}

/// Pairs of digits, with or without dots between them; returns how many, or more than `capacity` if there are too many
/// or half a pair.
unsigned read_data(Cursor& cursor, unsigned capacity, hal::CanFrame& frame) {
    unsigned count = 0;
    for (;; ++count) {
        if (count > 0) {
            cursor.take('.');
        }
        const int high = cursor.take_hex();
        if (high < 0) {
            return count;
        }
        const int low = cursor.take_hex();
        if (low < 0 || count == capacity) {
            return capacity + 1;
        }
        if (count < frame.data.size()) {
            frame.data[count] = static_cast<std::uint8_t>(16 * high + low);
        }
    }
}

/// What follows the first `#` of a classical frame.
LineError read_classical(Cursor& cursor, hal::CanFrame& frame) {
    if (cursor.take('R')) {
        frame.remote = true;
        const int length = cursor.take_hex();
        frame.length = static_cast<std::uint8_t>(std::max(length, 0));
    } else {
        const unsigned count = read_data(cursor, hal::largest_can_length, frame);
        if (count > hal::largest_can_length) {
            return LineError::data;
        }
        frame.length = static_cast<std::uint8_t>(count);
    }
    const bool has_length_code = frame.length == hal::largest_can_length && cursor.take('_');
    if (frame.length > hal::largest_can_length || (has_length_code && cursor.take_hex() < 9)) {
        return LineError::length;
    }
    return LineError::none;
}

LineError read_fd(Cursor& cursor) {
    hal::CanFrame beginning;
    const bool has_flags = cursor.take_hex() >= 0;
    return has_flags && read_data(cursor, longest_fd_data, beginning) <= longest_fd_data ? LineError::none
                                                                                         : LineError::data;
}

LineError read_frame(Cursor& cursor, LogLine& line) {
    std::uint32_t id = 0;
    bool has_eight_digits = false;
    if (!read_id(cursor, id, has_eight_digits)) {
        return LineError::id;
    }
    cursor.take('#');
    const bool is_error_frame = (id & error_frame_flag) != 0;
    line.frame.id = id;
    line.frame.extended = has_eight_digits;
    if (cursor.take('#')) {
        line.kind = LineKind::fd_frame;
        return read_fd(cursor);
    }
    line.kind = is_error_frame ? LineKind::error_frame : LineKind::frame;
    return read_classical(cursor, line.frame);
}

/// After the frame: nothing, or the direction.
bool read_rest(Cursor& cursor) {
    if (cursor.skip_spaces() && !cursor.take('R')) {
        cursor.take('T');
    }
    cursor.skip_spaces();
    return cursor.is_at_end();
}

}  // namespace

LogLine read_line(std::string_view text) {
    Cursor cursor(text);
    LogLine line;
    if (text.size() > longest_line) {
        return malformed(LineError::too_long, cursor);
    }
    cursor.skip_spaces();
    if (cursor.is_at_end() || cursor.at() == '#') {
        line.kind = LineKind::blank;
        return line;
    }
    if (!read_time(cursor, line.time_us) || !cursor.skip_spaces()) {
        return malformed(LineError::time, cursor);
    }
    const std::size_t name = cursor.place();
    cursor.skip_word();
    line.interface = cursor.since(name);
    if (line.interface.empty() || line.interface.size() > longest_interface_name || !cursor.skip_spaces()) {
        return malformed(LineError::interface, cursor);
    }
    if (const LineError error = read_frame(cursor, line); error != LineError::none) {
        return malformed(error, cursor);
    }
    if (!read_rest(cursor)) {
        return malformed(LineError::rest, cursor);
    }
    line.frame = line.kind == LineKind::frame ? line.frame : hal::CanFrame{};
    return line;
}

std::string_view expectation(LineError error) {
    switch (error) {
        case LineError::none:
            return "";
        case LineError::too_long:
            return "expected a line of at most 256 characters";
        case LineError::time:
            return "expected the time in seconds, like (1436509052.249713)";
        case LineError::interface:
            return "expected the interface, like can0";
        case LineError::id:
            return "expected an id of three or eight hexadecimal digits and '#'";
        case LineError::data:
            return "expected pairs of hexadecimal digits, at most 8 (CAN FD: 64)";
        case LineError::length:
            return "expected a length of at most 8, or a length code of 9 to F";
        case LineError::rest:
            return "expected the end of the line, R or T";
    }
    return "";
}

}  // namespace millforce::candump
