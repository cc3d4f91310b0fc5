//! The board: bytes of a serial line and the core's timer enter, frames with their time of arrival and ticks leave.
//!
//! This is the only place with `unsafe` in it, and the only one that knows a chip: an STM32F405 whose CAN traffic goes
//! over a serial CAN adapter on USART1 (`PA9` transmits, `PA10` receives). The chip runs on the 16 MHz oscillator that
//! it starts with; the emulator's model of it has no clock tree and counts at 168 MHz.

mod clock;
mod frame;
mod registers;
mod serial;
mod slcan;

pub use frame::CanFrame;

use clock::Clock;
use embedded_can::Frame;
use holdover::time::Instant;
use serial::Serial;
use slcan::Line;

/// Everything that the shell needs of the hardware.
pub struct Board {
    clock: Clock,
    serial: Serial,
    line: Line,
}

impl Board {
    /// Starts the clock and the serial line. Only the first call counts on the hardware being as it was at reset.
    pub fn start() -> Self {
        let core_hz = registers::core_hz();
        Self { clock: Clock::start(core_hz), serial: Serial::start(core_hz), line: Line::new() }
    }

    /// The next frame that is complete, and when it was: `None` when there is none yet.
    pub fn receive(&mut self) -> Option<(Instant, CanFrame)> {
        while let Some(byte) = self.serial.exchange() {
            if let Some(frame) = self.line.take(byte) {
                return Some((self.clock.now(), frame));
            }
        }
        None
    }

    /// The time, once in each period of 10 ms; periods that passed unseen are not made up for.
    pub fn tick(&mut self) -> Option<Instant> {
        self.clock.tick()
    }

    /// Queues a frame. One that finds the queue full is dropped whole: a later one says the same, but newer.
    pub fn transmit(&mut self, frame: &impl Frame) {
        self.serial.queue(&slcan::encode(frame));
    }
}

/// Stops for good, with interrupts off. The actuators' own timeout on the command is the safe reaction; a reset loop
/// would look alive.
pub fn stop() -> ! {
    cortex_m::interrupt::disable();
    loop {
        cortex_m::asm::nop();
    }
}

#[panic_handler]
fn panicked(_: &core::panic::PanicInfo) -> ! {
    stop()
}
