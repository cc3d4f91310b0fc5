//! Sleep: how long there is nothing to do enters; the core is halted meanwhile, until then or until a frame has come.

use super::can::Registers;
use super::registers::{self, Block};

/// A counter of the emulator's that interrupts, to sleep by. Its interrupt is wired to the core as IRQ and the CAN
/// controller's as FIQ, by who starts the emulator. Both stay masked: a halted core is woken by them all the same, and then
/// asks for itself what there is to do.
pub struct Alarm(Block);

impl Alarm {
    const CLOCK: usize = 0x00;
    const CONTROL: usize = 0x0c;
    const INTERVAL: usize = 0x24;
    const EVENTS: usize = 0x54;
    const INTERRUPTS: usize = 0x60;

    /// Every 32nd of the model's cycles.
    const PRESCALED: u32 = 1 | (5 - 1) << 1;
    /// The model's cycles in a microsecond.
    const CYCLES: u64 = 133;
    /// From 0 on, up to the interval.
    const ANEW: u32 = 1 << 1 | 1 << 4;
    /// The interval has passed.
    const PASSED: u32 = 1 << 0;

    pub fn start(mut block: Block) -> Self {
        block.write(Self::CLOCK, Self::PRESCALED);
        block.write(Self::INTERRUPTS, Self::PASSED);
        Self(block)
    }

    /// Halts the core for so long, at most 15 ms, or until a frame waits to be received.
    pub fn sleep(&mut self, micros: u64) {
        let steps = (micros * Self::CYCLES / 32).min(0xffff);
        // To read the events clears them. First, so that none of what is begun here is lost.
        self.0.read(Self::EVENTS);
        self.0.write(Self::INTERVAL, steps as u32);
        self.0.write(Self::CONTROL, Self::ANEW);
        registers::halt();
    }
}
