//! The board: bytes or frames of a bus and the core's timer enter, frames with their time of arrival and ticks leave.
//!
//! This is the only place with `unsafe` in it, and the only one that knows a chip: an STM32F405. Its CAN traffic goes over
//! a serial CAN adapter on USART1 ([`slcan`]), or with the feature `bxcan` over the chip's own controller; both are
//! `embedded-can`'s trait to the rest.

#[cfg(feature = "bxcan")]
mod bxcan;
mod clock;
mod clocks;
#[cfg(not(feature = "bxcan"))]
mod frame;
mod pin;
mod port;
mod registers;
#[cfg(not(feature = "bxcan"))]
mod serial;
#[cfg(not(feature = "bxcan"))]
mod slcan;
mod watchdog;

#[cfg(feature = "log")]
pub use clock::now;
pub use pin::Pin;
pub use port::{Arrivals, Inbox, Outbox};
pub use watchdog::Watchdog;

use clock::Ticks;
use clocks::Clocks;
use cortex_m::interrupt;
use cortex_m::peripheral::{NVIC, Peripherals};
use cortex_m_rt::exception;
use holdover::time::Instant;
use port::Port;

#[cfg(feature = "bxcan")]
type Selected = bxcan::Bxcan;
#[cfg(not(feature = "bxcan"))]
type Selected = slcan::Slcan;

/// Everything that the shell needs of the hardware.
pub struct Board {
    /// Frames that arrived.
    pub inbox: Inbox,
    /// Frames to send.
    pub outbox: Outbox,
    /// High while a tick runs.
    pub busy: Pin,
    /// To be fed by every finished tick.
    pub watchdog: Watchdog,
    /// How often the watchdog has restarted the unit.
    pub restarts: u32,
    ticks: Ticks,
}

impl Board {
    /// Starts everything. `None` if it was started before, or restarted too often to be trusted.
    pub fn start(arrivals: &'static mut Arrivals) -> Option<Self> {
        let peripherals = Peripherals::take()?;
        let restarts = watchdog::restarts()?;
        let clocks = Clocks::start();
        let (inbox, outbox) = port::start(&clocks, arrivals);
        clock::start(peripherals.SYST, clocks.core_hz);
        // SAFETY: the port's interrupt has its handler, below, and nothing relies on its being off.
        unsafe { NVIC::unmask(Number(Selected::INTERRUPT)) };
        Some(Self { inbox, outbox, busy: Pin::start(), watchdog: Watchdog::start(), restarts, ticks: Ticks::new() })
    }

    /// The time, once in each period of 10 ms; periods that passed unseen are not made up for.
    pub fn tick(&mut self) -> Option<Instant> {
        self.ticks.next()
    }

    /// Sends what can be sent, and sleeps if there is nothing else to do.
    pub fn idle(&mut self) {
        if self.outbox.flush() {
            return;
        }
        // With interrupts off nothing can arrive between the question and the sleep, and what arrives in it ends it.
        interrupt::free(|_| {
            if self.inbox.is_empty() && !self.ticks.is_due() {
                cortex_m::asm::wfi();
            }
        });
    }
}

/// The number of an interrupt.
#[derive(Clone, Copy)]
struct Number(i16);

// SAFETY: the only one is the port's, which is a number of this chip's vector table and does not change.
unsafe impl interrupt::InterruptNumber for Number {
    fn number(self) -> u16 {
        self.0 as u16
    }
}

/// All interrupts and exceptions without a handler of their own: the port's, and what must never happen.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    if number == Selected::INTERRUPT {
        port::interrupted();
    } else {
        stop();
    }
}

/// Stops, with interrupts off, until the watchdog resets the chip; for good if it is not running yet.
pub fn stop() -> ! {
    interrupt::disable();
    loop {
        cortex_m::asm::nop();
    }
}

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
