//! The chip's timers: a counter of microseconds and the core's timer, whose interrupt comes at 100 Hz, enter; instants and
//! ticks leave.
//!
//! Time is what the counter says, and it counts whatever becomes of the interrupts. Were it the number of interrupts, one that
//! is lost, because the core stood still for longer than a period (a debugger, an emulator that gets no processor), would
//! leave the unit's time a period behind until the next synchronisation. So it costs a tick and nothing else.

use super::register::{TIM2_CNT, TIM2_CR1, TIM2_EGR, TIM2_PSC};
use crate::board::chip::clocks::Clocks;
use crate::board::chip::registers::RCC_APB1ENR;
use crate::board::periods::{PERIOD_MICROS, Periods};
use core::cell::Cell;
use cortex_m::interrupt::{self, Mutex};
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;
use holdover::time::Instant;

/// Both timers have the same clock and start together, so an interrupt comes a moment after a period has begun.
const TICK_HZ: u32 = (1_000_000 / PERIOD_MICROS) as u32;

/// The counter's last reading, and how often it had begun anew: every 71 minutes.
static COUNT: Mutex<Cell<(u32, u32)>> = Mutex::new(Cell::new((0, 0)));
/// Interrupts of the core's timer.
static INTERRUPTS: Mutex<Cell<u32>> = Mutex::new(Cell::new(0));

#[exception]
fn SysTick() {
    now(); // often enough to see that the counter has begun anew
    interrupt::free(|token| {
        let interrupts = INTERRUPTS.borrow(token);
        interrupts.set(interrupts.get().wrapping_add(1));
    });
}

/// Starts both. A core clock of up to 1.6 GHz fits the 24 bits of the core's timer.
pub fn start(mut timer: SYST, clocks: &Clocks) {
    RCC_APB1ENR.enable(1); // TIM2
    TIM2_PSC.write((clocks.counter_hz / 1_000_000).saturating_sub(1));
    TIM2_EGR.write(1); // takes the prescaler over
    TIM2_CR1.write(1); // on
    timer.set_clock_source(SystClkSource::Core);
    timer.set_reload((clocks.core_hz / TICK_HZ).saturating_sub(1));
    timer.clear_current();
    timer.enable_interrupt();
    timer.enable_counter();
}

/// The time since the start, to a microsecond; from any context.
///
/// Not inlined, because in the interrupt of the port the compiler then no longer sees that a division of its queue cannot panic.
#[inline(never)]
pub fn now() -> Instant {
    interrupt::free(|token| {
        let count = TIM2_CNT.read();
        let (last, turns) = COUNT.borrow(token).get();
        let turns = if count < last { turns.wrapping_add(1) } else { turns };
        COUNT.borrow(token).set((count, turns));
        Instant::from_micros(u64::from(turns) << 32 | u64::from(count))
    })
}

/// The ticks, each handed out once.
pub struct Ticks {
    seen: u32,
    periods: Periods,
}

impl Ticks {
    pub const fn new() -> Self {
        Self { seen: 0, periods: Periods::new() }
    }

    /// The time, if a period has begun since the last call that returned one. Periods that passed unseen are not made up
    /// for, and counted.
    pub fn next(&mut self) -> Option<Instant> {
        let interrupts = interrupts();
        (interrupts != self.seen).then(|| {
            self.seen = interrupts;
            let now = now();
            self.periods.tick(now);
            now
        })
    }

    /// How many passed unseen since the last call.
    pub fn missed(&mut self) -> u32 {
        self.periods.missed()
    }

    /// Whether there is one to hand out.
    pub fn is_due(&self) -> bool {
        interrupts() != self.seen
    }
}

fn interrupts() -> u32 {
    interrupt::free(|token| INTERRUPTS.borrow(token).get())
}
