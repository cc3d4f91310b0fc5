//! How deep the stack has been: what is below it is painted, and later what is left of the paint is measured.

use core::arch::asm;

const PAINT: u32 = 0x57ac_57ac;
/// Not painted below the caller, so that this function's own frame is left alone.
const SPARE: usize = 64;

unsafe extern "C" {
    /// End of the statics: the stack grows down towards it.
    static mut __sheap: u32;
}

/// Where the stack is now.
#[inline(always)]
pub fn pointer() -> usize {
    let pointer: usize;
    // SAFETY: reads the stack pointer and nothing else.
    unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack, preserves_flags)) };
    pointer
}

fn bottom() -> usize {
    (&raw mut __sheap) as usize
}

/// Paints what is free.
#[inline(never)]
pub fn paint() {
    let top = pointer() - SPARE;
    let mut word = bottom();
    while word < top {
        // SAFETY: between the end of the statics and the stack pointer there is nothing of anybody's, and no interrupt is
        // enabled in these programs.
        unsafe { (word as *mut u32).write_volatile(PAINT) };
        word += 4;
    }
}

/// Bytes used below a place since the paint.
#[inline(never)]
pub fn depth(from: usize) -> usize {
    let mut word = bottom();
    // SAFETY: as above, reading.
    while word < from && unsafe { (word as *const u32).read_volatile() } == PAINT {
        word += 4;
    }
    from - word
}
