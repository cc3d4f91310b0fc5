//! A real-time core of the ZynqMP, a Cortex-R5F: frames of its CAN controller and the core's cycles enter, frames with their
//! time of arrival and ticks leave.
//!
//! The board is polled: no interrupt is taken, and a frame's time of arrival is when the loop came to it, at most one tick's
//! work late. Clocks, pins and memory are as the chip's boot loader leaves them, which always runs first. It runs in the
//! emulator; on the chip it has not run.

mod alarm;
mod can;
mod clock;
mod layout;
mod pin;
mod registers;
mod start;

use super::acceptance::Patterns;
use super::outbox::{self, Outbox, Pass};
use super::port::{Overrun, Port};
use crate::firmware::CONFIG;
use alarm::Alarm;
use can::Controller;
use clock::Clock;
use embedded_can::Frame;
use holdover::health::Incident;
use holdover::time::Instant;
use layout::Layout;
use pin::Pin;
use registers::Block;

#[cfg(feature = "_log")]
compile_error!("this board has no way out for a log; build without the features `log` and `log-semihosting`");

/// Everything that the shell needs of the hardware.
pub struct Board {
    /// High while a tick runs.
    pub busy: Pin,
    /// To be fed by every finished tick.
    pub watchdog: Watchdog,
    /// How often the watchdog has restarted the unit.
    pub restarts: u32,
    port: Controller<Block>,
    outbox: Outbox,
    overruns: u32,
    clock: Clock,
    alarm: Option<Alarm>,
}

impl Board {
    /// Starts everything. The start-up code calls it once.
    fn start() -> Option<Self> {
        // The chip's real-time cores are numbers 0 and 1. The emulator's model counts the four application cores first; its
        // CAN controller takes frames in another layout, its cycles are nanoseconds, and it has no pins.
        let (can, layout, cycles_per_micro, pins, alarm) = match registers::core_number() {
            0 | 1 => (Block::CAN1, Layout::Silicon, 500, Some(Block::GPIO), None),
            _ => (Block::CAN0, Layout::Model, 1000, None, Some(Block::TIMERS)),
        };
        let clock = Clock::start(cycles_per_micro);
        let alarm = alarm.map(|block| Alarm::start(block, clock.left()));
        Some(Self {
            busy: Pin::start(pins),
            watchdog: Watchdog,
            restarts: 0,
            port: Controller::start(can, layout, Patterns::of(CONFIG.identifiers.heard_by_unit())),
            outbox: outbox::of_the_shell(),
            overruns: 0,
            clock,
            alarm,
        })
    }

    /// The next frame, and when it arrived.
    pub fn receive(&mut self) -> Option<(Instant, impl Frame + use<>)> {
        loop {
            match self.port.receive() {
                Ok(Some(frame)) => return Some((self.clock.now(), frame)),
                Ok(None) => return None,
                Err(Overrun) => self.overruns = self.overruns.saturating_add(1),
            }
        }
    }

    /// Takes a frame of the tick at this time to be sent.
    pub fn send(&mut self, tick: Instant, frame: &impl Frame) {
        self.outbox.push(tick, frame);
    }

    /// The time, once in each period of 10 ms; periods that passed unseen are not made up for.
    pub fn tick(&mut self) -> Option<Instant> {
        let now = self.clock.tick()?;
        if let Some(alarm) = &mut self.alarm {
            alarm.set(self.clock.left());
        }
        Some(now)
    }

    /// What was lost since the last call, and how often; to be called every period.
    pub fn incidents(&mut self) -> [(Incident, u32); 4] {
        let overruns = core::mem::take(&mut self.overruns);
        let [transmit, bus_off] = self.outbox.lost(&mut self.port);
        [(Incident::Overrun, overruns), transmit, bus_off, (Incident::MissedPeriod, self.clock.missed())]
    }

    /// Sends what can be sent. Then, in the emulator, it sleeps until there is something to do; on the chip, and while frames
    /// wait for room in the controller, it waits for a moment.
    pub fn idle(&mut self) {
        let mut pass = Pass::Taken;
        while pass == Pass::Taken {
            pass = self.outbox.pass(self.clock.now(), &mut self.port);
        }
        match &self.alarm {
            Some(alarm) if pass == Pass::Nothing && !self.clock.is_due() => alarm.sleep(),
            _ => self.clock.wait(),
        }
    }
}

/// There is none yet. On this chip a watchdog's bite goes to the platform management unit, whose firmware decides what it
/// resets, so it belongs to whoever configures that.
pub struct Watchdog;

impl Watchdog {
    /// A tick is finished.
    pub fn feed(&mut self) {}
}

/// Stops for good; no interrupt is enabled.
pub fn stop() -> ! {
    loop {
        core::hint::spin_loop();
    }
}
