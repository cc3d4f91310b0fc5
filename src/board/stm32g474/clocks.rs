//! The clock tree: the oscillators as they are after a reset enter, a core at 170 MHz leaves.
//!
//! The crystal drives the CAN controller itself, so its bit timing rests on nothing else. Where it does not start, the internal
//! oscillator drives the same PLL, and the unit at least keeps its period. This has run on no chip.

use super::registers::{FLASH_ACR, PWR_CR5, RCC_APB1ENR, RCC_CCIPR, RCC_CFGR, RCC_CR, RCC_PLLCFGR};
use super::wiring::WIRING;
use crate::board::stm32::watchdog::Watchdog;

const CRYSTAL_MHZ: u32 = WIRING.crystal_mhz;
const _: () = assert!(
    CRYSTAL_MHZ.is_multiple_of(8) && 8 <= CRYSTAL_MHZ && CRYSTAL_MHZ <= 48,
    "the PLL takes 4 MHz of it, and CAN a whole number of 8 MHz"
);

/// The internal oscillator, from which the chip starts.
const INTERNAL_MHZ: u32 = 16;
/// What the PLL takes, multiplies by 85 and halves.
const INTO_PLL_MHZ: u32 = 4;
const CORE_HZ: u32 = 170_000_000;

/// Frequencies of the core and of its peripherals.
pub struct Clocks {
    pub core_hz: u32,
    /// Whether the crystal drives it.
    pub is_by_crystal: bool,
    /// Of the timers.
    pub counter_hz: u32,
    /// Of the CAN controller; 0: none that a bus bears.
    pub can_hz: u32,
}

impl Clocks {
    const fn new(is_by_crystal: bool, core_hz: u32) -> Self {
        // The controller's clock may not be faster than the bus that it is on, which is as fast as the core.
        let can_hz = if is_by_crystal && core_hz == CORE_HZ { CRYSTAL_MHZ * 1_000_000 } else { 0 };
        Self { core_hz, is_by_crystal, counter_hz: core_hz, can_hz }
    }

    /// Starts them; each of two waits feeds the watchdog.
    pub fn start(watchdog: &mut Watchdog) -> Self {
        const CRYSTAL_ON: u32 = 1 << 16;
        const CRYSTAL_READY: u32 = 1 << 17;
        const PLL_ON: u32 = 1 << 24;
        const PLL_READY: u32 = 1 << 25;
        const POWER: u32 = 1 << 28;
        RCC_CR.set(0, CRYSTAL_ON);
        let crystal = RCC_CR.wait_for(CRYSTAL_READY);
        watchdog.feed();
        let (mhz, source) = if crystal { (CRYSTAL_MHZ, 0b11) } else { (INTERNAL_MHZ, 0b10) };
        RCC_PLLCFGR.write(source | (mhz / INTO_PLL_MHZ - 1) << 4 | 85 << 8 | 1 << 24);
        RCC_CR.set(0, PLL_ON);
        if !RCC_CR.wait_for(PLL_READY) {
            return Self::new(false, INTERNAL_MHZ * 1_000_000);
        }
        watchdog.feed();
        // Above 150 MHz the regulator gives more; and above 80 MHz the core comes by way of half the clock, for a microsecond.
        RCC_APB1ENR.enable(POWER);
        PWR_CR5.set(1 << 8, 0);
        // Four wait states at 170 MHz; caches and prefetch on.
        FLASH_ACR.set(0xf, 4 | 0b111 << 8);
        FLASH_ACR.read(); // then they are there
        RCC_CFGR.write(0b1000 << 4 | 0b11);
        cortex_m::asm::delay(CORE_HZ / 1_000_000);
        RCC_CFGR.write(0b11);
        RCC_CCIPR.set(0b11 << 24, 0); // CAN by the crystal
        Self::new(crystal, CORE_HZ)
    }
}
