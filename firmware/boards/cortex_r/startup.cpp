// SPDX-License-Identifier: Apache-2.0
#include "common/processor.hpp"

#include <cstddef>

extern "C" {
extern std::uint32_t _stack_bottom;
[[noreturn]] void start_processor();
[[noreturn]] void record_fault(std::uint32_t exception, std::uint32_t return_address, std::uint32_t stack_pointer,
                               std::uint32_t link_register);
}

namespace {

using millforce::board::FaultRecord;

constexpr std::size_t fault_stack_words = 96;
alignas(8) std::uint32_t fault_stack[fault_stack_words];

// Exceptions by their place in the vectors, Armv7-R Architecture Reference Manual B1.8.
constexpr std::uint32_t prefetch_abort = 3;
constexpr std::uint32_t data_abort = 4;

// System control registers: Armv7-R B6.1.
std::uint32_t system_control() {
    std::uint32_t value = 0;
    asm volatile("mrc p15, 0, %0, c1, c0, 0" : "=r"(value));
    return value;
}
void set_system_control(std::uint32_t value) {
    asm volatile("mcr p15, 0, %0, c1, c0, 0\n isb" : : "r"(value) : "memory");
}
std::uint32_t regions_of_mpu() {
    std::uint32_t type = 0;
    asm volatile("mrc p15, 0, %0, c0, c0, 4" : "=r"(type));
    return type >> 8U & 0xFFU;
}
void set_region(std::uint32_t region, std::uint32_t base, std::uint32_t access, std::uint32_t size_and_enable) {
    asm volatile(
        "mcr p15, 0, %0, c6, c2, 0\n"
        "isb\n"
        "mcr p15, 0, %1, c6, c1, 0\n"
        "mcr p15, 0, %2, c6, c1, 4\n"
        "mcr p15, 0, %3, c6, c1, 2\n"
        :
        : "r"(region), "r"(base), "r"(access), "r"(size_and_enable)
        : "memory");
}

/// Exceptions go to address 0, and come in the instruction set of this image.
void place_vectors() {
    constexpr std::uint32_t high_vectors = 1U << 13U;
    constexpr std::uint32_t exceptions_in_thumb = 1U << 30U;
    set_system_control(system_control() & ~(high_vectors | exceptions_in_thumb));
}

/// Denies every access to the lowest 256 bytes of the stack; the rest of memory keeps its default map.
void guard_stack() {
    constexpr std::uint32_t execute_never_and_no_access = 1U << 12U;
    constexpr std::uint32_t size_256 = 7U << 1U;
    constexpr std::uint32_t mpu_over_default_map = 1U << 17U | 1U << 0U;
    const std::uint32_t regions = regions_of_mpu();
    if (regions == 0) {
        return;
    }
    for (std::uint32_t region = 0; region < regions; ++region) {
        set_region(region, 0, 0, 0);  // a boot loader may have left some
    }
    set_region(regions - 1U, reinterpret_cast<std::uint32_t>(&_stack_bottom), execute_never_and_no_access,
               size_256 | 1U);
    asm volatile("dsb" ::: "memory");
    set_system_control(system_control() | mpu_over_default_map);
}

}  // namespace

/// No exception returns: all continue in supervisor mode on a separate stack, because the stack may be what failed.
[[gnu::naked, gnu::section(".vectors"), gnu::used]] void exception_vectors() {
    asm volatile(
        "b Reset_Handler\n"
        "b undefined_instruction\n"
        "b supervisor_call\n"
        "b prefetch_abort\n"
        "b data_abort\n"
        "nop\n"
        "b interrupt\n"
        "b fast_interrupt\n"
        "undefined_instruction: mov r0, #1\n b 1f\n"
        "supervisor_call: mov r0, #2\n b 1f\n"
        "prefetch_abort: mov r0, #3\n b 1f\n"
        "data_abort: mov r0, #4\n b 1f\n"
        "interrupt: mov r0, #6\n b 1f\n"
        "fast_interrupt: mov r0, #7\n"
        "1: mov r1, lr\n"
        "cpsid if, #0x13\n"
        "mov r2, sp\n"
        "mov r3, lr\n"
        "ldr sp, =%c0\n"
        "b record_fault\n"
        ".ltorg\n"
        :
        : "i"(fault_stack + fault_stack_words));
}

void record_fault(std::uint32_t exception, std::uint32_t return_address, std::uint32_t stack_pointer,
                  std::uint32_t link_register) {
    FaultRecord record{};
    record.exception = exception;
    // How far the saved address is behind the instruction: Armv7-R table B1-7.
    record.program_counter = return_address - (exception == data_abort ? 8U : 4U);
    record.link_register = link_register;
    record.stack_pointer = stack_pointer;
    if (exception == prefetch_abort) {
        asm volatile("mrc p15, 0, %0, c5, c0, 1\n mrc p15, 0, %1, c6, c0, 2"
                     : "=r"(record.status), "=r"(record.address));
    } else if (exception == data_abort) {
        asm volatile("mrc p15, 0, %0, c5, c0, 0\n mrc p15, 0, %1, c6, c0, 0"
                     : "=r"(record.status), "=r"(record.address));
    }
    millforce::board::on_processor_fault(record);
}

/// Supervisor mode, a stack, the FPU; then C++.
extern "C" [[gnu::naked, gnu::used, noreturn]] void Reset_Handler() {
    asm volatile(
        "cpsid if, #0x13\n"
        "ldr sp, =_stack_top\n"
        "mrc p15, 0, r0, c1, c0, 2\n"
        "orr r0, r0, #0xF00000\n"  // CPACR: coprocessors 10 and 11
        "mcr p15, 0, r0, c1, c0, 2\n"
        "isb\n"
        "mov r0, #0x40000000\n"
        "vmsr fpexc, r0\n"
        "bl start_processor\n"
        ".ltorg\n");
}

void start_processor() {
    place_vectors();
    guard_stack();
    millforce::board::start_program();
}
