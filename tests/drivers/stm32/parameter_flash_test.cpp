// SPDX-License-Identifier: Apache-2.0
#include "stm32/parameter_flash.hpp"

#include "firmware/parameter_block.hpp"
#include "firmware/some_parameters.hpp"

#include <array>
#include <limits>

#include <CppUTest/TestHarness.h>

using namespace millforce;
using namespace millforce::stm32;

namespace {

constexpr std::size_t slot_words = 512;
constexpr std::uint32_t erase_of_sector_10 = 1U << 1U | 10U << 3U | 2U << 8U | 1U << 16U;
constexpr std::uint32_t sector_mask = 0xFU << 3U;

/// The flash behind its registers: erases and writes only as they allow, loses power after a number of operations.
struct FakeFlashChip {
    FlashRegisters registers{};
    std::array<std::uint32_t, slot_words> sectors[2]{};
    std::array<std::uint32_t, slot_words> held[2]{};  ///< what the cells hold
    std::uint32_t erases = 0;
    std::uint32_t words = 0;
    std::size_t power_left = std::numeric_limits<std::size_t>::max();
    std::uint32_t fails_with = 0;

    FakeFlashChip() {
        for (unsigned slot = 0; slot < 2; ++slot) {
            sectors[slot].fill(0xFFFF'FFFFU);
            held[slot] = sectors[slot];
        }
        registers.cr = 1U << 31U;
        registers.acr = 0x705;
    }
    /// Called while the driver waits.
    bool operate() {
        const std::uint32_t cr = registers.cr;
        const bool is_unlocked = registers.keyr == 0xCDEF'89ABU;
        const bool has_power = power_left > 0;
        power_left -= has_power ? 1U : 0U;
        if (is_unlocked && (cr & 1U << 16U) != 0 && (cr & 2U) != 0) {
            erase((cr & sector_mask) >> 3U == 10U ? 0U : 1U, has_power);
        }
        for (unsigned slot = 0; slot < 2; ++slot) {
            settle(slot, is_unlocked && (cr & 1U) != 0, has_power);
        }
        registers.sr = fails_with;
        return has_power;
    }

  private:
    void erase(unsigned slot, bool is_whole) {
        ++erases;
        for (std::size_t k = 0; k < (is_whole ? slot_words : slot_words / 2); ++k) {
            sectors[slot][k] = 0xFFFF'FFFFU;
            held[slot][k] = 0xFFFF'FFFFU;
        }
    }
    /// A write clears bits, or does nothing where it is not allowed.
    void settle(unsigned slot, bool is_allowed, bool is_whole) {
        for (std::size_t k = 0; k < slot_words; ++k) {
            if (sectors[slot][k] != held[slot][k]) {
                ++words;
                const std::uint32_t written = is_whole ? sectors[slot][k] : sectors[slot][k] | 0x5A5A'5A5AU;
                held[slot][k] &= is_allowed ? written : 0xFFFF'FFFFU;
                sectors[slot][k] = held[slot][k];
            }
        }
    }
};

struct Operate {
    FakeFlashChip* chip;
    bool operator()() const { return chip->operate(); }
};
using Flash = ParameterFlash<Operate>;

/// A new start: power is back, the flash is locked.
Flash started(FakeFlashChip& chip) {
    chip.registers.cr = 1U << 31U;
    chip.registers.keyr = 0;
    return {chip.registers, {10, chip.sectors[0]}, {11, chip.sectors[1]}, Operate{&chip}};
}

firmware::Parameters<float> with_limit(float tooth_force_limit_N) {
    firmware::Parameters<float> parameters = test::complete_parameters();
    parameters.tool.tooth_force_limit_N = tooth_force_limit_N;
    return parameters;
}

/// The limit that the store gives after a new start, −1 without parameters.
float limit_in(FakeFlashChip& chip) {
    Flash flash = started(chip);
    firmware::Parameters<float> parameters;
    firmware::BlockTools tools;
    const bool is_there = firmware::ParameterStore<Flash>(flash).load(parameters, tools) == firmware::BlockError::none;
    return is_there ? parameters.tool.tooth_force_limit_N : -1.0F;
}

bool save(FakeFlashChip& chip, float limit_N) {
    Flash flash = started(chip);
    return firmware::ParameterStore<Flash>(flash).save(with_limit(limit_N));
}

}  // namespace

TEST_GROUP(Stm32ParameterFlash) {
    FakeFlashChip chip;
};

TEST(Stm32ParameterFlash, erases_the_slots_sector_with_the_keys_and_locks_again) {
    std::uint32_t seen = 0;
    const auto look = [&] {
        seen = chip.registers.cr;
        return chip.operate();
    };
    chip.registers.cr = 1U << 31U;
    ParameterFlash flash(chip.registers, {10, chip.sectors[0]}, {11, chip.sectors[1]}, look);
    CHECK_TRUE(flash.erase(0));
    UNSIGNED_LONGS_EQUAL(erase_of_sector_10, seen);  // SER, SNB, PSIZE x32, STRT
    UNSIGNED_LONGS_EQUAL(0xCDEF'89ABU, chip.registers.keyr);
    UNSIGNED_LONGS_EQUAL(1U << 31U, chip.registers.cr);  // LOCK
    UNSIGNED_LONGS_EQUAL(0x705, chip.registers.acr);     // caches as before
    UNSIGNED_LONGS_EQUAL(1, chip.erases);
}

TEST(Stm32ParameterFlash, writes_whole_words_and_fills_the_last_with_ones) {
    Flash flash = started(chip);
    const std::array<std::uint8_t, 6> bytes{1, 2, 3, 4, 5, 6};
    CHECK_TRUE(flash.program(1, 8, bytes));
    UNSIGNED_LONGS_EQUAL(0xFFFF'FFFFU, chip.held[1][1]);
    UNSIGNED_LONGS_EQUAL(0x0403'0201U, chip.held[1][2]);
    UNSIGNED_LONGS_EQUAL(0xFFFF'0605U, chip.held[1][3]);
    UNSIGNED_LONGS_EQUAL(2, chip.words);
    LONGS_EQUAL(6, flash.contents(1)[13]);
}

TEST(Stm32ParameterFlash, writes_nothing_beyond_its_slot) {
    Flash flash = started(chip);
    const std::array<std::uint8_t, 8> bytes{};
    CHECK_FALSE(flash.program(0, 4 * slot_words - 4, bytes));
    CHECK_FALSE(flash.program(0, 4 * slot_words + 4, bytes));
    CHECK_FALSE(flash.program(0, 2, bytes));
    UNSIGNED_LONGS_EQUAL(0, chip.words);
    CHECK_TRUE(flash.program(0, 4 * slot_words - 8, bytes));
}

TEST(Stm32ParameterFlash, each_error_of_the_flash_fails_the_operation) {
    for (const unsigned bit : {1U, 4U, 5U, 6U, 7U}) {
        chip.fails_with = 1U << bit;
        Flash flash = started(chip);
        CHECK_FALSE(flash.erase(0));
        const std::array<std::uint8_t, 4> bytes{};
        CHECK_FALSE(flash.program(0, 0, bytes));
    }
    chip.fails_with = 0;
    CHECK_TRUE(started(chip).erase(0));
}

TEST(Stm32ParameterFlash, the_last_one_saved_is_in_force) {
    CHECK_EQUAL(-1.0F, limit_in(chip));
    for (const float limit_N : {100.0F, 200.0F, 300.0F}) {
        CHECK_TRUE(save(chip, limit_N));
        CHECK_EQUAL(limit_N, limit_in(chip));
    }
}

TEST(Stm32ParameterFlash, a_power_cut_at_any_operation_leaves_the_old_block_or_the_new_one) {
    constexpr std::size_t operations = 1 + firmware::block_bytes / 4;
    std::size_t old_ones = 0;
    for (std::size_t cut = 0; cut <= operations; ++cut) {
        FakeFlashChip cut_chip;
        CHECK_TRUE(save(cut_chip, 100.0F));
        CHECK_TRUE(save(cut_chip, 200.0F));
        cut_chip.power_left = cut;
        const bool saved = save(cut_chip, 300.0F);
        cut_chip.power_left = std::numeric_limits<std::size_t>::max();
        const float limit_N = limit_in(cut_chip);
        CHECK_TRUE(limit_N == 300.0F || (limit_N == 200.0F && !saved));
        old_ones += limit_N == 200.0F ? 1U : 0U;
        CHECK_TRUE(save(cut_chip, 400.0F));
        CHECK_EQUAL(400.0F, limit_in(cut_chip));
    }
    CHECK_TRUE(old_ones >= operations - 1);
}
