// Start of a program of the Cortex-A53, and what C++ cannot say.
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
