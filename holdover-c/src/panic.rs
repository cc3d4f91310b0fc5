//! What a static library without `std` has to say about panics. The core has none that can be reached, which the linker
//! shows: where functions lie in sections of their own and unused ones are dropped, this one is not in the image.

use core::arch::global_asm;
use core::panic::PanicInfo;

// The address of the program's `holdover_panicked`; 0 if it has none. A reference that is weak is one to nothing then, and the
// compiler has none of its own.
global_asm!(
    ".weak holdover_panicked",
    ".pushsection .rodata.holdover_hook, \"a\"",
    ".global holdover_hook",
    ".hidden holdover_hook",
    ".balign {size}",
    "holdover_hook:",
    #[cfg(target_pointer_width = "32")]
    ".4byte holdover_panicked",
    #[cfg(target_pointer_width = "64")]
    ".8byte holdover_panicked",
    ".popsection",
    size = const size_of::<usize>(),
);

unsafe extern "C" {
    static holdover_hook: Option<extern "C" fn()>;
}

/// Calls the program's `holdover_panicked`, and stays here when that returns: the actuators' timeout on the command is the safe
/// reaction, and a reset loop would look alive.
#[panic_handler]
fn panicked(_: &PanicInfo) -> ! {
    // SAFETY: the word above, which is the address of a function as the header has it, or 0.
    if let Some(hook) = unsafe { holdover_hook } {
        hook();
    }
    loop {
        core::hint::spin_loop();
    }
}

/// A panic, for the test of the hook.
#[cfg(feature = "_panic")]
#[unsafe(no_mangle)]
#[allow(clippy::panic)]
pub extern "C" fn holdover_panic() {
    panic!()
}
