//! The registers of a controller: byte offsets enter, words enter and leave. A driver that knows them by this alone runs on
//! the chip, and on a host against a test's model of the chip.

/// A block of 32-bit registers, or what a test puts in its place.
pub trait Registers {
    /// The word at a byte offset.
    fn read(&self, offset: usize) -> u32;
    /// Writes one.
    fn write(&mut self, offset: usize, word: u32);
}
