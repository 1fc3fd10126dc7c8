// SPDX-License-Identifier: Apache-2.0
#include "cnc/gcode_words.hpp"

#include <fmt/format.h>

#include <charconv>

#include "files/input_error.hpp"

namespace millforce::sim {

namespace {

constexpr std::size_t longest_number = 32;
constexpr std::size_t longest_quotation = 40;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}
bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
char upper(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string printable(std::string_view text) {
    std::string result;
    for (const char c : text.substr(0, longest_quotation)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7F) {
            result += c;
        } else {
            result += fmt::format("\\x{:02X}", byte);
        }
    }
    return text.size() > longest_quotation ? result + "..." : result;
}

/// Walks along one line; every function leaves the cursor behind what it read.
class LineReader {
  public:
    LineReader(std::string_view text, std::string_view file_name, std::size_t line)
        : text_(text), file_name_(file_name), line_(line) {}

    GcodeBlock read() {
        GcodeBlock block;
        block.line = line_;
        skip_blanks();
        if (at_end() || text_[cursor_] == '/') {
            return block;
        }
        if (text_[cursor_] == '%') {
            ++cursor_;
            skip_blanks();
            if (!at_end()) {
                fail_here(text_.substr(cursor_), "nothing after %");
            }
            block.is_percent = true;
            return block;
        }
        while (!at_end()) {
            block.words.push_back(read_word());
            skip_blanks();
        }
        return block;
    }

  private:
    bool at_end() const { return cursor_ >= text_.size(); }

    [[noreturn]] void fail_here(std::string_view found, std::string_view expected) const {
        reject({file_name_, line_, cursor_ + 1}, found, expected);
    }

    void skip_blanks() {
        while (!at_end()) {
            if (is_blank(text_[cursor_])) {
                ++cursor_;
            } else if (text_[cursor_] == ';') {
                cursor_ = text_.size();
            } else if (text_[cursor_] == '(') {
                skip_comment();
            } else {
                return;
            }
        }
    }

    void skip_comment() {
        const std::size_t close = text_.find(')', cursor_);
        if (close == std::string_view::npos) {
            fail_here(text_.substr(cursor_), "a comment closed with ')' on the same line");
        }
        const std::size_t nested = text_.find('(', cursor_ + 1);
        if (nested < close) {
            cursor_ = nested;
            fail_here(text_.substr(cursor_, 1), "')' before another '(': comments do not nest");
        }
        cursor_ = close + 1;
    }

    GcodeWord read_word() {
        const std::size_t begin = cursor_;
        if (!is_letter(text_[cursor_])) {
            fail_here(text_.substr(cursor_, 1), "a word: a letter followed by a number");
        }
        GcodeWord word;
        word.letter = upper(text_[cursor_]);
        word.column = begin + 1;
        ++cursor_;
        skip_blanks();
        word.value = read_number(begin);
        word.text = std::string(text_.substr(begin, cursor_ - begin));
        return word;
    }

    double read_number(std::size_t word_begin) {
        const std::size_t begin = cursor_;
        if (!at_end() && (text_[cursor_] == '+' || text_[cursor_] == '-')) {
            ++cursor_;
        }
        std::size_t digits = skip_digits();
        if (!at_end() && text_[cursor_] == '.') {
            ++cursor_;
            digits += skip_digits();
        }
        const std::string_view word = text_.substr(word_begin, cursor_ - word_begin);
        if (digits == 0) {
            reject({file_name_, line_, word_begin + 1}, text_.substr(word_begin, cursor_ + 1 - word_begin),
                   fmt::format("a decimal number after {}", upper(text_[word_begin])));
        }
        if (cursor_ - begin > longest_number) {
            reject({file_name_, line_, word_begin + 1}, word,
                   fmt::format("a number of at most {} characters", longest_number));
        }
        const std::size_t first = text_[begin] == '+' ? begin + 1 : begin;
        double value = 0.0;
        const auto [end, error] =
            std::from_chars(text_.data() + first, text_.data() + cursor_, value, std::chars_format::fixed);
        if (error != std::errc() || end != text_.data() + cursor_) {
            reject({file_name_, line_, word_begin + 1}, word, "a decimal number in the range of a double");
        }
        return value;
    }

    std::size_t skip_digits() {
        const std::size_t begin = cursor_;
        while (!at_end() && is_digit(text_[cursor_])) {
            ++cursor_;
        }
        return cursor_ - begin;
    }

    std::string_view text_;
    std::string_view file_name_;
    std::size_t line_;
    std::size_t cursor_ = 0;
};

}  // namespace

void reject(const GcodePlace& place, std::string_view found, std::string_view expected) {
    throw host::InputError(fmt::format("{}:{}:{}: found '{}', expected {}", place.file_name, place.line, place.column,
                                       printable(found), expected));
}

GcodeBlock split_block(std::string_view text, std::string_view file_name, std::size_t line) {
    return LineReader(text, file_name, line).read();
}

}  // namespace millforce::sim
