// SPDX-License-Identifier: Apache-2.0
#include "firmware/parameter_block.hpp"
#include "firmware/crc32.hpp"
#include "firmware/parameters_in.hpp"

#include <bit>
#include <type_traits>

namespace millforce::firmware {

namespace {

void put(std::span<std::uint8_t> bytes, std::size_t offset, std::uint32_t value) {
    for (unsigned k = 0; k < 4U; ++k) {
        bytes[offset + k] = static_cast<std::uint8_t>(value >> (8U * k));
    }
}

std::uint32_t get(std::span<const std::uint8_t> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (unsigned k = 0; k < 4U; ++k) {
        value |= static_cast<std::uint32_t>(bytes[offset + k]) << (8U * k);
    }
    return value;
}

/// Takes the values of a block one by one: a visitor of the parameters.
class ValueReader {
  public:
    explicit ValueReader(std::span<const std::uint8_t> values) : values_(values) {}

    [[nodiscard]] bool all_in_range() const { return all_in_range_; }

    template <typename Field>
    void operator()(const ParameterName& /*name*/, Field& field, float minimum, float maximum) {
        const float value = next();
        const bool is_in_range = value >= minimum && value <= maximum;  // not so NaN
        if (is_in_range && (std::is_floating_point_v<Field> || is_whole(value))) {
            field = field_of<Field>(value);
        } else {
            all_in_range_ = false;
        }
    }

  private:
    float next() {
        const auto value = std::bit_cast<float>(get(values_, 0));
        values_ = values_.subspan(4);
        return value;
    }
    static bool is_whole(float value) { return static_cast<float>(static_cast<std::uint32_t>(value)) == value; }

    std::span<const std::uint8_t> values_;
    bool all_in_range_ = true;
};

/// The machine's values, or a tool's, if all are in their ranges; else some of them. `values` are as many.
bool read_machine(std::span<const std::uint8_t> values, MachineParameters<float>& machine) {
    ValueReader reader(values);
    for_each_machine_parameter(machine, reader);
    return reader.all_in_range();
}

bool read_tool(std::span<const std::uint8_t> values, ToolParameters<float>& tool) {
    ValueReader reader(values);
    for_each_tool_parameter(tool, reader);
    return reader.all_in_range();
}

bool has_numbers(std::span<const std::uint8_t> block) {
    return get(block, 0) == tools_block_magic;
}

/// What follows the header. `block` is as long as it says.
std::span<const std::uint8_t> body_of(std::span<const std::uint8_t> block) {
    return block.subspan(block_header_bytes, get(block, 12));
}

BlockError check_one_tool(std::span<const std::uint8_t> body, std::uint32_t checksum) {
    const bool is_whole = body.size() == machine_value_bytes + tool_value_bytes && crc32(0, body) == checksum;
    return is_whole ? BlockError::none : BlockError::bad_values;
}

BlockError check_tools(std::span<const std::uint8_t> body, std::uint32_t checksum_of_machine) {
    const bool is_whole = body.size() > machine_value_bytes &&
                          (body.size() - machine_value_bytes) % numbered_tool_bytes == 0 &&
                          crc32(0, body.first(machine_value_bytes)) == checksum_of_machine;
    if (!is_whole) {
        return BlockError::bad_values;
    }
    const BlockTools tools(body.subspan(machine_value_bytes));
    if (tools.size() > largest_tool_count) {
        return BlockError::bad_tools;
    }
    std::uint32_t last = 0;
    for (std::size_t place = 0; place < tools.size(); ++place) {
        if (!tools.is_whole_at(place)) {
            return BlockError::bad_values;
        }
        if (tools.number_at(place) <= last) {
            return BlockError::bad_tools;
        }
        last = tools.number_at(place);
    }
    return BlockError::none;
}

void put_values(std::span<std::uint8_t> bytes, std::span<const float> values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
        put(bytes, 4 * k, std::bit_cast<std::uint32_t>(values[k]));
    }
}

void put_header(std::span<std::uint8_t> block, std::uint32_t magic, std::uint32_t sequence, std::uint32_t checksum) {
    put(block, 0, magic);
    put(block, 4, table_fingerprint);
    put(block, 8, sequence);
    put(block, 12, static_cast<std::uint32_t>(block.size() - block_header_bytes));
    put(block, 16, checksum);
    put(block, 20, crc32(0, block.first(20)));
}

std::uint32_t checksum_of_tool(std::span<const std::uint8_t> tool) {
    return crc32(crc32(0, tool.first(4)), tool.subspan(8));
}

}  // namespace

