//! What a program has of the emulator: calls enter; their results leave, and at the end an exit code.

use core::arch::asm;

/// A call of the emulator's, by its number in the interface.
#[derive(Clone, Copy)]
#[repr(usize)]
pub enum Call {
    /// Opens a file.
    Open = 0x01,
    /// Writes to a file.
    Write = 0x05,
    /// Reads from a file.
    Read = 0x06,
    /// Ends the program.
    Exit = 0x18,
}

/// Reasons of an end: the program is done, or an error has ended it.
const DONE: usize = 0x20026;
const FAILED: usize = 0x20023;

/// Calls the emulator. What the argument is depends on the call: a value, or the address of words.
///
/// # Safety
/// An address has to be of what the call takes, and that has to be valid for what the call does with it.
pub unsafe fn call(which: Call, argument: usize) -> usize {
    let mut result = which as usize;
    // SAFETY: the emulator takes the instruction for a call, changes r0 and the memory that the caller has given, and goes on behind it.
    unsafe {
        #[cfg(machine = "cortex_r5f")]
        asm!("svc 0x123456", inout("r0") result, in("r1") argument, options(nostack));
        #[cfg(not(machine = "cortex_r5f"))]
        asm!("bkpt 0xab", inout("r0") result, in("r1") argument, options(nostack));
    }
    result
}

/// Ends the program: well, or not.
pub fn end(is_well: bool) -> ! {
    loop {
        // SAFETY: the argument is a value. The emulator does not come back.
        unsafe { call(Call::Exit, if is_well { DONE } else { FAILED }) };
    }
}
