//! From the reset to Rust: a core in the state that its reset left it in enters; a stack, floating point and zeroed memory
//! leave it.

use crate::board::{self, Board};
use crate::firmware::{self, Unit};
use core::arch::global_asm;

// The vectors, since the core always looks for them at 0. No exception is expected and no interrupt enabled, so all but the
// reset stop the unit.
global_asm!(
    ".section .vectors, \"ax\"",
    ".arm",
    "b {start}", // reset
    "b {stop}",  // undefined instruction
    "b {stop}",  // supervisor call
    "b {stop}",  // prefetch abort
    "b {stop}",  // data abort
    "b {stop}",  // not used
    "b {stop}",  // IRQ
    "b {stop}",  // FIQ
    start = sym _start,
    stop = sym stopped,
);

unsafe extern "C" {
    fn _start() -> !;
}

global_asm!(
    ".section .start, \"ax\"",
    ".global _start",
    ".type _start, %function",
    ".arm",
    "_start:",
    "cpsid aif, #0x1f",         // system mode, everything masked
    "mrc p15, 0, r0, c1, c0, 0",
    "bic r0, r0, #1 << 13",     // vectors at 0
    "mcr p15, 0, r0, c1, c0, 0",
    "mrc p15, 0, r0, c1, c0, 2",
    "orr r0, r0, #0xf << 20",   // full access to coprocessors 10 and 11
    "mcr p15, 0, r0, c1, c0, 2",
    "isb",
    "mov r0, #1 << 30",         // which are floating point: on
    "vmsr fpexc, r0",
    "ldr sp, =_stack_top",
    "ldr r0, =_bss_start",
    "ldr r1, =_bss_end",
    "mov r2, #0",
    "mov r3, #0",
    "0: cmp r0, r1",
    "strdlo r2, r3, [r0], #8",
    "blo 0b",
    "b {main}",
    ".pool",
    ".size _start, . - _start",
    main = sym main,
);

#[allow(static_mut_refs)] // it is the only one
extern "C" fn main() -> ! {
    static mut UNIT: Unit = Unit::idle();
    // SAFETY: the start-up code jumps here once, on the one core that runs this image, and nothing else names the static.
    let unit = unsafe { &mut UNIT };
    firmware::run(unit, Board::start())
}

extern "C" fn stopped() -> ! {
    board::stop()
}
