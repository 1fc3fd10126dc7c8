// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// The start of every image: exception vectors, C++ initialisation, a stack whose overflow is caught, and one handler
/// for all faults. `cortex_m` and `cortex_r` implement it; the board gives memory.ld.
///
/// The stack lies at the bottom of RAM, its lowest 256 bytes denied by the MPU: an overflow is a fault, not a corrupted
/// variable. (Without an MPU it runs off the RAM, which is a bus fault as well.)

namespace millforce::board {

/// What is known after a processor fault.
struct FaultRecord {
    /// Cortex-M: 2 NMI, 3 hard fault, 4 memory, 5 bus, 6 usage, 16… an interrupt without handler. Cortex-R, the place
    /// in the vectors: 1 undefined instruction, 2 supervisor call, 3 prefetch abort, 4 data abort, 6 IRQ, 7 FIQ.
    std::uint32_t exception;
    std::uint32_t program_counter;  ///< address of the faulting instruction; 0 where the stack could not be read
    std::uint32_t link_register;
    std::uint32_t stack_pointer;  ///< before the exception
    std::uint32_t status;         ///< CFSR, Armv7-M Architecture Reference Manual B3.2.15; IFSR or DFSR, Armv7-R B6.1
    std::uint32_t address;        ///< MMFAR or BFAR, where `status` says that it is valid; IFAR or DFAR
};

/// Defined by the image: what to do on a fault. Runs on a separate stack, with interrupts masked.
extern "C" [[noreturn]] void on_processor_fault(const FaultRecord& record);

/// Given by the image: the program. Must not return.
extern "C" [[noreturn]] void run_image();

/// Called by the processor's start, once it has a stack: memory, constructors, run_image().
[[noreturn]] void start_program();

/// Paints the stack below the caller; done at the start, and again by who measures one part of a program.
void paint_stack();
/// Stack that was not touched since it was painted, in bytes, out of stack_size_bytes(). Linear in its result.
[[nodiscard]] std::uint32_t untouched_stack_bytes();
[[nodiscard]] std::uint32_t stack_size_bytes();

}  // namespace millforce::board
