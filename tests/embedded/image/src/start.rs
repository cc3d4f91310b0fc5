//! From the reset of a Cortex-R5F to Rust: a core in the state that its reset left it in enters; a stack and floating point leave. The
//! memory of the emulator is zero at its start. On a Cortex-M, cortex-m-rt does this.

use core::arch::global_asm;

global_asm!(
    ".section .start, \"ax\"",
    ".global _start",
    ".type _start, %function",
    ".arm",
    "_start:",
    "cpsid aif, #0x1f", // system mode, everything masked
    "mrc p15, 0, r0, c1, c0, 2",
    "orr r0, r0, #0xf << 20", // full access to coprocessors 10 and 11
    "mcr p15, 0, r0, c1, c0, 2",
    "isb",
    "mov r0, #1 << 30", // which are floating point: on
    ".fpu vfpv3-d16",   // for the assembler, which does not know the target here
    "vmsr fpexc, r0",
    "ldr sp, =_stack_top",
    "b main",
    ".pool",
    ".size _start, . - _start",
);
