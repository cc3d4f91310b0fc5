//! The boards: frames of a bus and a timer enter, frames with their time of arrival and ticks leave. One folder per chip, of
//! which the board that is built for selects one, `stm32` for what its chips share, and beside them what all share.
//!
//! This is the only place with `unsafe` in it, and the only one that knows a chip.
//!
//! A board calls `firmware::run` once, with the unit's memory and itself: `Board` has `receive`, `send`, `tick`,
//! `incidents` and `idle`, a pin `busy` and a `watchdog`.

#[cfg(any(chip = "zynqmp_r5", chip = "stm32g474", feature = "bxcan"))]
mod acceptance;
#[cfg(any(chip = "zynqmp_r5", chip = "stm32g474", feature = "bxcan"))]
mod bit_time;
mod frame;
#[cfg(any(chip = "stm32f405", chip = "stm32g474"))]
mod memory;
mod outbox;
mod periods;
mod port;
#[cfg(any(chip = "zynqmp_r5", chip = "stm32g474", feature = "bxcan"))]
mod registers;
#[cfg(any(chip = "stm32f405", chip = "stm32g474"))]
mod restarts;

pub use outbox::MOST_AGE;

#[cfg(any(chip = "stm32f405", chip = "stm32g474"))]
mod stm32;
#[cfg(any(chip = "stm32f405", chip = "stm32g474"))]
pub use stm32::*;
#[cfg(chip = "stm32f405")]
#[path = "stm32f405/mod.rs"]
mod chip;
#[cfg(chip = "stm32g474")]
#[path = "stm32g474/mod.rs"]
mod chip;
#[cfg(chip = "zynqmp_r5")]
mod zynqmp_r5;
#[cfg(chip = "zynqmp_r5")]
pub use zynqmp_r5::*;

#[cfg(not(any(chip = "stm32f405", chip = "stm32g474", chip = "zynqmp_r5")))]
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
