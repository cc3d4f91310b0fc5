//! The core's timer: its interrupt at 100 Hz enters, instants and ticks leave.

use core::cell::Cell;
use cortex_m::interrupt::{self, Mutex};
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{Peripherals, SCB, SYST};
use cortex_m_rt::exception;
use holdover::time::Instant;

const TICK_HZ: u32 = 100;
const TICK_MICROS: u64 = 1_000_000 / TICK_HZ as u64;

/// Periods since the start: 64 bits, because 32 wrap after 497 days.
static PERIODS: Mutex<Cell<u64>> = Mutex::new(Cell::new(0));

#[exception]
fn SysTick() {
    interrupt::free(|token| {
        let periods = PERIODS.borrow(token);
        periods.set(periods.get().wrapping_add(1));
    });
}

pub struct Clock {
    cycles_per_micro: u32,
    reload: u32,
    /// The last period whose tick was handed out.
    seen: u64,
}

impl Clock {
    /// Starts the timer. A core clock of up to 1.6 GHz fits its 24 bits.
    pub fn start(core_hz: u32) -> Self {
        let reload = core_hz / TICK_HZ - 1;
        if let Some(Peripherals { mut SYST, .. }) = Peripherals::take() {
            SYST.set_clock_source(SystClkSource::Core);
            SYST.set_reload(reload);
            SYST.clear_current();
            SYST.enable_interrupt();
            SYST.enable_counter();
        }
        Self { cycles_per_micro: core_hz / 1_000_000, reload, seen: 0 }
    }

    /// The time since the start, to a microsecond.
    pub fn now(&self) -> Instant {
        let (periods, cycles) = interrupt::free(|token| {
            let periods = PERIODS.borrow(token).get();
            let left = SYST::get_current();
            // The counter may have wrapped with interrupts off: then the count of periods is one behind it, and the
            // reading may be from either side of the wrap, so it is taken again.
            if SCB::is_pendst_pending() {
                (periods.wrapping_add(1), self.reload.wrapping_sub(SYST::get_current()))
            } else {
                (periods, self.reload.wrapping_sub(left))
            }
        });
        Instant::from_micros(periods.wrapping_mul(TICK_MICROS).wrapping_add(u64::from(cycles / self.cycles_per_micro)))
    }

    /// The time, if a period has begun since the last call that returned one.
    pub fn tick(&mut self) -> Option<Instant> {
        let periods = interrupt::free(|token| PERIODS.borrow(token).get());
        (periods != self.seen).then(|| {
            self.seen = periods;
            self.now()
        })
    }
}
