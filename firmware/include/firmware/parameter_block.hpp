// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/crc32.hpp"
#include "firmware/parameter_table.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

/// The parameters as a block of bytes, for a target's flash: made from the parameter table, in its order, so that there
/// is no second list of names to keep in step.
///
///   offset  bytes  content, little-endian
///   0       4      magic "MFPB"
///   4       4      fingerprint of the parameter table: CRC-32 of its files, tables, keys and units
///   8       4      sequence number: the newer of two blocks is the one in force
///   12      4      length of the values in bytes
///   16      4      CRC-32 of the values
///   20      4      CRC-32 of the header up to here
///   24      4 n    the values as IEEE 754 float; a row of the table "axis" three times, for x, y, z,
///                and one of "bus.drive" four times. PDO mappings, which are texts, are not in it
///
/// A block that another version of the table has made is refused, not guessed at; so is one with a value out of its
/// range. The bytes may come from anywhere.

namespace millforce::firmware {

inline constexpr std::uint32_t block_magic = 0x4250'464DU;
inline constexpr std::size_t block_header_bytes = 24;

enum class BlockError : std::uint8_t {
    none = 0,
    empty = 1,         ///< no magic: nothing was ever written, or its writing was cut off
    bad_header = 2,    ///< header CRC
    other_table = 3,   ///< made by another version of the parameter table
    bad_values = 4,    ///< length or CRC of the values
    out_of_range = 5,  ///< a value outside of the range that the table states
};

constexpr const char* name(BlockError error) {
    constexpr const char* names[] = {
        "none", "no block", "header CRC", "another version's parameter table", "value CRC", "value out of range"};
    return names[static_cast<unsigned>(error) % 6U];
}

namespace detail {

constexpr bool are_equal(const char* a, const char* b) {
    while (*a != '\0' && *a == *b) {
        ++a;
        ++b;
    }
    return *a == *b;
}

/// With the zero behind it, so that "ab" "c" and "a" "bc" differ.
constexpr std::uint32_t crc_of_text(std::uint32_t crc, const char* text) {
    for (;; ++text) {
        const std::array<std::uint8_t, 1> letter{static_cast<std::uint8_t>(*text)};
        crc = crc32(crc, letter);
        if (*text == '\0') {
            return crc;
        }
    }
}

inline void put(std::span<std::uint8_t> bytes, std::size_t offset, std::uint32_t value) {
    for (unsigned k = 0; k < 4U; ++k) {
        bytes[offset + k] = static_cast<std::uint8_t>(value >> (8U * k));
    }
}
inline std::uint32_t get(std::span<const std::uint8_t> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (unsigned k = 0; k < 4U; ++k) {
        value |= static_cast<std::uint32_t>(bytes[offset + k]) << (8U * k);
    }
    return value;
}

}  // namespace detail

/// How many tables of a file a table of the parameter table stands for.
constexpr std::size_t axes_of(const char* table) {
    if (detail::are_equal(table, "axis")) {
        return axis_tables.size();
    }
    return detail::are_equal(table, "bus.drive") ? drive_tables.size() : 1;
}

/// Values in a block.
inline constexpr std::size_t block_values = [] {
    std::size_t count = 0;
    for (const auto& row : parameter_table<float>) {
        count += axes_of(row.table);
    }
    return count;
}();
inline constexpr std::size_t block_bytes = block_header_bytes + 4 * block_values;
using ParameterBlock = std::array<std::uint8_t, block_bytes>;

/// Changes where a key, its unit, its place or its order changes.
inline constexpr std::uint32_t table_fingerprint = [] {
    std::uint32_t crc = 0;
    for (const auto& row : parameter_table<float>) {
        const std::array<std::uint8_t, 1> file{static_cast<std::uint8_t>(row.file)};
        crc = crc32(crc, file);
        for (const char* text : {row.table, row.key, row.unit}) {
            crc = detail::crc_of_text(crc, text);
        }
    }
    return crc;
}();

// NOLINTNEXTLINE(performance-unnecessary-value-param): a row's field is a reference into parameters that may change
inline ParameterBlock encoded(Parameters<float> parameters, std::uint32_t sequence) {
    ParameterBlock block{};
    std::size_t offset = block_header_bytes;
    for (const auto& row : parameter_table<float>) {
        for (std::size_t axis = 0; axis < axes_of(row.table); ++axis) {
            detail::put(block, offset, std::bit_cast<std::uint32_t>(row.field(parameters, axis)));
            offset += 4;
        }
    }
    const std::span<const std::uint8_t> bytes(block);
    detail::put(block, 0, block_magic);
    detail::put(block, 4, table_fingerprint);
    detail::put(block, 8, sequence);
    detail::put(block, 12, static_cast<std::uint32_t>(4 * block_values));
    detail::put(block, 16, crc32(0, bytes.subspan(block_header_bytes)));
    detail::put(block, 20, crc32(0, bytes.first(20)));
    return block;
}

/// Header and CRCs alone: whether a block is whole and of this table. Reads no byte beyond `bytes`.
inline BlockError check_block(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < block_bytes || detail::get(bytes, 0) != block_magic) {
        return BlockError::empty;
    }
    if (detail::get(bytes, 20) != crc32(0, bytes.first(20))) {
        return BlockError::bad_header;
    }
    if (detail::get(bytes, 4) != table_fingerprint) {
        return BlockError::other_table;
    }
    const bool is_whole = detail::get(bytes, 12) == 4 * block_values &&
                          detail::get(bytes, 16) == crc32(0, bytes.subspan(block_header_bytes, 4 * block_values));
    return is_whole ? BlockError::none : BlockError::bad_values;
}

