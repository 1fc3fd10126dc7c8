/* SPDX-License-Identifier: Apache-2.0 */
// What C++ cannot say to the firmware around a program of the Cortex-A53.

// long semihosting(operation, argument): Semihosting for AArch32 and AArch64, Arm IHI 0072
    .text
    .global semihosting
semihosting:
    hlt #0xf000
    ret

// long start_processor(processor, address): CPU_ON of the Power State Coordination Interface, Arm DEN 0022
    .global start_processor
start_processor:
    mov x2, x1
    mov x1, x0
    ldr x0, =0xC4000003
    mov x3, #0
    smc #0
    ret
