// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "files/input_error.hpp"
#include "temporary_folder.hpp"

/// What the fuzz targets share. Each target defines LLVMFuzzerTestOneInput, which libFuzzer calls with bytes.

namespace millforce::fuzz {

using Input = std::span<const std::uint8_t>;

/// Ends the process where a claim does not hold; libFuzzer then keeps the input.
inline void require(bool holds, std::string_view claim) {
    if (!holds) {
        std::fprintf(stderr, "does not hold: %.*s\n", static_cast<int>(claim.size()), claim.data());
        std::abort();
    }
}

inline std::string_view text_of(Input input) {
    return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// A message for a terminal: one line, not endless, and nothing in it that a terminal obeys.
inline void require_printable(std::string_view message) {
    require(!message.empty() && message.size() < 2000, "a message of a readable length");
    for (const char letter : message) {
        const auto byte = static_cast<unsigned char>(letter);
        require(byte >= 0x20 && byte != 0x7F, "a message without control characters");
    }
}

/// Whether `read` takes the input; if not, it must refuse it with a message. Any other exception ends the process.
template <typename Read>
bool is_taken(Read read) {
    try {
        read();
        return true;
    } catch (const host::InputError& error) {
        require_printable(error.what());
        return false;
    }
}

/// Takes values from the input, one after the other; 0 where nothing is left.
class Bytes {
  public:
    explicit Bytes(Input input) : left_(input) {}

    [[nodiscard]] bool any_left() const { return !left_.empty(); }
    [[nodiscard]] Input take(std::size_t count) {
        const Input taken = left_.first(count < left_.size() ? count : left_.size());
        left_ = left_.subspan(taken.size());
        return taken;
    }
    std::uint8_t u8() {
        const Input taken = take(1);
        return taken.empty() ? std::uint8_t{0} : taken[0];
    }
    std::uint32_t u32() {
        std::uint32_t value = 0;
        const Input taken = take(4);
        if (!taken.empty()) {
            std::memcpy(&value, taken.data(), taken.size());
        }
        return value;
    }

  private:
    Input left_;
};

/// Files for what reads files; gone at the end of the process.
inline const test::TemporaryFolder& folder() {
    static const test::TemporaryFolder the_folder;
    return the_folder;
}

}  // namespace millforce::fuzz