inline std::uint32_t sequence_of(std::span<const std::uint8_t> block) {
    return detail::get(block, 8);
}

/// What reading a block needs of the table's rows: without their texts, 16 KiB that no chip needs.
template <typename Scalar>
struct BlockRow {
    float minimum = 0.0F;
    float maximum = 0.0F;
    std::size_t axes = 0;
    Scalar& (*field)(Parameters<Scalar>&, std::size_t axis) = nullptr;
};
template <typename Scalar>
inline constexpr auto block_rows = [] {
    std::array<BlockRow<Scalar>, parameter_table<Scalar>.size()> rows{};
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const ParameterRow<Scalar>& row = parameter_table<Scalar>[k];
        rows[k] = {row.minimum, row.maximum, axes_of(row.table), row.field};
    }
    return rows;
}();

/// The parameters of a block; untouched where it is refused.
template <typename Scalar>
BlockError decode(std::span<const std::uint8_t> bytes, Parameters<Scalar>& parameters) {
    const BlockError error = check_block(bytes);
    if (error != BlockError::none) {
        return error;
    }
    Parameters<Scalar> read;
    std::size_t offset = block_header_bytes;
    for (const BlockRow<Scalar>& row : block_rows<Scalar>) {
        for (std::size_t axis = 0; axis < row.axes; ++axis) {
            const float value = std::bit_cast<float>(detail::get(bytes, offset));
            offset += 4;
            if (!(value >= row.minimum && value <= row.maximum)) {
                return BlockError::out_of_range;
            }
            row.field(read, axis) = Scalar(value);
        }
    }
    parameters = read;
    return BlockError::none;
}

/// Two slots of a flash. A new block goes to the slot that is not in force, its header last: a power cut at any byte
/// leaves the other one whole.
///
/// Flash: `bool erase(unsigned slot)`; `bool program(unsigned slot, std::size_t offset, std::span<const
/// std::uint8_t>)`; `std::span<const std::uint8_t> contents(unsigned slot)`. Not thread-safe; never while the tick
/// runs.
template <typename Flash>
class ParameterStore {
  public:
    explicit ParameterStore(Flash& flash) : flash_(flash) {}

    /// The newest block that is whole. Where there is none: why the first slot's is refused.
    template <typename Scalar>
    BlockError load(Parameters<Scalar>& parameters) const {
        const unsigned newest = slot_in_force();
        const BlockError error = decode(flash_.contents(newest), parameters);
        if (error == BlockError::none) {
            return error;
        }
        return decode(flash_.contents(other(newest)), parameters) == BlockError::none ? BlockError::none : error;
    }

    /// False where the flash refused; the block in force is still the old one then.
    bool save(const Parameters<float>& parameters) {
        const unsigned newest = slot_in_force();
        const bool has_block = is_whole(newest);
        const unsigned slot = has_block ? other(newest) : newest;
        const std::uint32_t sequence = has_block ? sequence_of(flash_.contents(newest)) + 1U : 1U;
        const ParameterBlock block = encoded(parameters, sequence);
        const std::span<const std::uint8_t> bytes(block);
        return flash_.erase(slot) && flash_.program(slot, block_header_bytes, bytes.subspan(block_header_bytes)) &&
               flash_.program(slot, 0, bytes.first(block_header_bytes)) && is_whole(slot);
    }

  private:
    static unsigned other(unsigned slot) { return slot == 0U ? 1U : 0U; }
    [[nodiscard]] bool is_whole(unsigned slot) const { return check_block(flash_.contents(slot)) == BlockError::none; }

    [[nodiscard]] unsigned slot_in_force() const {
        if (!is_whole(0) || !is_whole(1)) {
            return is_whole(1) ? 1U : 0U;
        }
        // Sequence numbers wrap: only their difference counts.
        const std::uint32_t ahead = sequence_of(flash_.contents(1)) - sequence_of(flash_.contents(0));
        return ahead != 0U && ahead < 0x8000'0000U ? 1U : 0U;
    }

    Flash& flash_;
};

}  // namespace millforce::firmware
