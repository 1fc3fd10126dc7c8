// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string_view>

namespace millforce::host {

/// Whether a text is one JSON value and nothing else (RFC 8259). Numbers must be finite by their grammar; strings may
/// not hold raw control characters. Depth is limited by the stack.
class JsonCheck {
  public:
    static bool valid(std::string_view text) {
        JsonCheck check(text);
        return check.value() && (check.skip_blanks(), check.rest_.empty());
    }

  private:
    explicit JsonCheck(std::string_view text) : rest_(text) {}

    void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size())); }

    bool take(std::string_view token) {
        if (!rest_.starts_with(token)) {
            return false;
        }
        rest_.remove_prefix(token.size());
        return true;
    }

    bool value() {
        skip_blanks();
        if (take("{")) {
            return members("}", true);
        }
        if (take("[")) {
            return members("]", false);
        }
        return rest_.starts_with('"') ? string() : take("true") || take("false") || take("null") || number();
    }

    bool members(std::string_view end, bool with_keys) {
        skip_blanks();
        if (take(end)) {
            return true;
        }
        do {
            skip_blanks();
            if (with_keys && !(string() && (skip_blanks(), take(":")))) {
                return false;
            }
            if (!value()) {
                return false;
            }
            skip_blanks();
        } while (take(","));
        return take(end);
    }

    bool string() {
        if (!take("\"")) {
            return false;
        }
        while (!rest_.empty() && rest_.front() != '"') {
            const auto code = static_cast<unsigned char>(rest_.front());
            if (code < 0x20 || (code == '\\' && !escape())) {
                return false;
            }
            rest_.remove_prefix(1);
        }
        return take("\"");
    }

    /// At a backslash: leaves the last character of the escape sequence to be taken.
    bool escape() {
        rest_.remove_prefix(1);
        if (rest_.empty()) {
            return false;
        }
        if (rest_.front() != 'u') {
            return std::string_view("\"\\/bfnrt").find(rest_.front()) != std::string_view::npos;
        }
        for (int digit = 0; digit < 4; ++digit) {
            rest_.remove_prefix(1);
            if (rest_.empty() || std::isxdigit(static_cast<unsigned char>(rest_.front())) == 0) {
                return false;
            }
        }
        return true;
    }

    bool digits() {
        const std::size_t count = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
        rest_.remove_prefix(count);
        return count > 0;
    }

    bool number() {
        take("-");
        if (!take("0") && !digits()) {
            return false;
        }
        if (take(".") && !digits()) {
            return false;
        }
        if (take("e") || take("E")) {
            if (!take("+")) {
                take("-");
            }
            return digits();
        }
        return true;
    }

    std::string_view rest_;
};

}  // namespace millforce::host
