//! What the STM32s have in common: frames of the chip's port and the core's timer enter, frames with their time of arrival and
//! ticks leave. The chip's folder has its registers, its clock tree, its wiring and its port.

mod clock;
pub mod gpio;
mod pin;
pub mod port;
pub mod register;
pub mod watchdog;

#[cfg(feature = "_log")]
pub use clock::now;

use crate::board::chip::Selected;
use crate::board::chip::clocks::Clocks;
use crate::board::outbox::{self, Outbox, Pass};
use crate::firmware::{self, Unit};
use clock::Ticks;
use cortex_m::interrupt;
use cortex_m::peripheral::{NVIC, Peripherals};
use cortex_m_rt::exception;
#[cfg(feature = "log")]
use defmt_rtt as _;
#[cfg(feature = "log-semihosting")]
use defmt_semihosting as _;
use embedded_can::Frame;
use holdover::health::Incident;
use holdover::time::Instant;
use pin::Pin;
use port::{Arrivals, Inbox, Select};
use watchdog::Watchdog;

#[cfg(all(feature = "log", feature = "log-semihosting"))]
compile_error!("there is one way out for a log: the feature `log` or the feature `log-semihosting`");

/// Everything that the shell needs of the hardware.
pub struct Board {
    /// High while a tick runs.
    pub busy: Pin,
    /// To be fed by every finished tick.
    pub watchdog: Watchdog,
    /// How often the watchdog has restarted the unit.
    pub restarts: u32,
    /// The crystal did not start, and nobody has been told.
    has_failed: bool,
    inbox: Inbox,
    ticks: Ticks,
}

#[cortex_m_rt::entry]
fn start() -> ! {
    // The entry attribute hands the statics out as `&'static mut`, once. `ci.sh` finds the unit by its name.
    static mut UNIT: Unit = Unit::idle();
    static mut ARRIVALS: Arrivals = Arrivals::new();
    static mut OUTBOX: Outbox = outbox::of_the_shell();
    firmware::run(UNIT, Board::start(ARRIVALS, OUTBOX))
}

impl Board {
    /// Starts everything. `None` if it was started before, or restarted too often to be trusted.
    fn start(arrivals: &'static mut Arrivals, outbox: &'static mut Outbox) -> Option<Self> {
        let peripherals = Peripherals::take()?;
        let restarts = watchdog::restarts()?;
        // It watches over the start as well.
        let mut watchdog = Watchdog::start();
        #[cfg(feature = "_log")]
        register::DBGMCU_CR.set(0, 1); // memory can be read while the core sleeps
        let clocks = Clocks::start(&mut watchdog);
        let inbox = port::start(&clocks, arrivals, outbox);
        clock::start(peripherals.SYST, &clocks);
        for number in Selected::INTERRUPTS {
            // SAFETY: the port's interrupts have their handler, below, and nothing relies on their being off.
            unsafe { NVIC::unmask(Number(*number)) };
        }
        watchdog.feed();
        let has_failed = !clocks.is_by_crystal;
        Some(Self { busy: Pin::start(), watchdog, restarts, has_failed, inbox, ticks: Ticks::new() })
    }

    /// The next frame, and when it arrived.
    pub fn receive(&mut self) -> Option<(Instant, impl Frame + use<>)> {
        self.inbox.next()
    }

    /// Takes a frame of the tick at this time to be sent.
    pub fn send(&mut self, tick: Instant, frame: &impl Frame) {
        port::send(tick, frame);
    }

    /// The time, once in each period of 10 ms; periods that passed unseen are not made up for.
    pub fn tick(&mut self) -> Option<Instant> {
        self.ticks.next()
    }

    /// What was lost since the last call, and how often; to be called every period.
    pub fn incidents(&mut self) -> [(Incident, u32); 6] {
        let [overrun, receive, transmit, bus_off] = port::lost();
        let missed = (Incident::MissedPeriod, self.ticks.missed());
        let clock = (Incident::ClockFailed, u32::from(core::mem::take(&mut self.has_failed)));
        [overrun, receive, transmit, bus_off, missed, clock]
    }

    /// Sends what can be sent, and sleeps if there is nothing else to do.
    pub fn idle(&mut self) {
        let mut pass = Pass::Taken;
        while pass == Pass::Taken {
            pass = port::pass();
        }
        if pass == Pass::Full && !Selected::TELLS_WHEN_SENT {
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

// SAFETY: the only ones are the port's, which are numbers of this chip's vector table and do not change.
unsafe impl interrupt::InterruptNumber for Number {
    fn number(self) -> u16 {
        self.0 as u16
    }
}

/// All interrupts and exceptions without a handler of their own: the port's, and what must never happen.
#[exception]
unsafe fn DefaultHandler(number: i16) {
    if Selected::INTERRUPTS.contains(&number) {
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
