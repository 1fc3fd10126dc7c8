// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <tuple>

#include "files/input_error.hpp"
#include "files/printable.hpp"
#include "files/text_lines.hpp"
#include "import/dbc.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

constexpr std::uint32_t extended_flag = 0x8000'0000U;  // of an id in a DBC file
constexpr std::uint32_t largest_extended_dbc_id = 0x1FFF'FFFFU;
constexpr unsigned largest_message_bytes = 4096;
constexpr std::size_t largest_dbc_bytes = std::size_t{16} << 20U;

bool is_name_letter(char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
           letter == '_';
}

}  // namespace

/// One line of the file, taken from its begin; whatever does not fit throws.
class DbcLine {
  public:
    DbcLine(std::string_view text, std::string place) : text_(text), rest_(text), place_(std::move(place)) {}

    [[noreturn]] void fail(std::string_view expected) const {
        const std::size_t column = text_.size() - rest_.size() + 1;
        throw InputError(fmt::format("{}:{}: '{}', expected {}", place_, column, printable(rest_), expected));
    }

    void skip_spaces() {
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) {
            rest_.remove_prefix(1);
        }
    }
    [[nodiscard]] bool take(char letter) {
        skip_spaces();
        const bool is_there = rest_.starts_with(letter);
        rest_.remove_prefix(is_there ? 1 : 0);
        return is_there;
    }
    void require(char letter) {
        if (!take(letter)) {
            fail(fmt::format("'{}'", letter));
        }
    }
    [[nodiscard]] std::string_view take_name() {
        skip_spaces();
        std::size_t length = 0;
        while (length < rest_.size() && is_name_letter(rest_[length])) {
            ++length;
        }
        const std::string_view name = rest_.substr(0, length);
        rest_.remove_prefix(length);
        return name;
    }
    [[nodiscard]] std::string_view require_name() {
        const std::string_view name = take_name();
        if (name.empty() || (name.front() >= '0' && name.front() <= '9')) {
            fail("a name");
        }
        return name;
    }
    [[nodiscard]] std::uint32_t require_integer(std::uint32_t largest) {
        skip_spaces();
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (error != std::errc{} || value > largest) {
            fail(fmt::format("an integer from 0 to {}", largest));
        }
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return value;
    }
    [[nodiscard]] double require_number() {
        skip_spaces();
        const std::size_t plus = rest_.starts_with('+') ? 1 : 0;
        double value = 0.0;
        const auto [end, error] = std::from_chars(rest_.data() + plus, rest_.data() + rest_.size(), value);
        if (error != std::errc{} || !std::isfinite(value)) {
            fail("a number");
        }
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return value;
    }
    [[nodiscard]] std::string_view require_text() {
        require('"');
        const std::size_t end = rest_.find('"');
        if (end == std::string_view::npos) {
            fail("a text in quotes on one line");
        }
        const std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return text;
    }
    [[nodiscard]] std::string_view rest() const { return rest_; }

  private:
    std::string_view text_;
    std::string_view rest_;
    std::string place_;
};

class DbcParser {
  public:
    explicit DbcParser(std::string name) { dbc_.file_ = std::move(name); }

    void take_line(std::string_view text, std::size_t number) {
        DbcLine line(text, fmt::format("{}:{}", dbc_.file_, number));
        if (is_in_text_) {
            follow_quotes(text);
            return;
        }
        const std::string_view keyword = line.take_name();
        const bool has_more = !without_spaces(line.rest()).empty();
        if (keyword == "BO_" && has_more) {
            take_message(line);
        } else if (keyword == "SG_" && has_more) {
            take_signal(line);
        } else if (keyword == "SIG_VALTYPE_" && has_more) {
            take_number_type(line);
        } else {
            follow_quotes(text);
        }
    }
    [[nodiscard]] Dbc result() {
        for (DbcSignal& signal : dbc_.signals_) {
            const auto type = number_types_.find({signal.id, signal.extended, signal.name});
            signal.number = type != number_types_.end() ? type->second : signal.number;
        }
        return std::move(dbc_);
    }

