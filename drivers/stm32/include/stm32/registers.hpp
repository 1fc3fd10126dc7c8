// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// Registers of the STM32F405, as the reference manual RM0090 lays them out. Every driver of this folder takes them by
/// reference: on the chip they lie at the addresses of `address`, in a test they are plain memory.

namespace millforce::stm32 {

using Register = volatile std::uint32_t;

/// RM0090 7.3
struct RccRegisters {
    Register cr, pllcfgr, cfgr, cir;
    Register ahb1rstr, ahb2rstr, ahb3rstr, reserved_1c;
    Register apb1rstr, apb2rstr, reserved_28[2];
    Register ahb1enr, ahb2enr, ahb3enr, reserved_3c;
    Register apb1enr, apb2enr, reserved_48[2];
    Register ahb1lpenr, ahb2lpenr, ahb3lpenr, reserved_5c;
    Register apb1lpenr, apb2lpenr, reserved_68[2];
    Register bdcr, csr, reserved_78[2];
    Register sscgr, plli2scfgr;
};
static_assert(offsetof(RccRegisters, ahb1enr) == 0x30 && offsetof(RccRegisters, csr) == 0x74);

/// RM0090 5.4
struct PwrRegisters {
    Register cr, csr;
};

/// RM0090 3.9
struct FlashRegisters {
    Register acr, keyr, optkeyr, sr, cr, optcr;
};

/// RM0090 8.4
struct GpioRegisters {
    Register moder, otyper, ospeedr, pupdr, idr, odr, bsrr, lckr;
    Register afr[2];
};
static_assert(offsetof(GpioRegisters, afr) == 0x20);

/// RM0090 17.4, 18.4: advanced-control and general-purpose timers
struct TimerRegisters {
    Register cr1, cr2, smcr, dier, sr, egr, ccmr1, ccmr2, ccer, cnt, psc, arr, rcr;
    Register ccr[4];
    Register bdtr, dcr, dmar;
};
static_assert(offsetof(TimerRegisters, cnt) == 0x24 && offsetof(TimerRegisters, ccr) == 0x34);

/// RM0090 13.13
struct AdcRegisters {
    Register sr, cr1, cr2, smpr1, smpr2;
    Register jofr[4];
    Register htr, ltr, sqr1, sqr2, sqr3, jsqr;
    Register jdr[4];
    Register dr;
};
static_assert(offsetof(AdcRegisters, sqr1) == 0x2C && offsetof(AdcRegisters, dr) == 0x4C);

struct AdcCommonRegisters {
    Register csr, ccr, cdr;
};

/// RM0090 10.5
struct DmaStreamRegisters {
    Register cr, ndtr, par, m0ar, m1ar, fcr;
};
struct DmaRegisters {
    Register lisr, hisr, lifcr, hifcr;
    DmaStreamRegisters stream[8];
};
static_assert(offsetof(DmaRegisters, stream) == 0x10 && sizeof(DmaStreamRegisters) == 0x18);

/// RM0090 32.9
struct CanMailboxRegisters {
    Register identifier, length, low, high;
};
struct CanFilterRegisters {
    Register r1, r2;
};
struct CanRegisters {
    Register mcr, msr, tsr, rf0r, rf1r, ier, esr, btr;
    Register reserved_20[88];
    CanMailboxRegisters transmit[3];
    CanMailboxRegisters receive[2];
    Register reserved_1d0[12];
    Register fmr, fm1r, reserved_208, fs1r, reserved_210, ffa1r, reserved_218, fa1r;
    Register reserved_220[8];
    CanFilterRegisters filter[28];
};
static_assert(offsetof(CanRegisters, transmit) == 0x180 && offsetof(CanRegisters, receive) == 0x1B0);
static_assert(offsetof(CanRegisters, fmr) == 0x200 && offsetof(CanRegisters, filter) == 0x240);

/// RM0090 21.4
struct WatchdogRegisters {
    Register kr, pr, rlr, sr;
};

/// Where they are. RM0090 2.3
namespace address {
inline constexpr std::uintptr_t tim2 = 0x4000'0000U;
inline constexpr std::uintptr_t tim3 = 0x4000'0400U;
inline constexpr std::uintptr_t tim4 = 0x4000'0800U;
inline constexpr std::uintptr_t tim5 = 0x4000'0C00U;
inline constexpr std::uintptr_t iwdg = 0x4000'3000U;
inline constexpr std::uintptr_t can1 = 0x4000'6400U;
inline constexpr std::uintptr_t pwr = 0x4000'7000U;
inline constexpr std::uintptr_t tim1 = 0x4001'0000U;
inline constexpr std::uintptr_t tim8 = 0x4001'0400U;
inline constexpr std::uintptr_t adc1 = 0x4001'2000U;
inline constexpr std::uintptr_t adc_common = 0x4001'2300U;
inline constexpr std::uintptr_t gpio_a = 0x4002'0000U;
inline constexpr std::uintptr_t gpio_b = 0x4002'0400U;
inline constexpr std::uintptr_t gpio_c = 0x4002'0800U;
inline constexpr std::uintptr_t rcc = 0x4002'3800U;
inline constexpr std::uintptr_t flash = 0x4002'3C00U;
inline constexpr std::uintptr_t dma2 = 0x4002'6400U;
}  // namespace address

/// Compound assignments to volatile are deprecated, and hide that a register is read and written.
inline void set_bits(Register& target, std::uint32_t bits) {
    target = target | bits;
}
inline void clear_bits(Register& target, std::uint32_t bits) {
    target = target & ~bits;
}
/// `value` into the field of `width` bits from bit `position` on; the other bits stay.
inline void set_field(Register& target, unsigned position, unsigned width, std::uint32_t value) {
    const std::uint32_t mask = (1U << width) - 1U;
    target = (target & ~(mask << position)) | ((value & mask) << position);
}
inline bool has_bits(const Register& source, std::uint32_t bits) {
    return (source & bits) == bits;
}

}  // namespace millforce::stm32
