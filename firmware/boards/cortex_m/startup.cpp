// SPDX-License-Identifier: Apache-2.0
#include "common/processor.hpp"

#include <cstddef>

extern "C" {
extern std::uint32_t _stack_bottom, _stack_limit, _stack_top;
using Routine = void (*)();
[[noreturn]] void Reset_Handler();
void Fault_Handler();
[[noreturn]] void record_fault(const std::uint32_t* frame);

// A board's interrupts; what it does not define ends as a fault.
[[gnu::weak, gnu::nothrow, gnu::alias("Fault_Handler")]] void SysTick_Handler();
}

namespace {

using millforce::board::FaultRecord;

constexpr std::size_t fault_stack_words = 96;
alignas(8) std::uint32_t fault_stack[fault_stack_words];

// Addresses and bits: Armv7-M Architecture Reference Manual, B3.2 and B3.5.
volatile std::uint32_t& at(std::uintptr_t address) {
    return *reinterpret_cast<volatile std::uint32_t*>(address);
}
constexpr std::uintptr_t icsr = 0xE000'ED04U;
constexpr std::uintptr_t shcsr = 0xE000'ED24U;
constexpr std::uintptr_t cfsr = 0xE000'ED28U;
constexpr std::uintptr_t mmfar = 0xE000'ED34U;
constexpr std::uintptr_t bfar = 0xE000'ED38U;
constexpr std::uintptr_t cpacr = 0xE000'ED88U;
constexpr std::uintptr_t mpu_type = 0xE000'ED90U;
constexpr std::uintptr_t mpu_control = 0xE000'ED94U;
constexpr std::uintptr_t mpu_region = 0xE000'ED98U;
constexpr std::uintptr_t mpu_base = 0xE000'ED9CU;
constexpr std::uintptr_t mpu_attributes = 0xE000'EDA0U;

void enable_fpu() {
#if defined(__ARM_FP)
    at(cpacr) = at(cpacr) | (0xFU << 20U);
#endif
}

/// Denies every access to the lowest 256 bytes of the stack; the rest of memory keeps its default map.
void guard_stack() {
    constexpr std::uint32_t highest_region_wins = 7;
    constexpr std::uint32_t execute_never = 1U << 28U;
    constexpr std::uint32_t size_256 = 7U << 1U;
    if ((at(mpu_type) >> 8U & 0xFFU) > highest_region_wins) {
        at(mpu_region) = highest_region_wins;
        at(mpu_base) = reinterpret_cast<std::uint32_t>(&_stack_bottom);
        at(mpu_attributes) = execute_never | size_256 | 1U;
        at(mpu_control) = 1U << 2U | 1U;
    }
    at(shcsr) = at(shcsr) | 7U << 16U;  // memory, bus and usage faults have separate handlers
    asm volatile("dsb\n isb" ::: "memory");
}

bool is_in_stack(const std::uint32_t* frame) {
    return frame >= &_stack_limit && frame + 8 <= &_stack_top;
}

}  // namespace

void Reset_Handler() {
    enable_fpu();
    guard_stack();
    millforce::board::start_program();
}

/// The stack may be what failed: the handler uses another one.
[[gnu::naked]] void Fault_Handler() {
    asm volatile(
        "cpsid i\n"
        "tst lr, #4\n"
        "ite eq\n"
        "mrseq r0, msp\n"
        "mrsne r0, psp\n"
        "ldr r1, =%c0\n"
        "mov sp, r1\n"
        "b record_fault\n"
        ".ltorg\n"
        :
        : "i"(fault_stack + fault_stack_words));
}

void record_fault(const std::uint32_t* frame) {
    constexpr std::uint32_t memory_address_valid = 1U << 7U;
    FaultRecord record{};
    record.exception = at(icsr) & 0x1FFU;
    record.stack_pointer = reinterpret_cast<std::uint32_t>(frame);
    record.status = at(cfsr);
    record.address = (record.status & memory_address_valid) != 0 ? at(mmfar) : at(bfar);
    if (is_in_stack(frame)) {
        record.link_register = frame[5];
        record.program_counter = frame[6];
    }
    millforce::board::on_processor_fault(record);
}

namespace {

constexpr std::size_t system_vectors = 16;
constexpr std::size_t interrupts = 96;

struct VectorTable {
    const void* stack_top;
    Routine handler[system_vectors + interrupts - 1];
};

constexpr VectorTable vector_table() {
    VectorTable table{};
    for (Routine& handler : table.handler) {
        handler = Fault_Handler;
    }
    table.handler[0] = Reset_Handler;
    constexpr std::size_t sys_tick = 15;
    table.handler[sys_tick - 1] = SysTick_Handler;
    return table;
}

}  // namespace

[[gnu::section(".vectors"), gnu::used]] const VectorTable vectors = [] {
    VectorTable table = vector_table();
    table.stack_top = &_stack_top;
    return table;
}();
