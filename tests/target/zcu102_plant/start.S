/* SPDX-License-Identifier: Apache-2.0 */
// Start of a static Linux program on a bare Cortex-A53: FPU, flat memory map, vectors, its first stack. The program stays
// at EL1 on the stack pointer of EL0, so that its system calls arrive on a stack of ours.

    .section .text.start, "ax"
    .global start_on_a53
start_on_a53:
    ldr x0, =system_stack_top
    mov sp, x0
    mov x0, #(3 << 20)          // CPACR_EL1.FPEN
    msr cpacr_el1, x0
    ldr x0, =vectors
    msr vbar_el1, x0
    ldr x0, =0xFF00             // MAIR_EL1: 0 device-nGnRnE, 1 normal write-back
    msr mair_el1, x0
    ldr x0, =0x803520           // TCR_EL1: 32 bits, 4 KiB, inner shareable write-back, no upper half
    msr tcr_el1, x0
    ldr x0, =memory_map
    msr ttbr0_el1, x0
    dsb sy
    tlbi vmalle1
    dsb sy
    isb
    mrs x0, sctlr_el1
    mov x1, #0x1005             // I, C, M
    orr x0, x0, x1
    msr sctlr_el1, x0
    isb
    bl first_stack
    msr spsel, #0
    mov sp, x0
    mov x0, #0                  // nothing for atexit()
    b _start

// Gigabytes 0, 1, 2: memory; 3: devices, where nothing is executed.
    .balign 64
memory_map:
    .quad 0x0000000000000705
    .quad 0x0000000040000705
    .quad 0x0000000080000705
    .quad 0x00600000C0000401

    .macro vector target
    .balign 128
    b \target
    .endm
    .balign 2048
vectors:
    vector system_call          // from the program
    vector give_way
    .rept 14
    vector fault
    .endr

// All registers but x0 come back as they were; x0 to x7 are the call's arguments, x8 its number.
system_call:
    stp x0, x1, [sp, #-160]!
    stp x2, x3, [sp, #16]
    stp x4, x5, [sp, #32]
    stp x6, x7, [sp, #48]
    stp x8, x9, [sp, #64]
    stp x10, x11, [sp, #80]
    stp x12, x13, [sp, #96]
    stp x14, x15, [sp, #112]
    stp x16, x17, [sp, #128]
    stp x18, x30, [sp, #144]
    mrs x1, esr_el1
    lsr x1, x1, #26
    cmp x1, #0x15               // SVC of AArch64
    b.ne fault
    mov x0, sp
    bl serve
    ldp x18, x30, [sp, #144]
    ldp x16, x17, [sp, #128]
    ldp x14, x15, [sp, #112]
    ldp x12, x13, [sp, #96]
    ldp x10, x11, [sp, #80]
    ldp x8, x9, [sp, #64]
    ldp x6, x7, [sp, #48]
    ldp x4, x5, [sp, #32]
    ldp x2, x3, [sp, #16]
    ldr x1, [sp, #8]
    add sp, sp, #160
    eret

// The virtual timer: armed anew for a turn, whose ticks TPIDR_EL1 holds, its level falls, and with it the interrupt, which
// nobody acknowledges. An emulator of several processors on one goes on to the next then.
give_way:
    str x0, [sp, #-16]!
    mrs x0, tpidr_el1
    msr cntv_tval_el0, x0
    isb
    yield
    ldr x0, [sp], #16
    eret

fault:
    ldr x0, =system_stack_top
    mov sp, x0
    mrs x0, esr_el1
    mrs x1, elr_el1
    mrs x2, far_el1
    b end_by_fault

    .bss
    .balign 16
    .skip 16384
system_stack_top:
