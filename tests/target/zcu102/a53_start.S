/* SPDX-License-Identifier: Apache-2.0 */
// Start of a program of the Cortex-A53.
    .section .start, "ax"
    .global _start
_start:
    ldr x0, =_stack_top
    mov sp, x0
    ldr x0, =_bss_start
    ldr x1, =_bss_end
1:  cmp x0, x1
    b.hs 2f
    str xzr, [x0], #8
    b 1b
2:  bl run
3:  wfi
    b 3b
