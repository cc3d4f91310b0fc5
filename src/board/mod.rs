//! The boards: frames of a bus and a timer enter, frames with their time of arrival and ticks leave. One folder per board,
//! of which the target selects one, and beside them what they share.
//!
//! This is the only place with `unsafe` in it, and the only one that knows a chip.
//!
//! A board calls `firmware::run` once, with the unit's memory and itself: `Board` has `receive`, `send`, `tick`,
//! `incidents` and `idle`, a pin `busy` and a `watchdog`.

mod frame;
mod outbox;
mod periods;
mod port;
#[cfg(any(board = "zynqmp_r5", feature = "bxcan"))]
mod registers;
#[cfg(board = "stm32f405")]
mod restarts;

#[cfg(board = "stm32f405")]
mod stm32f405;
#[cfg(board = "stm32f405")]
pub use stm32f405::*;
#[cfg(board = "zynqmp_r5")]
mod zynqmp_r5;
#[cfg(board = "zynqmp_r5")]
pub use zynqmp_r5::*;

#[cfg(not(any(board = "stm32f405", board = "zynqmp_r5")))]
compile_error!("the firmware has no board for this target; the core builds for it with `--lib`");

/// In a build with the feature `no-panic` this refers to a symbol that there is not: the image can only be linked if the
/// linker finds that nothing reaches this function, and removes it.
#[panic_handler]
fn panicked(_: &core::panic::PanicInfo) -> ! {
    #[cfg(feature = "no-panic")]
    {
        unsafe extern "C" {
            fn the_firmware_can_panic();
        }
        // SAFETY: there is no such function, so no image has this call in it.
        unsafe { the_firmware_can_panic() };
    }
    stop()
}
