//! What a static library without `std` has to say about panics. The core has none that can be reached, which the linker
//! shows: where functions lie in sections of their own and unused ones are dropped, this one is not in the image.

use core::panic::PanicInfo;

/// Stays here: the actuators' timeout on the command is the safe reaction, and a reset loop would look alive.
#[panic_handler]
fn panicked(_: &PanicInfo) -> ! {
    loop {
        core::hint::spin_loop();
    }
}
