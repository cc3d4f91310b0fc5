//! The core's timer: its interrupt at 100 Hz enters, instants and ticks leave.

use core::cell::Cell;
use cortex_m::interrupt::{self, Mutex};
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::exception;
use holdover::time::Instant;

const TICK_HZ: u32 = 100;
const TICK_MICROS: u64 = 1_000_000 / TICK_HZ as u64;

#[derive(Clone, Copy)]
struct Timer {
    /// Periods since the start: 64 bits, because 32 wrap after 497 days.
    periods: u64,
    reload: u32,
    cycles_per_micro: u32,
}

static TIMER: Mutex<Cell<Timer>> = Mutex::new(Cell::new(Timer { periods: 0, reload: 0, cycles_per_micro: 1 }));

#[exception]
fn SysTick() {
    interrupt::free(|token| {
        let timer = TIMER.borrow(token).get();
        TIMER.borrow(token).set(Timer { periods: timer.periods.wrapping_add(1), ..timer });
    });
}

/// Starts the timer. A core clock of up to 1.6 GHz fits its 24 bits.
pub fn start(mut counter: SYST, core_hz: u32) {
    let reload = core_hz / TICK_HZ - 1;
    interrupt::free(|token| {
        TIMER.borrow(token).set(Timer { periods: 0, reload, cycles_per_micro: core_hz / 1_000_000 });
    });
    counter.set_clock_source(SystClkSource::Core);
    counter.set_reload(reload);
    counter.clear_current();
    counter.enable_interrupt();
    counter.enable_counter();
}

/// The time since the start, to a microsecond; from any context.
pub fn now() -> Instant {
    let (timer, cycles) = interrupt::free(|token| {
        let timer = TIMER.borrow(token).get();
        let left = SYST::get_current();
        // The counter may have wrapped with interrupts off: then the count of periods is one behind it, and the reading
        // may be from either side of the wrap, so it is taken again.
        if SCB::is_pendst_pending() {
            let periods = timer.periods.wrapping_add(1);
            (Timer { periods, ..timer }, timer.reload.wrapping_sub(SYST::get_current()))
        } else {
            (timer, timer.reload.wrapping_sub(left))
        }
    });
    let micros = cycles.checked_div(timer.cycles_per_micro).unwrap_or(0);
    Instant::from_micros(timer.periods.wrapping_mul(TICK_MICROS).wrapping_add(u64::from(micros)))
}

/// The ticks, each handed out once.
pub struct Ticks {
    seen: u64,
}

impl Ticks {
    pub const fn new() -> Self {
        Self { seen: 0 }
    }

    /// The time, if a period has begun since the last call that returned one. Periods that passed unseen are not made up
    /// for.
    pub fn next(&mut self) -> Option<Instant> {
        let periods = periods();
        (periods != self.seen).then(|| {
            self.seen = periods;
            now()
        })
    }

    /// Whether there is one to hand out.
    pub fn is_due(&self) -> bool {
        periods() != self.seen
    }
}

fn periods() -> u64 {
    interrupt::free(|token| TIMER.borrow(token).get().periods)
}
