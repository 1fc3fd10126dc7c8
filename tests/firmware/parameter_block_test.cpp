// SPDX-License-Identifier: Apache-2.0
#include "firmware/parameter_block.hpp"
#include "firmware/crc32.hpp"
#include "firmware/some_parameters.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::firmware;

namespace {

constexpr std::size_t slot_bytes = 2048;
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
    return Store(flash).load(parameters) == BlockError::none ? parameters.tool.tooth_force_limit_N : -1.0F;
}

}  // namespace

TEST_GROUP(ParameterBlock){};

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
    LONGS_EQUAL(BlockError::empty, Store(flash).load(parameters));
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
