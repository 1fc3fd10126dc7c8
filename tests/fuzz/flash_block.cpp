// SPDX-License-Identifier: Apache-2.0
// A parameter block as read from a flash, of one tool or of tools by number. The first byte says how: as the bytes are;
// or with checksums that are right, as from another program, so that the values behind them are reached. From 128 on, a
// block is saved into a flash that holds this one in both slots.
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "firmware/crc32.hpp"
#include "firmware/parameter_block.hpp"
#include "firmware/parameters_in.hpp"
#include "fuzz/hostile_bytes.hpp"
#include "parameters/parameter_block_file.hpp"
#include "parameters/parameter_files.hpp"

using namespace millforce;
using firmware::BlockError;

namespace {

using Block = std::vector<std::uint8_t>;

void put(Block& block, std::size_t offset, std::uint32_t value) {
    for (unsigned k = 0; k < 4 && offset + k < block.size(); ++k) {
        block[offset + k] = static_cast<std::uint8_t>(value >> (8U * k));
    }
}

std::uint32_t checksum(const Block& block, std::size_t begin, std::size_t length) {
    const fuzz::Input bytes = fuzz::Input(block).subspan(std::min(begin, block.size()));
    return firmware::crc32(0, bytes.first(std::min(length, bytes.size())));
}

void seal_tools(Block& block) {
    const std::size_t first = firmware::block_header_bytes + firmware::machine_value_bytes;
    for (std::size_t place = first; place + firmware::numbered_tool_bytes <= block.size();
         place += firmware::numbered_tool_bytes) {
        const std::uint32_t of_number = checksum(block, place, 4);
        const fuzz::Input values = fuzz::Input(block).subspan(place + 8, firmware::tool_value_bytes);
        put(block, place + 4, firmware::crc32(of_number, values));
    }
}

void seal(Block& block, bool has_numbers) {
    put(block, 0, has_numbers ? firmware::tools_block_magic : firmware::block_magic);
    put(block, 4, firmware::table_fingerprint);
    put(block, 12, static_cast<std::uint32_t>(block.size() - std::min(block.size(), firmware::block_header_bytes)));
    if (has_numbers) {
        seal_tools(block);
    }
    const std::size_t values = has_numbers ? firmware::machine_value_bytes : block.size();
    put(block, 16, checksum(block, firmware::block_header_bytes, values));
    put(block, 20, checksum(block, 0, 20));
}

const firmware::Parameters<float>& of_a_machine() {
    static const firmware::Parameters<float> parameters =
        host::read_parameters(MILLFORCE_SOURCE_DIR "/sim/scenarios/machines/vmc.toml",
                              MILLFORCE_SOURCE_DIR "/sim/scenarios/tools/endmill_10mm.toml");
    return parameters;
}

/// A whole block, with the bytes in place of some of its own: offset (two bytes) and four bytes, again and again.
Block changed(fuzz::Bytes& bytes, bool has_numbers) {
    const firmware::Parameters<float>& parameters = of_a_machine();
    Block block;
    if (has_numbers) {
        const std::array<firmware::NumberedTool, 2> tools{{{1, parameters.tool}, {9, parameters.tool}}};
        firmware::LargestParameterBlock largest{};
        const fuzz::Input used = firmware::encode_tools(parameters.machine, tools, 1, largest);
        block.assign(used.begin(), used.end());
    } else {
        const firmware::ParameterBlock one = firmware::encoded(parameters, 1);
        block.assign(one.begin(), one.end());
    }
    while (bytes.any_left()) {
        const std::size_t place = bytes.u8() + 256U * bytes.u8();
        put(block, 4 * (place % (block.size() / 4)), bytes.u32());
    }
    seal(block, has_numbers);
    return block;
}

void require_in_range(const firmware::Parameters<float>& parameters) {
    firmware::for_each_parameter(parameters, [](const auto&, const auto& field, float minimum, float maximum) {
        const auto value = static_cast<float>(field);
        fuzz::require(value >= minimum && value <= maximum, "a value within its range");
    });
}

void check(fuzz::Input block) {
    firmware::Parameters<float> parameters;
    parameters.tool.tooth_force_limit_N = 123.0F;
    const firmware::ParameterValues before = firmware::values_of(parameters);
    const BlockError error = firmware::decode(block, parameters);
    if (error != BlockError::none) {
        fuzz::require(firmware::values_of(parameters) == before, "a block that is refused changes nothing");
        return;
    }
    require_in_range(parameters);
    fuzz::require(firmware::check_block(block) == BlockError::none, "a block that is decoded is whole");
    const firmware::BlockTools tools = firmware::tools_of(block);
    fuzz::require(tools.size() <= firmware::largest_tool_count, "at most 16 tools");
    for (std::size_t place = 0; place < tools.size(); ++place) {
        firmware::ToolParameters<float> tool;
        fuzz::require(tools.read_at(place, tool), "each tool of a decoded block can be read");
        require_in_range({parameters.machine, tool});
        fuzz::require(tools.place_of(tools.number_at(place)) == place, "a tool is found by its number");
    }
    firmware::Parameters<float> again;
    fuzz::require(firmware::decode(firmware::encoded(parameters, 1), again) == BlockError::none &&
                      firmware::values_of(again) == firmware::values_of(parameters),
                  "what is written is read back");
}

/// Two slots in memory: as a flash, whose contents may be any bytes.
struct TwoSlots {
    std::array<Block, 2> slots;
    bool erase(unsigned slot) {
        slots[slot].assign(firmware::largest_block_bytes, 0xFF);
        return true;
    }
    bool program(unsigned slot, std::size_t offset, fuzz::Input bytes) {
        std::memcpy(slots[slot].data() + offset, bytes.data(), bytes.size());
        return true;
    }
    [[nodiscard]] fuzz::Input contents(unsigned slot) const { return slots[slot]; }
};

void save_over(const Block& block) {
    TwoSlots flash{{block, block}};
    firmware::ParameterStore<TwoSlots> store(flash);
    firmware::Parameters<float> parameters = of_a_machine();
    parameters.tool.tooth_force_limit_N = 123.0F;
    fuzz::require(store.save(parameters), "a block can be written whatever the flash holds");
    firmware::Parameters<float> read;
    firmware::BlockTools tools;
    fuzz::require(store.load(read, tools) == BlockError::none && read.tool.tooth_force_limit_N == 123.0F,
                  "the newest block is in force");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Bytes bytes({data, size});
    const std::uint8_t first = bytes.u8();
    const unsigned way = first % 4U;
    Block block;
    if (way == 0 || way == 1) {
        const fuzz::Input rest = bytes.take(size);
        block.assign(rest.begin(), rest.end());
        if (way == 1) {
            seal(block, bytes.u8() % 2 == 0);
        }
    } else {
        block = changed(bytes, way == 3);
    }
    check(block);
    if (first >= 128) {  // the checksums of three blocks take longer than all else
        save_over(block);
    }
    const std::string file = fuzz::folder().write("flash.bin", fuzz::text_of(block)).string();
    fuzz::is_taken([&] { (void)host::read_parameter_block(file); });
    return 0;
}
