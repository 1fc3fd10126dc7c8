// SPDX-License-Identifier: Apache-2.0
#include "files/toml_limits.hpp"

#include "files/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace millforce::host {

namespace {

constexpr int most_key_parts = 16;
constexpr int deepest = 16;

/// Counts brackets, and dots between what separates keys, outside of strings and comments. Of a string in three quotes
/// the outer two pass for an empty string each, which counts the same.
class TomlDepth {
  public:
    explicit TomlDepth(std::string_view name) : name_(name) {}

    void add(char letter) {
        line_ += letter == '\n' ? 1 : 0;
        if (is_comment_ || quote_ != 0) {
            skip(letter);
        } else if (letter == '"' || letter == '\'') {
            quote_ = letter;
        } else if (letter == '#') {
            is_comment_ = true;
        } else {
            count(letter);
        }
    }

  private:
    void skip(char letter) {
        const bool is_escaped = quote_ == '"' && was_backslash_;
        was_backslash_ = letter == '\\' && !is_escaped;
        is_comment_ = is_comment_ && letter != '\n';
        quote_ = letter == quote_ && !is_escaped ? '\0' : quote_;
    }

    void count(char letter) {
        if (letter == '.') {
            ++parts_;
        } else if (letter == '=' || letter == ',' || letter == '\n') {
            parts_ = 1;
        } else if (letter == '[' || letter == '{') {
            ++depth_;
            parts_ = 1;
        } else if (letter == ']' || letter == '}') {
            depth_ = std::max(0, depth_ - 1);
        }
        if (parts_ > most_key_parts) {
            throw InputError(
                fmt::format("{}:{}: a key of more than {} parts, expected parameters", name_, line_, most_key_parts));
        }
        if (depth_ > deepest) {
            throw InputError(fmt::format("{}:{}: brackets deeper than {}, expected parameters", name_, line_, deepest));
        }
    }

    std::string_view name_;
    std::size_t line_ = 1;
    int parts_ = 1;
    int depth_ = 0;
    char quote_ = 0;
    bool is_comment_ = false;
    bool was_backslash_ = false;
};

}  // namespace

void check_toml_limits(std::string_view text, std::string_view name) {
    TomlDepth depth(name);
    for (const char letter : text) {
        depth.add(letter);
    }
}

}  // namespace millforce::host
