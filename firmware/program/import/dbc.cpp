// SPDX-License-Identifier: Apache-2.0
#include "import/dbc.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

#include "files/input_error.hpp"
#include "files/nearest_name.hpp"
#include "files/printable.hpp"
#include "import/text_cells.hpp"

namespace millforce::host {

namespace {

unsigned bit_of(const hal::CanFrame& frame, unsigned bit) {
    return (static_cast<unsigned>(frame.data[bit / 8]) >> (bit % 8)) & 1U;
}

/// Motorola counts down within a byte, then goes on at the top of the next: 15 is followed by 14 … 8, 23.
unsigned after_motorola_bit(unsigned bit) {
    return bit % 8 == 0 ? bit + 15 : bit - 1;
}

unsigned last_bit(const DbcSignal& signal) {
    if (!signal.is_motorola) {
        return signal.start_bit + signal.bits - 1;
    }
    unsigned bit = signal.start_bit;
    for (unsigned k = 1; k < signal.bits; ++k) {
        bit = after_motorola_bit(bit);
    }
    return bit;
}

unsigned bytes_needed(const DbcSignal& signal) {
    return last_bit(signal) / 8 + 1;
}

std::uint64_t raw_bits(const DbcSignal& signal, const hal::CanFrame& frame) {
    std::uint64_t raw = 0;
    unsigned bit = signal.start_bit;
    for (unsigned k = 0; k < signal.bits; ++k) {
        if (signal.is_motorola) {
            raw = (raw << 1U) | bit_of(frame, bit);
            bit = after_motorola_bit(bit);
        } else {
            raw |= static_cast<std::uint64_t>(bit_of(frame, bit)) << k;
            ++bit;
        }
    }
    return raw;
}

double value_of(const DbcSignal& signal, std::uint64_t raw) {
    if (signal.number == DbcSignal::Number::float_32) {
        return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
    }
    if (signal.number == DbcSignal::Number::float_64) {
        return std::bit_cast<double>(raw);
    }
    const bool is_negative = signal.is_signed && ((raw >> (signal.bits - 1)) & 1U) != 0;
    if (!is_negative) {
        return static_cast<double>(raw);
    }
    const std::uint64_t sign_bits = signal.bits < 64 ? ~std::uint64_t{0} << signal.bits : 0;
    return static_cast<double>(static_cast<std::int64_t>(raw | sign_bits));
}

std::string reason_against(const DbcSignal& signal) {
    if (signal.is_multiplexed) {
        return "is multiplexed, expected a signal that is in every frame of its message";
    }
    if (signal.message_bytes > hal::largest_can_length) {
        return fmt::format("is in a message of {} bytes, expected at most 8", signal.message_bytes);
    }
    if (bytes_needed(signal) > signal.message_bytes) {
        return fmt::format("goes up to byte {}, and its message has {}", bytes_needed(signal), signal.message_bytes);
    }
    const unsigned float_bits = signal.number == DbcSignal::Number::float_32 ? 32 : 64;
    if (signal.number != DbcSignal::Number::integer && signal.bits != float_bits) {
        return fmt::format("is a floating-point number of {} bits, expected {}", signal.bits, float_bits);
    }
    return {};
}

}  // namespace

double DbcSignal::decode(const hal::CanFrame& frame) const {
    const unsigned bytes = bytes_needed(*this);
    if (bytes > frame.length || bytes > frame.data.size()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const double value = factor * value_of(*this, raw_bits(*this, frame)) + offset;
    return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

const DbcSignal& Dbc::find(const std::string& name, const std::string& asked_by) const {
    const DbcSignal* found = nullptr;
    for (const DbcSignal& signal : signals_) {
        if (signal.name != name && signal.full_name() != name) {
            continue;
        }
        if (found != nullptr) {
            throw InputError(fmt::format("{}: signal '{}' is in {} and in {} of {}; expected MESSAGE.SIGNAL of one",
                                         asked_by, printable(name), printable(found->message),
                                         printable(signal.message), file_));
        }
        found = &signal;
    }
    if (found == nullptr) {
        std::vector<std::string> names;
        for (const DbcSignal& signal : signals_) {
            names.push_back(signal.name);
            names.push_back(signal.full_name());
        }
        const std::string nearest = nearest_name(name, names);
        throw InputError(fmt::format("{}: no signal '{}' in {}; {}", asked_by, printable(name), file_,
                                     nearest.empty() ? fmt::format("it has {}", name_list(names))
                                                     : fmt::format("the nearest is '{}'", printable(nearest))));
    }
    if (const std::string reason = reason_against(*found); !reason.empty()) {
        throw InputError(fmt::format("{}: signal '{}' of {} {}", asked_by, printable(name), file_, reason));
    }
    return *found;
}

}  // namespace millforce::host
