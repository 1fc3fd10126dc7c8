// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "firmware/parameter_fields.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

/// The parameters as a block of bytes, for a target's flash, in the order of for_each_parameter:
///
///   offset  bytes  content, little-endian
///   0       4      magic "MFPB"
///   4       4      table_fingerprint
///   8       4      sequence number: the newer of two blocks is the one in force
///   12      4      length of the values in bytes
///   16      4      CRC-32 of the values
///   20      4      CRC-32 of the header up to here
///   24      4 n    the values as IEEE 754 float; a flag as 0 or 1, an enumeration as its index. PDO mappings, which
///                  are texts, are not in it
///
/// A block that another version of the table has made is refused, not guessed at; so is one with a value out of its
/// range. The bytes may come from anywhere.

namespace millforce::firmware {

inline constexpr std::uint32_t block_magic = 0x4250'464DU;
inline constexpr std::size_t block_header_bytes = 24;

/// CRC-32 of the files, tables, keys and units of all parameters, in their order. A test works it out from the table
/// and names the new value after a change; no chip holds the names.
inline constexpr std::uint32_t table_fingerprint = 0xBEA1'7C0FU;

enum class BlockError : std::uint8_t {
    none = 0,
    empty = 1,         ///< no magic: nothing was ever written, or its writing was cut off
    bad_header = 2,    ///< header CRC
    other_table = 3,   ///< made by another version of the parameter table
    bad_values = 4,    ///< length or CRC of the values
    out_of_range = 5,  ///< a value outside of its range, or a fraction where an integer belongs
};

constexpr const char* name(BlockError error) {
    constexpr const char* names[] = {
        "none", "no block", "header CRC", "another version's parameter table", "value CRC", "value out of range"};
    static_assert(std::size(names) == static_cast<std::size_t>(BlockError::out_of_range) + 1);
    return names[static_cast<std::size_t>(error) % std::size(names)];
}

inline constexpr std::size_t block_bytes = block_header_bytes + 4 * parameter_count;
using ParameterBlock = std::array<std::uint8_t, block_bytes>;

ParameterBlock encoded(const Parameters<float>& parameters, std::uint32_t sequence);

/// Header and CRCs alone: whether a block is whole and of this table. Reads no byte beyond `bytes`.
BlockError check_block(std::span<const std::uint8_t> bytes);

/// `block` must be whole.
std::uint32_t sequence_of(std::span<const std::uint8_t> block);

/// The parameters of a block; untouched where it is refused.
BlockError decode(std::span<const std::uint8_t> bytes, Parameters<float>& parameters);

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
    BlockError load(Parameters<float>& parameters) const {
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
