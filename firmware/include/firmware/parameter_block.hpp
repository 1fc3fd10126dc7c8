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
///   0       4      magic: "MFPB" one tool, "MFS1" tools by number
///   4       4      table_fingerprint
///   8       4      sequence number: the newer of two blocks is the one in force
///   12      4      length of what follows the header in bytes
///   16      4      CRC-32 of the values; of the machine's values where the tools have numbers
///   20      4      CRC-32 of the header up to here
///   24      4 n    the values as IEEE 754 float; a flag as 0 or 1, an enumeration as its index. PDO mappings, which
///                  are texts, are not in it
///
/// A block of tools by number has the machine's values there, then one to sixteen tools in the order of their numbers:
///
///   0       4      the number by which the CNC calls the tool, from 1 on
///   4       4      CRC-32 of the number and the values
///   8       4 n    the tool's values
///
/// A block that another version of the table has made is refused, not guessed at; so is one with a value out of its
/// range. The bytes may come from anywhere.

namespace millforce::firmware {

inline constexpr std::uint32_t block_magic = 0x4250'464DU;
inline constexpr std::uint32_t tools_block_magic = 0x3153'464DU;
inline constexpr std::size_t block_header_bytes = 24;

/// CRC-32 of the files, tables, keys and units of all parameters, in their order. A test works it out from the table
/// and names the new value after a change; no chip holds the names.
inline constexpr std::uint32_t table_fingerprint = 0xFA97'762FU;

enum class BlockError : std::uint8_t {
    none = 0,
    empty = 1,         ///< no magic: nothing was ever written, or its writing was cut off
    bad_header = 2,    ///< header CRC
    other_table = 3,   ///< made by another version of the parameter table
    bad_values = 4,    ///< length or a CRC of the values
    out_of_range = 5,  ///< a value outside of its range, or a fraction where an integer belongs
    bad_tools = 6,     ///< more than sixteen tools, or numbers that do not rise from 1 on
};

constexpr const char* name(BlockError error) {
    constexpr const char* names[] = {"none",
                                     "no block",
                                     "header CRC",
                                     "another version's parameter table",
                                     "length or CRC of the values",
                                     "value out of range",
                                     "more than 16 tools, or their numbers do not rise"};
    static_assert(std::size(names) == static_cast<std::size_t>(BlockError::bad_tools) + 1);
    return names[static_cast<std::size_t>(error) % std::size(names)];
}

inline constexpr std::size_t machine_value_bytes = 4 * machine_parameter_count;
inline constexpr std::size_t tool_value_bytes = 4 * tool_parameter_count;
inline constexpr std::size_t block_bytes = block_header_bytes + machine_value_bytes + tool_value_bytes;
using ParameterBlock = std::array<std::uint8_t, block_bytes>;

inline constexpr std::size_t largest_tool_count = 16;
inline constexpr std::size_t numbered_tool_bytes = 8 + tool_value_bytes;
inline constexpr std::size_t largest_block_bytes =
    block_header_bytes + machine_value_bytes + largest_tool_count * numbered_tool_bytes;
using LargestParameterBlock = std::array<std::uint8_t, largest_block_bytes>;

/// A tool under the number by which the CNC calls it.
struct NumberedTool {
    std::uint32_t number = 0;
    ToolParameters<float> parameters{};
};

/// The tools of a block by their numbers, read where they are: nothing is copied, and the block must stay. Thread-safe.
class BlockTools {
  public:
    BlockTools() = default;  ///< none
    /// Of a block whose lengths are right.
    explicit BlockTools(std::span<const std::uint8_t> tools) : tools_(tools) {}

    [[nodiscard]] std::size_t size() const { return tools_.size() / numbered_tool_bytes; }
    /// `place` < size().
    [[nodiscard]] std::uint32_t number_at(std::size_t place) const;
    /// False where the checksum is wrong.
    [[nodiscard]] bool is_whole_at(std::size_t place) const;
    /// False where a value is out of its range, or the checksum is wrong.
    [[nodiscard]] bool read_at(std::size_t place, ToolParameters<float>& tool) const;
    /// size() where there is no such tool.
    [[nodiscard]] std::size_t place_of(std::uint32_t number) const;

  private:
    [[nodiscard]] std::span<const std::uint8_t> tool_at(std::size_t place) const;

    std::span<const std::uint8_t> tools_{};
};

ParameterBlock encoded(const Parameters<float>& parameters, std::uint32_t sequence);

/// A block of tools by number; the returned span is the part of `block` that it takes. `tools`: one to sixteen, in the
/// order of their numbers.
std::span<const std::uint8_t> encode_tools(const MachineParameters<float>& machine, std::span<const NumberedTool> tools,
                                           std::uint32_t sequence, LargestParameterBlock& block);

/// All but the values: whether a block is whole and of this table. Reads no byte beyond `bytes`.
BlockError check_block(std::span<const std::uint8_t> bytes);

/// `block` must be whole.
std::uint32_t sequence_of(std::span<const std::uint8_t> block);
/// None in a block of one tool. `block` must be whole.
BlockTools tools_of(std::span<const std::uint8_t> block);

/// The parameters of a block, with its first tool where tools have numbers; untouched where it is refused. Every value
/// of every tool is checked.
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

    /// The newest block that is whole. Where there is none: why the first slot's is refused. `tools`: of this block, in
    /// the flash.
    BlockError load(Parameters<float>& parameters, BlockTools& tools) const {
        const unsigned newest = slot_in_force();
        const BlockError error = load_slot(newest, parameters, tools);
        if (error == BlockError::none) {
            return error;
        }
        return load_slot(other(newest), parameters, tools) == BlockError::none ? BlockError::none : error;
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

    BlockError load_slot(unsigned slot, Parameters<float>& parameters, BlockTools& tools) const {
        const BlockError error = decode(flash_.contents(slot), parameters);
        if (error == BlockError::none) {
            tools = tools_of(flash_.contents(slot));
        }
        return error;
    }

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
