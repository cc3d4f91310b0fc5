//! Copies of memory, for a Cortex-M4: a place, another one and a number of bytes enter. The compiler calls these by the names of the ARM
//! ABI wherever a value moves, and takes them instead of its own, which copy a word or a byte at a time.
//!
//! Words are copied in blocks of eight, which takes a fourth of the instructions. The two places of a value lie alike beside a word. So up
//! to three bytes before the first word are copied by themselves. Places that lie differently are copied word by word.

use core::arch::naked_asm;

/// `memcpy` of the C library; returns the destination.
///
/// # Safety
/// Both places have so many bytes, and do not overlap.
#[unsafe(naked)]
#[unsafe(no_mangle)]
unsafe extern "C" fn memcpy(to: *mut u8, from: *const u8, count: usize) -> *mut u8 {
    naked_asm!("push {{r0, lr}}", "bl __aeabi_memcpy", "pop {{r0, pc}}")
}

/// A copy of any number of bytes.
///
/// # Safety
/// As of [`memcpy`].
#[unsafe(naked)]
#[unsafe(no_mangle)]
unsafe extern "C" fn __aeabi_memcpy(to: *mut u8, from: *const u8, count: usize) {
    naked_asm!(
        "1:", // byte by byte, until the destination is on a word
        "lsls r3, r0, #30",
        "beq 2f",
        "cbz r2, 6f",
        "ldrb r3, [r1], #1",
        "subs r2, #1",
        "strb r3, [r0], #1",
        "b 1b",
        "2:",
        "lsls r3, r1, #30",
        "beq __aeabi_memcpy4",
        "3:", // the source is beside words, which a load of one word may be
        "subs r2, #4",
        "blo 4f",
        "ldr r3, [r1], #4",
        "str r3, [r0], #4",
        "b 3b",
        "4:",
        "adds r2, #4",
        "beq 6f",
        "5:",
        "ldrb r3, [r1], #1",
        "subs r2, #1",
        "strb r3, [r0], #1",
        "bne 5b",
        "6:",
        "bx lr",
    )
}

/// The same between places that are on double words.
///
/// # Safety
/// As of [`memcpy`].
#[unsafe(naked)]
#[unsafe(no_mangle)]
unsafe extern "C" fn __aeabi_memcpy8(to: *mut u8, from: *const u8, count: usize) {
    naked_asm!("b __aeabi_memcpy4")
}

/// The same between places that are on words.
///
/// # Safety
/// As of [`memcpy`].
#[unsafe(naked)]
#[unsafe(no_mangle)]
unsafe extern "C" fn __aeabi_memcpy4(to: *mut u8, from: *const u8, count: usize) {
    naked_asm!(
        "subs r2, #32",
        "blo 2f",
        "push {{r4-r10}}",
        "1:",
        "ldmia r1!, {{r3-r10}}",
        "subs r2, #32",
        "stmia r0!, {{r3-r10}}",
        "bhs 1b",
        "pop {{r4-r10}}",
        "2:",               // what is left, less 32; the bits below stay
        "lsls r3, r2, #28", // carry: 16 bytes; negative: 8 bytes
        "bcc 3f",
        "ldmia r1!, {{r3, r12}}",
        "stmia r0!, {{r3, r12}}",
        "ldmia r1!, {{r3, r12}}",
        "stmia r0!, {{r3, r12}}",
        "3:",
        "itt mi",
        "ldmiami r1!, {{r3, r12}}",
        "stmiami r0!, {{r3, r12}}",
        "lsls r3, r2, #30", // carry: 4 bytes; negative: 2 bytes
        "itt cs",
        "ldrcs r3, [r1], #4",
        "strcs r3, [r0], #4",
        "itt mi",
        "ldrhmi r3, [r1], #2",
        "strhmi r3, [r0], #2",
        "lsls r3, r2, #31", // not zero: a byte
        "itt ne",
        "ldrbne r3, [r1]",
        "strbne r3, [r0]",
        "bx lr",
    )
}
