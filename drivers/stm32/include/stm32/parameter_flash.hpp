// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "stm32/registers.hpp"

/// Two sectors of the chip's flash as the two slots of a parameter store. RM0090 3.6

namespace millforce::stm32 {

/// Where a slot is: the first bytes of a sector, of which nothing else is used.
struct FlashSlot {
    std::uint8_t sector = 0;  ///< 0…11
    std::span<volatile std::uint32_t> words{};
};

/// Erasing a sector takes 0.25…2 s, writing a word 16 µs, and the processor stalls meanwhile, because its program is in
/// the same flash. Use it only with the feed held and the watchdog not running. `Wait` is called while the flash is
/// busy, once at least per erase or word, and returns false to give up.
template <typename Wait>
class ParameterFlash {
  public:
    ParameterFlash(FlashRegisters& registers, const FlashSlot& first, const FlashSlot& second, Wait wait)
        : registers_(registers), slots_{first, second}, wait_(wait) {}

    /// False if the flash reports an error, or wait gave up. The slot may then be half erased.
    bool erase(unsigned slot) {
        constexpr std::uint32_t sector_erase = 1U << 1U;
        constexpr std::uint32_t start = 1U << 16U;
        const std::uint32_t sector = slots_[slot & 1U].sector;
        unlock();
        registers_.cr = sector_erase | sector << 3U | words_of_32_bits;
        registers_.cr = sector_erase | sector << 3U | words_of_32_bits | start;
        const bool is_done = finish();
        lock();
        flush_data_cache();
        return is_done;
    }

    /// `offset` is a multiple of 4. A last word that is not whole is filled with ones, which change nothing.
    bool program(unsigned slot, std::size_t offset, std::span<const std::uint8_t> bytes) {
        const std::span<volatile std::uint32_t> words = slots_[slot & 1U].words;
        if (offset % 4U != 0 || offset / 4U > words.size() || bytes.size() > 4U * (words.size() - offset / 4U)) {
            return false;
        }
        unlock();
        bool is_done = true;
        for (std::size_t k = 0; k < bytes.size() && is_done; k += 4U) {
            registers_.cr = programming | words_of_32_bits;
            words[(offset + k) / 4U] = word_at(bytes, k);
            is_done = finish();
        }
        lock();
        flush_data_cache();
        return is_done;
    }

    [[nodiscard]] std::span<const std::uint8_t> contents(unsigned slot) const {
        const std::span<volatile std::uint32_t> words = slots_[slot & 1U].words;
        // Nobody writes while it is read: the flash of a chip, or the memory of a test.
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(const_cast<const std::uint32_t*>(words.data()));
        return {bytes, 4U * words.size()};
    }

  private:
    static constexpr std::uint32_t programming = 1U << 0U;
    static constexpr std::uint32_t words_of_32_bits = 2U << 8U;
    static constexpr std::uint32_t locked = 1U << 31U;
    static constexpr std::uint32_t busy = 1U << 16U;
    /// Operation, write protection, alignment, parallelism, sequence.
    static constexpr std::uint32_t errors = 1U << 1U | 1U << 4U | 1U << 5U | 1U << 6U | 1U << 7U;
    static constexpr std::uint32_t end_of_operation = 1U << 0U;

    static std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t first) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 4U; ++k) {
            const std::uint32_t byte = first + k < bytes.size() ? bytes[first + k] : 0xFFU;
            word |= byte << (8U * k);
        }
        return word;
    }

    void unlock() {
        if (has_bits(registers_.cr, locked)) {
            registers_.keyr = 0x4567'0123U;
            registers_.keyr = 0xCDEF'89ABU;
        }
        registers_.sr = errors | end_of_operation;  // cleared by ones
    }
    void lock() { registers_.cr = locked; }

    bool finish() {
        do {
            if (!wait_()) {
                return false;
            }
        } while (has_bits(registers_.sr, busy));
        return (registers_.sr & errors) == 0;
    }

    /// The old contents may still be in the cache.
    void flush_data_cache() {
        constexpr std::uint32_t data_cache = 1U << 10U;
        constexpr std::uint32_t data_cache_reset = 1U << 12U;
        const std::uint32_t before = registers_.acr;
        registers_.acr = before & ~data_cache;
        registers_.acr = (before & ~data_cache) | data_cache_reset;
        registers_.acr = before;
    }

    FlashRegisters& registers_;
    FlashSlot slots_[2];
    Wait wait_;
};

}  // namespace millforce::stm32
