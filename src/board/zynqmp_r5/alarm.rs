//! Sleep: when the next period begins enters; the core is halted until then, or until a frame has come.

use super::registers::{self, Block};
use crate::board::registers::Registers;

/// A counter of the emulator's that interrupts, to sleep by. Its interrupt is wired to the core as IRQ and the CAN
/// controller's as FIQ, by who starts the emulator. Both stay masked: a halted core is woken by them all the same, and then
/// asks for itself what there is to do.
pub struct Alarm(Block);

impl Alarm {
    const CLOCK: usize = 0x00;
    const CONTROL: usize = 0x0c;
    const MATCH: usize = 0x30;
    const EVENTS: usize = 0x54;
    const INTERRUPTS: usize = 0x60;

    /// Every 32nd of the model's cycles.
    const PRESCALED: u32 = 1 | (5 - 1) << 1;
    /// The model's cycles in a microsecond.
    const CYCLES: u64 = 133;
    /// From 0 on; around 65,536, not around the number to be matched: an interval of a microsecond would keep the emulator busy.
    const ANEW: u32 = 1 << 3 | 1 << 4;
    /// The number has been reached.
    const MATCHED: u32 = 1 << 1;

    /// Set to so many microseconds.
    pub fn start(mut block: Block, micros: u64) -> Self {
        block.write(Self::CLOCK, Self::PRESCALED);
        block.write(Self::INTERRUPTS, Self::MATCHED);
        let mut alarm = Self(block);
        alarm.set(micros);
        alarm
    }

    /// Interrupts after so many microseconds, at most 15,000, and goes on until it is set anew.
    pub fn set(&mut self, micros: u64) {
        let steps = (micros * Self::CYCLES / 32 + 1).min(0xffff);
        self.0.write(Self::MATCH, steps as u32);
        self.0.write(Self::CONTROL, Self::ANEW);
        // To read the events clears them.
        self.0.read(Self::EVENTS);
    }

    /// Halts the core until it interrupts, or a frame waits to be received; not at all, if that is so already.
    pub fn sleep(&self) {
        registers::halt();
    }
}