std::span<const std::uint8_t> BlockTools::tool_at(std::size_t place) const {
    return tools_.subspan(place * numbered_tool_bytes, numbered_tool_bytes);
}

std::uint32_t BlockTools::number_at(std::size_t place) const {
    return get(tool_at(place), 0);
}

bool BlockTools::is_whole_at(std::size_t place) const {
    return get(tool_at(place), 4) == checksum_of_tool(tool_at(place));
}

bool BlockTools::read_at(std::size_t place, ToolParameters<float>& tool) const {
    return is_whole_at(place) && read_tool(tool_at(place).subspan(8), tool);
}

std::size_t BlockTools::place_of(std::uint32_t number) const {
    std::size_t place = 0;
    while (place < size() && number_at(place) != number) {
        ++place;
    }
    return place;
}

ParameterBlock encoded(const Parameters<float>& parameters, std::uint32_t sequence) {
    ParameterBlock block{};
    const std::span<std::uint8_t> values = std::span(block).subspan(block_header_bytes);
    put_values(values, values_of(parameters));
    put_header(block, block_magic, sequence, crc32(0, values));
    return block;
}

std::span<const std::uint8_t> encode_tools(const MachineParameters<float>& machine, std::span<const NumberedTool> tools,
                                           std::uint32_t sequence, LargestParameterBlock& block) {
    std::size_t end = block_header_bytes + machine_value_bytes;
    const std::span<std::uint8_t> of_machine = std::span(block).subspan(block_header_bytes, machine_value_bytes);
    for (const NumberedTool& tool : tools) {
        const ParameterValues values = values_of({machine, tool.parameters});
        put_values(of_machine, std::span(values).first<machine_parameter_count>());
        const std::span<std::uint8_t> of_tool = std::span(block).subspan(end, numbered_tool_bytes);
        put(of_tool, 0, tool.number);
        put_values(of_tool.subspan(8), std::span(values).last<tool_parameter_count>());
        put(of_tool, 4, checksum_of_tool(of_tool));
        end += numbered_tool_bytes;
    }
    const std::span<std::uint8_t> used = std::span(block).first(end);
    put_header(used, tools_block_magic, sequence, crc32(0, of_machine));
    return used;
}

BlockError check_block(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < block_header_bytes || (get(bytes, 0) != block_magic && !has_numbers(bytes))) {
        return BlockError::empty;
    }
    if (get(bytes, 20) != crc32(0, bytes.first(20))) {
        return BlockError::bad_header;
    }
    if (get(bytes, 4) != table_fingerprint) {
        return BlockError::other_table;
    }
    if (get(bytes, 12) > bytes.size() - block_header_bytes) {
        return BlockError::bad_values;
    }
    return has_numbers(bytes) ? check_tools(body_of(bytes), get(bytes, 16))
                              : check_one_tool(body_of(bytes), get(bytes, 16));
}

std::uint32_t sequence_of(std::span<const std::uint8_t> block) {
    return get(block, 8);
}

BlockTools tools_of(std::span<const std::uint8_t> block) {
    return has_numbers(block) ? BlockTools(body_of(block).subspan(machine_value_bytes)) : BlockTools();
}

BlockError decode(std::span<const std::uint8_t> bytes, Parameters<float>& parameters) {
    const BlockError error = check_block(bytes);
    if (error != BlockError::none) {
        return error;
    }
    Parameters<float> read = parameters;  // what no key stands for stays
    bool all_in_range = read_machine(body_of(bytes), read.machine);
    const BlockTools tools = tools_of(bytes);
    for (std::size_t place = tools.size(); place-- > 0;) {  // the first one is left
        all_in_range = tools.read_at(place, read.tool) && all_in_range;
    }
    if (tools.size() == 0) {
        all_in_range = read_tool(body_of(bytes).subspan(machine_value_bytes), read.tool) && all_in_range;
    }
    if (!all_in_range) {
        return BlockError::out_of_range;
    }
    parameters = read;
    return BlockError::none;
}

}  // namespace millforce::firmware