  private:
    /// A text that is opened and not closed goes on in the next line: it could look like a signal.
    void follow_quotes(std::string_view text) {
        const bool is_odd = std::count(text.begin(), text.end(), '"') % 2 != 0;
        is_in_text_ = is_in_text_ != is_odd;
    }

    void take_id(DbcLine& line, DbcSignal& signal) {
        const std::uint32_t id = line.require_integer(0xFFFF'FFFFU);
        signal.extended = (id & extended_flag) != 0;
        signal.id = id & ~extended_flag;
    }

    /// BO_ 385 SpindlePdo1: 8 SpindleDrive
    void take_message(DbcLine& line) {
        message_ = {};
        take_id(line, message_);
        message_.message = line.require_name();
        line.require(':');
        message_.message_bytes = line.require_integer(largest_message_bytes);
        has_message_ = true;
        // A message of that kind holds signals that belong to none.
        is_real_message_ = message_.id <= (message_.extended ? largest_extended_dbc_id : hal::largest_standard_can_id);
    }

    ///  SG_ SpindleCurrent m3 : 32|16@1- (0.001,0) [-32.768|32.767] "of rated current" Millforce
    void take_signal(DbcLine& line) {
        if (!has_message_) {
            line.fail("a message (BO_) before it");
        }
        DbcSignal signal = message_;
        signal.name = line.require_name();
        if (!line.take(':')) {
            const std::string_view multiplexing = line.require_name();
            signal.is_multiplexed = multiplexing != "M";
            if (multiplexing != "M" && multiplexing.front() != 'm') {
                line.fail("'M', or 'm' and a number");
            }
            line.require(':');
        }
        signal.start_bit = line.require_integer(8 * largest_message_bytes);
        line.require('|');
        signal.bits = line.require_integer(64);
        line.require('@');
        signal.is_motorola = line.require_integer(1) == 0;
        signal.is_signed = line.take('-');
        if (!signal.is_signed) {
            line.require('+');
        }
        take_scale(line, signal);
        if (signal.bits == 0) {
            line.fail("a signal of at least one bit");
        }
        if (is_real_message_) {
            dbc_.signals_.push_back(signal);
        }
    }

    void take_scale(DbcLine& line, DbcSignal& signal) {
        line.require('(');
        signal.factor = line.require_number();
        line.require(',');
        signal.offset = line.require_number();
        line.require(')');
        line.require('[');
        static_cast<void>(line.require_number());
        line.require('|');
        static_cast<void>(line.require_number());
        line.require(']');
        signal.unit = line.require_text();
    }

    /// SIG_VALTYPE_ 9 PositionEstimate : 1;
    void take_number_type(DbcLine& line) {
        DbcSignal message;
        take_id(line, message);
        const std::string name(line.require_name());
        static_cast<void>(line.take(':'));
        const std::uint32_t type = line.require_integer(3);
        number_types_[{message.id, message.extended, name}] = type == 0   ? DbcSignal::Number::integer
                                                              : type == 1 ? DbcSignal::Number::float_32
                                                                          : DbcSignal::Number::float_64;
    }

    Dbc dbc_;
    std::map<std::tuple<std::uint32_t, bool, std::string>, DbcSignal::Number> number_types_;
    DbcSignal message_;  ///< what a message's signals have in common
    bool has_message_ = false;
    bool is_real_message_ = false;
    bool is_in_text_ = false;
};

Dbc Dbc::from_text(const std::string& text, const std::string& name) {
    if (text.size() > largest_dbc_bytes) {
        throw InputError(fmt::format("{}: larger than 16 MiB, expected a DBC file", name));
    }
    DbcParser parser(name);
    std::size_t number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::string_view line = std::string_view(text).substr(begin, end - begin);
        if (line.ends_with('\r')) {
            line.remove_suffix(1);
        }
        parser.take_line(line, ++number);
        begin = end + 1;
    }
    Dbc dbc = parser.result();
    if (dbc.signals_.empty()) {
        throw InputError(fmt::format("{}: no signals (SG_), expected a DBC file", name));
    }
    return dbc;
}

Dbc Dbc::open(const std::string& file) {
    std::ifstream in = open_to_read(file);
    std::string text(largest_dbc_bytes + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    return from_text(text, file);
}

}  // namespace millforce::host
