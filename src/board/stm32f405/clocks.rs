//! The clock tree: the oscillators as they are after a reset enter, a core at 168 MHz leaves.
//!
//! A crystal is preferred, because CAN at 500 kbit/s wants its clock within 0.5 %; where it does not start, the internal
//! oscillator (1 %) drives the same PLL, and the unit at least keeps its period. This has run on no chip: the emulator's
//! model has no clock tree, and skips it.

use super::registers::{FLASH_ACR, RCC_CFGR, RCC_CR, RCC_PLLCFGR};
use super::wiring::WIRING;
use crate::board::stm32::watchdog::Watchdog;

const CRYSTAL_MHZ: u32 = WIRING.crystal_mhz;

const _: () =
    assert!(CRYSTAL_MHZ.is_multiple_of(2) && 4 <= CRYSTAL_MHZ && CRYSTAL_MHZ <= 26, "the PLL takes 2 MHz of it");

/// The internal oscillator, from which the chip starts.
const INTERNAL_MHZ: u32 = 16;

/// Frequencies of the core and of the two peripheral buses.
#[derive(Clone, Copy)]
pub struct Clocks {
    pub core_hz: u32,
    /// Whether the crystal drives it.
    pub is_by_crystal: bool,
    /// Of the timers on the slower bus, which run at twice its clock where that is divided.
    pub counter_hz: u32,
    /// Of USART1.
    #[cfg(not(feature = "bxcan"))]
    pub fast_bus_hz: u32,
    /// Of CAN1.
    #[cfg(feature = "bxcan")]
    pub slow_bus_hz: u32,
}

impl Clocks {
    const fn new(is_by_crystal: bool, core_hz: u32, counter_hz: u32, _fast: u32, _slow: u32) -> Self {
        Self {
            core_hz,
            is_by_crystal,
            counter_hz,
            #[cfg(not(feature = "bxcan"))]
            fast_bus_hz: core_hz / _fast,
            #[cfg(feature = "bxcan")]
            slow_bus_hz: core_hz / _slow,
        }
    }

    /// Starts them; each of two waits feeds the watchdog.
    pub fn start(watchdog: &mut Watchdog) -> Self {
        const INTERNAL_READY: u32 = 1 << 1;
        const CRYSTAL_ON: u32 = 1 << 16;
        const CRYSTAL_READY: u32 = 1 << 17;
        const PLL_ON: u32 = 1 << 24;
        const PLL_READY: u32 = 1 << 25;
        // The oscillator that the chip starts with says that it is ready, or no instruction would be executed. A chip that
        // denies it has no clock tree: it is the emulator's model, whose core's
        // timer counts at 168 MHz and whose others at 1 GHz.
        if RCC_CR.read() & INTERNAL_READY == 0 {
            return Self::new(true, 168_000_000, 1_000_000_000, 1, 1);
        }
        RCC_CR.set(0, CRYSTAL_ON);
        let crystal = RCC_CR.wait_for(CRYSTAL_READY);
        watchdog.feed();
        let (mhz, source) = if crystal { (CRYSTAL_MHZ, 1 << 22) } else { (INTERNAL_MHZ, 0) };
        // 2 MHz into the PLL, times 168, divided by 2 for the core and by 7 for what needs 48 MHz.
        RCC_PLLCFGR.write((mhz / 2) | 168 << 6 | source | 7 << 24);
        RCC_CR.set(0, PLL_ON);
        if !RCC_CR.wait_for(PLL_READY) {
            return Self::new(false, INTERNAL_MHZ * 1_000_000, INTERNAL_MHZ * 1_000_000, 1, 1);
        }
        watchdog.feed();
        // Five wait states at 168 MHz and 3.3 V; caches and prefetch on. Then the buses: core/2 and core/4, and the PLL.
        FLASH_ACR.write(5 | 0b111 << 8);
        RCC_CFGR.write(0b100 << 13 | 0b101 << 10 | 0b10);
        Self::new(crystal, 168_000_000, 84_000_000, 2, 4)
    }
}
