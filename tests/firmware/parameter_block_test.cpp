// SPDX-License-Identifier: Apache-2.0
#include "firmware/parameter_block.hpp"
#include "firmware/crc32.hpp"
#include "firmware/some_parameters.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::firmware;

namespace {

constexpr std::size_t slot_bytes = 4096;
static_assert(block_bytes <= slot_bytes);

/// Two erasable pages, whose bits a write can only clear, and whose power fails after a number of bytes. What is being
/// erased or written at that moment is left half done.
class FakeFlash {
  public:
    FakeFlash() {
        for (auto& slot : slots_) {
            slot.fill(0xFF);
        }
    }

    void fail_after(std::size_t bytes) { budget_ = bytes; }
    void restore_power() { budget_ = std::numeric_limits<std::size_t>::max(); }

    bool erase(unsigned slot) {
        for (std::uint8_t& byte : slots_[slot]) {
            if (!spend()) {
                return false;
            }
            byte = 0xFF;
        }
        return true;
    }
    bool program(unsigned slot, std::size_t offset, std::span<const std::uint8_t> bytes) {
        for (std::size_t k = 0; k < bytes.size(); ++k) {
            std::uint8_t& byte = slots_[slot][offset + k];
            if (!spend()) {
                byte &= static_cast<std::uint8_t>(bytes[k] | 0x5AU);  // some of the bits were cleared already
                return false;
            }
            byte &= bytes[k];
        }
        return true;
    }
    [[nodiscard]] std::span<const std::uint8_t> contents(unsigned slot) const { return slots_[slot]; }
    std::uint8_t& byte(unsigned slot, std::size_t offset) { return slots_[slot][offset]; }

  private:
    bool spend() { return budget_ > 0 && budget_-- > 0; }

    std::array<std::array<std::uint8_t, slot_bytes>, 2> slots_{};
    std::size_t budget_ = std::numeric_limits<std::size_t>::max();
};

using Store = ParameterStore<FakeFlash>;

Parameters<float> with_limit(float tooth_force_limit_N) {
    Parameters<float> parameters = test::complete_parameters();
    parameters.tool.tooth_force_limit_N = tooth_force_limit_N;
    return parameters;
}

/// Puts both CRCs right.
void sign(ParameterBlock& block) {
    const std::span<const std::uint8_t> bytes(block);
    const std::uint32_t values = crc32(0, bytes.subspan(block_header_bytes));
    std::memcpy(block.data() + 16, &values, sizeof(values));
    const std::uint32_t header = crc32(0, bytes.first(20));
    std::memcpy(block.data() + 20, &header, sizeof(header));
}

/// The limit that a store gives, −1 where it has no parameters.
float limit_in(FakeFlash& flash) {
    Parameters<float> parameters;
    BlockTools tools;
    return Store(flash).load(parameters, tools) == BlockError::none ? parameters.tool.tooth_force_limit_N : -1.0F;
}

}  // namespace

TEST_GROUP(ParameterBlock){};

