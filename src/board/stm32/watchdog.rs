//! The independent watchdog: finished ticks enter; if five in a row are missing, a reset leaves. And how often that has
//! happened since power came on.

use super::register::{DBGMCU_APB1_FREEZE, IWDG_KR, IWDG_PR, IWDG_RLR};
use crate::board::chip::registers::{CLEAR_CAUSES, RCC_CSR};
use crate::board::restarts::{self, Kept};
use core::mem::MaybeUninit;

/// By the watchdog's own oscillator: 30 to 95 ms with that of the STM32F405, which is 47 % slow or 60 % fast at worst, and 47 to 55
/// ms with the STM32G474's.
const TIMEOUT_MS: u32 = 50;

const RESET_BY_WATCHDOG: u32 = 1 << 29;
/// The watchdog stops while a debugger has halted the core: a breakpoint is no reset.
const FREEZE: u32 = 1 << 12;

/// What outlives a reset: the start-up code leaves this section alone.
#[unsafe(link_section = ".uninit.RESTARTS")]
static mut RESTARTS: MaybeUninit<Kept> = MaybeUninit::uninit();

/// How often the watchdog has restarted the unit since power came on; `None` if that was too often. To be called once.
pub fn restarts() -> Option<u32> {
    let by_watchdog = RCC_CSR.read() & RESET_BY_WATCHDOG != 0;
    RCC_CSR.set(0, CLEAR_CAUSES);
    let place = (&raw mut RESTARTS).cast::<Kept>();
    // SAFETY: only this function accesses the static, and it runs once, before any interrupt is enabled. The read is
    // volatile, so the memory holds some words, whatever they are: any are valid, and chance ones are told by the complement.
    let before = unsafe { place.read_volatile() };
    let (kept, count) = restarts::count(by_watchdog, before);
    // SAFETY: as above.
    unsafe { place.write_volatile(kept) };
    count
}

/// The watchdog, running: nothing stops it any more.
pub struct Watchdog(());

impl Watchdog {
    pub fn start() -> Self {
        DBGMCU_APB1_FREEZE.set(0, FREEZE);
        // First, as this starts the oscillator that takes the two others over; until then it waits for half a second.
        IWDG_KR.write(0xcccc);
        IWDG_KR.write(0x5555); // unlocks the two
        IWDG_PR.write(3); // 32 kHz / 32
        IWDG_RLR.write(TIMEOUT_MS);
        Self(())
    }

    /// A tick is finished.
    pub fn feed(&mut self) {
        IWDG_KR.write(0xaaaa);
    }
}
