//! CAN buses behind one trait: a node sends frames, and receives in the order of time what the other nodes sent.
//!
//! [`memory`] is a bus inside the process; [`fault`] and [`record`] are middleware that wraps a node of any bus.

pub mod fault;
pub mod frame;
pub mod memory;
pub mod record;

pub use frame::Frame;
use holdover::time::Instant;
use std::io;

/// One node of a classic CAN bus.
pub trait Bus {
    /// Puts a frame on the bus at that time.
    ///
    /// # Errors
    /// The hardware's, or the operating system's; a bus in memory has none.
    fn send(&mut self, at: Instant, frame: Frame) -> io::Result<()>;

    /// Takes the oldest frame from another node that was on the bus at or before `upto`, and the time it was; `None`:
    /// there is none (yet). It does not wait.
    ///
    /// # Errors
    /// As [`Bus::send`].
    fn receive(&mut self, upto: Instant) -> io::Result<Option<(Instant, Frame)>>;
}

impl<B: Bus + ?Sized> Bus for Box<B> {
    fn send(&mut self, at: Instant, frame: Frame) -> io::Result<()> {
        (**self).send(at, frame)
    }

    fn receive(&mut self, upto: Instant) -> io::Result<Option<(Instant, Frame)>> {
        (**self).receive(upto)
    }
}