/// Three tools by number.
TEST_GROUP(ToolsBlock) {
    LargestParameterBlock block{};
    std::span<const std::uint8_t> used{};
    Parameters<float> read{};

    void setup() override {
        used = write({7, 8, 4'000'000'000});
    }

    std::span<const std::uint8_t> write(std::initializer_list<std::uint32_t> numbers) {
        std::array<NumberedTool, largest_tool_count> tools{};
        std::size_t count = 0;
        for (const std::uint32_t number : numbers) {
            tools[count] = {number, with_limit(static_cast<float>(100 * (count + 1))).tool};
            ++count;
        }
        return encode_tools(with_limit(1.0F).machine, std::span(tools).first(count), 5, block);
    }
    /// Puts the CRC of the header right.
    void sign_header() {
        const std::uint32_t header = crc32(0, std::span<const std::uint8_t>(block).first(20));
        std::memcpy(block.data() + 20, &header, sizeof(header));
    }
    void set_length(std::size_t length) {
        const auto as_written = static_cast<std::uint32_t>(length);
        std::memcpy(block.data() + 12, &as_written, sizeof(as_written));
        sign_header();
    }
    /// Puts the number of a tool, and its CRC right.
    void renumber(std::size_t place, std::uint32_t number) {
        std::uint8_t* tool = block.data() + block_header_bytes + machine_value_bytes + place * numbered_tool_bytes;
        std::memcpy(tool, &number, sizeof(number));
        const std::uint32_t crc = crc32(crc32(0, {tool, 4}), {tool + 8, tool_value_bytes});
        std::memcpy(tool + 4, &crc, sizeof(crc));
    }
    /// The error of the first `bytes` of the block, which leaves the parameters as they are.
    BlockError error_of(std::span<const std::uint8_t> bytes) {
        read.tool.tooth_force_limit_N = 42.0F;
        const BlockError error = decode(bytes, read);
        CHECK_TRUE(error == BlockError::none || read.tool.tooth_force_limit_N == 42.0F);
        return error;
    }
    BlockError error() {
        return error_of(used);
    }
};

TEST(ToolsBlock, gives_back_the_machine_and_every_tool_to_the_last_bit) {
    const Parameters<float> written = test::distinct_parameters();
    const std::array<NumberedTool, 2> both{NumberedTool{3, written.tool}, NumberedTool{9, with_limit(5.0F).tool}};
    used = encode_tools(written.machine, both, 7, block);
    LONGS_EQUAL(BlockError::none, error());
    STRCMP_EQUAL("", test::first_difference(values_of(written), values_of(read)));
    UNSIGNED_LONGS_EQUAL(7, sequence_of(used));
    const BlockTools tools = tools_of(used);
    UNSIGNED_LONGS_EQUAL(2, tools.size());
    UNSIGNED_LONGS_EQUAL(9, tools.number_at(1));
    CHECK_TRUE(tools.read_at(1, read.tool));
    STRCMP_EQUAL("", test::first_difference(values_of({written.machine, with_limit(5.0F).tool}), values_of(read)));
}

TEST(ToolsBlock, finds_a_tool_by_its_number) {
    const BlockTools tools = tools_of(used);
    UNSIGNED_LONGS_EQUAL(1, tools.place_of(8));
    UNSIGNED_LONGS_EQUAL(2, tools.place_of(4'000'000'000));
    for (const std::uint32_t absent : {0U, 9U, 1U}) {
        UNSIGNED_LONGS_EQUAL(3, tools.place_of(absent));
    }
}

TEST(ToolsBlock, of_one_tool_without_a_number_has_no_tools_by_number) {
    const ParameterBlock one = encoded(with_limit(100.0F), 1);
    LONGS_EQUAL(BlockError::none, error_of(one));
    UNSIGNED_LONGS_EQUAL(0, tools_of(one).size());
}

TEST(ToolsBlock, holds_sixteen_tools) {
    used = write({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16});
    UNSIGNED_LONGS_EQUAL(largest_block_bytes, used.size());
    LONGS_EQUAL(BlockError::none, error());
    UNSIGNED_LONGS_EQUAL(16, tools_of(used).size());
}

TEST(ToolsBlock, refuses_seventeen_tools) {
    std::array<std::uint8_t, largest_block_bytes + numbered_tool_bytes> bytes{};
    write({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16});
    set_length(bytes.size() - block_header_bytes);
    std::copy(block.begin(), block.end(), bytes.begin());
    std::copy_n(block.end() - numbered_tool_bytes, numbered_tool_bytes, bytes.end() - numbered_tool_bytes);
    LONGS_EQUAL(BlockError::bad_tools, error_of(bytes));
}

TEST(ToolsBlock, refuses_numbers_that_are_there_twice_fall_or_are_0) {
    renumber(1, 7);
    LONGS_EQUAL(BlockError::bad_tools, error());
    renumber(1, 6);
    LONGS_EQUAL(BlockError::bad_tools, error());
    renumber(1, 8);
    LONGS_EQUAL(BlockError::none, error());
    renumber(0, 0);
    LONGS_EQUAL(BlockError::bad_tools, error());
}

TEST(ToolsBlock, refuses_a_block_that_is_cut_off_anywhere) {
    for (std::size_t length = 0; length < used.size(); ++length) {
        CHECK_TRUE(error_of(used.first(length)) != BlockError::none);
    }
}

TEST(ToolsBlock, refuses_any_other_length_however_well_signed) {
    const std::size_t body = used.size() - block_header_bytes;
    const auto all = std::span<const std::uint8_t>(block);
    for (const std::size_t length : {std::size_t{0}, machine_value_bytes, body - 1, body + 1, body + 4,
                                     block.size() - block_header_bytes + 1, std::size_t{UINT32_MAX}}) {
        set_length(length);
        LONGS_EQUAL(BlockError::bad_values, error_of(all));
    }
    set_length(body + numbered_tool_bytes);  // a tool of zeroes
    LONGS_EQUAL(BlockError::bad_values, error_of(all));
}

TEST(ToolsBlock, notices_one_wrong_bit_anywhere) {
    for (std::size_t offset = 0; offset < used.size(); ++offset) {
        block[offset] ^= 0x10U;
        CHECK_TRUE(error() != BlockError::none);
        block[offset] ^= 0x10U;
    }
    LONGS_EQUAL(BlockError::none, error());
}

TEST(ToolsBlock, refuses_a_value_out_of_its_range_in_any_tool) {
    for (std::size_t wrong = 0; wrong < 3; ++wrong) {
        std::array<NumberedTool, 3> tools{NumberedTool{1, with_limit(100.0F).tool},
                                          NumberedTool{2, with_limit(200.0F).tool},
                                          NumberedTool{3, with_limit(300.0F).tool}};
        tools[wrong].parameters.tooth_force_limit_N = -5.0F;
        used = encode_tools(with_limit(1.0F).machine, tools, 1, block);
        LONGS_EQUAL(BlockError::out_of_range, error());
    }
}

TEST(ToolsBlock, is_in_force_where_it_is_newer_and_brings_its_tools) {
    FakeFlash flash;
    CHECK_TRUE(Store(flash).save(with_limit(900.0F)));
    CHECK_TRUE(flash.program(1, 0, used));
    BlockTools tools;
    LONGS_EQUAL(BlockError::none, Store(flash).load(read, tools));
    DOUBLES_EQUAL(100.0, read.tool.tooth_force_limit_N, 1e-6);
    UNSIGNED_LONGS_EQUAL(3, tools.size());
    flash.byte(1, used.size() - 1) ^= 1U;
    LONGS_EQUAL(BlockError::none, Store(flash).load(read, tools));
    DOUBLES_EQUAL(900.0, read.tool.tooth_force_limit_N, 1e-6);
    UNSIGNED_LONGS_EQUAL(0, tools.size());
}

TEST(ParameterBlock, gives_back_every_parameter_to_the_last_bit) {
    const Parameters<float> written = test::distinct_parameters();
    const ParameterBlock block = encoded(written, 7);
    Parameters<float> read;
    LONGS_EQUAL(BlockError::none, decode(block, read));
    STRCMP_EQUAL("", test::first_difference(values_of(written), values_of(read)));
    UNSIGNED_LONGS_EQUAL(7, sequence_of(block));
}

TEST(ParameterBlock, an_empty_flash_has_no_parameters) {
    FakeFlash flash;
    Parameters<float> parameters;
    BlockTools tools;
    LONGS_EQUAL(BlockError::empty, Store(flash).load(parameters, tools));
}

TEST(ParameterBlock, the_last_one_saved_is_in_force) {
    FakeFlash flash;
    Store store(flash);
    for (const float limit_N : {100.0F, 200.0F, 300.0F, 400.0F, 500.0F}) {
        CHECK_TRUE(store.save(with_limit(limit_N)));
        CHECK_EQUAL(limit_N, limit_in(flash));
    }
}

TEST(ParameterBlock, sequence_numbers_may_wrap) {
    FakeFlash flash;
    CHECK_TRUE(flash.program(0, 0, encoded(with_limit(100.0F), 0xFFFF'FFFFU)));
    CHECK_TRUE(Store(flash).save(with_limit(200.0F)));
    CHECK_EQUAL(200.0F, limit_in(flash));
    CHECK_TRUE(Store(flash).save(with_limit(300.0F)));
    CHECK_EQUAL(300.0F, limit_in(flash));
}

TEST(ParameterBlock, a_power_cut_at_any_byte_leaves_the_old_block_or_the_new_one) {
    constexpr std::size_t whole_save = slot_bytes + block_bytes;
    bool was_old = false;
    for (std::size_t cut = 0; cut <= whole_save; ++cut) {
        FakeFlash flash;
        CHECK_TRUE(Store(flash).save(with_limit(100.0F)));
        CHECK_TRUE(Store(flash).save(with_limit(200.0F)));
        flash.fail_after(cut);
        const bool saved = Store(flash).save(with_limit(300.0F));
        flash.restore_power();
        const float limit_N = limit_in(flash);
        // The last byte half written may be the right one by chance: then it is the new block.
        CHECK_TRUE(limit_N == 300.0F || (limit_N == 200.0F && !saved));
        was_old = was_old || !saved;
        // And the next one is saved as ever.
        CHECK_TRUE(Store(flash).save(with_limit(400.0F)));
        CHECK_EQUAL(400.0F, limit_in(flash));
    }
    CHECK_TRUE(was_old);
}

TEST(ParameterBlock, one_wrong_bit_anywhere_is_noticed) {
    FakeFlash flash;
    CHECK_TRUE(Store(flash).save(with_limit(100.0F)));
    for (std::size_t offset = 0; offset < block_bytes; ++offset) {
        flash.byte(0, offset) ^= 0x10U;
        CHECK_EQUAL(-1.0F, limit_in(flash));
        flash.byte(0, offset) ^= 0x10U;
    }
    CHECK_EQUAL(100.0F, limit_in(flash));
}

TEST(ParameterBlock, a_damaged_block_gives_way_to_the_one_before) {
    FakeFlash flash;
    CHECK_TRUE(Store(flash).save(with_limit(100.0F)));
    CHECK_TRUE(Store(flash).save(with_limit(200.0F)));
    flash.byte(1, block_header_bytes + 5) ^= 1U;
    CHECK_EQUAL(100.0F, limit_in(flash));
}

TEST(ParameterBlock, refuses_values_out_of_range_however_well_signed) {
    Parameters<float> parameters = with_limit(-5.0F);
    Parameters<float> read;
    LONGS_EQUAL(BlockError::out_of_range, decode(encoded(parameters, 1), read));
    parameters.tool.tooth_force_limit_N = std::numeric_limits<float>::quiet_NaN();
    LONGS_EQUAL(BlockError::out_of_range, decode(encoded(parameters, 1), read));
}

TEST(ParameterBlock, refuses_half_an_identifier) {
    ParameterValues values = values_of(test::complete_parameters());
    const float default_id = test::complete_parameters().machine.bus.sync_id;
    const auto place = static_cast<std::size_t>(std::find(values.begin(), values.end(), default_id) - values.begin());
    ParameterBlock block = encoded(test::complete_parameters(), 1);
    const float half = default_id + 0.5F;
    std::memcpy(block.data() + block_header_bytes + 4 * place, &half, sizeof(half));
    sign(block);
    Parameters<float> read;
    LONGS_EQUAL(BlockError::out_of_range, decode(block, read));
}

TEST(ParameterBlock, refuses_a_block_of_another_table) {
    ParameterBlock block = encoded(test::complete_parameters(), 1);
    block[4] ^= 1U;
    sign(block);
    Parameters<float> read;
    LONGS_EQUAL(BlockError::other_table, decode(block, read));
}

TEST(ParameterBlock, takes_any_bytes_without_harm) {
    std::mt19937 random(11);
    Parameters<float> read;
    std::array<std::uint8_t, block_bytes> bytes{};
    for (int k = 0; k < 200; ++k) {
        for (std::uint8_t& byte : bytes) {
            byte = static_cast<std::uint8_t>(random());
        }
        bytes[0] = 'M';
        bytes[1] = 'F';
        bytes[2] = 'P';
        bytes[3] = 'B';
        CHECK_TRUE(decode(std::span<const std::uint8_t>(bytes), read) != BlockError::none);
        CHECK_TRUE(decode(std::span<const std::uint8_t>(bytes).first(static_cast<std::size_t>(k)), read) !=
                   BlockError::none);
    }
}

TEST(ParameterBlock, the_checksum_is_the_one_of_the_standard) {
    constexpr std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    static_assert(crc32(0, digits) == 0xCBF4'3926U);
    UNSIGNED_LONGS_EQUAL(0xCBF43926U, crc32(crc32(0, std::span(digits).first(4)), std::span(digits).subspan(4)));
}
