// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// Registers of a Zynq UltraScale+ as its register reference UG1087 lays them out. A driver takes them by reference: on
/// the chip they lie at the addresses of `address`, in a test they are plain memory.

namespace millforce::zynqmp {

using Register = volatile std::uint32_t;

struct CanFrameRegisters {
    Register identifier, length, data1, data2;
};

/// UG1087, module CAN; UG1085 chapter 20
struct CanRegisters {
    Register srr, msr, brpr, btr, ecr, esr, sr, isr, ier, icr, tcr, wir;
    CanFrameRegisters transmit;
    CanFrameRegisters transmit_first;
    CanFrameRegisters receive;
    Register afr;
    Register filter[8];
};
static_assert(offsetof(CanRegisters, isr) == 0x1C && offsetof(CanRegisters, transmit) == 0x30);
static_assert(offsetof(CanRegisters, receive) == 0x50 && offsetof(CanRegisters, afr) == 0x60);

/// UG1087, module SWDT
struct WatchdogRegisters {
    Register mode, control, restart, status;
};

/// UG1087, module PMU_GLOBAL from ERROR_STATUS_1 on: what a system error leads to. Writing a one sets the bit in an
/// enable register; in its disable register a one clears it; ERROR_EN_1 is read and written.
struct ErrorRegisters {
    Register status_1;
    Register reserved_534[14];
    Register system_reset_enable_1;
    Register reserved_570[12];
    Register enable_1;
};
static_assert(offsetof(ErrorRegisters, system_reset_enable_1) == 0x56C - 0x530);
static_assert(offsetof(ErrorRegisters, enable_1) == 0x5A0 - 0x530);

/// UG1085 table 10-7
namespace address {
inline constexpr std::uintptr_t can0 = 0xFF06'0000U;
inline constexpr std::uintptr_t can1 = 0xFF07'0000U;
inline constexpr std::uintptr_t watchdog = 0xFF15'0000U;
inline constexpr std::uintptr_t reset_reason = 0xFF5E'0220U;
inline constexpr std::uintptr_t errors = 0xFFD8'0530U;
}  // namespace address

}  // namespace millforce::zynqmp
