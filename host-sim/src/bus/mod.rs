//! CAN buses behind one trait: a node sends frames, and receives the frames of the other nodes in the order of time.
//!
//! [`memory`] is a bus inside the process; `socketcan` is an interface of Linux; [`fault`] and [`record`] are
//! middleware that wraps a node of any bus. [`port`] is a node that follows the bus's own time. [`wire`] says when the
//! frames of a bus in memory are on the bus.

pub mod candump;
pub mod fault;
pub mod frame;
pub mod memory;
pub mod port;
pub mod record;
#[cfg(target_os = "linux")]
pub mod socketcan;
pub mod wire;

use crate::error::Error;
pub use frame::Frame;
use holdover::time::Instant;
pub use port::Port;
use std::io;

/// Opens a CAN interface of this machine.
///
/// # Errors
/// The errors of [`socketcan::SocketCan::open`].
#[cfg(target_os = "linux")]
pub fn open(name: &str) -> Result<socketcan::SocketCan, Error> {
    socketcan::SocketCan::open(name).map_err(|error| error.in_option("--bus"))
}

/// Opens a CAN interface of this machine.
///
/// # Errors
/// Always: CAN interfaces are supported on Linux only.
#[cfg(not(target_os = "linux"))]
pub fn open(name: &str) -> Result<Box<dyn Port>, Error> {
    let cause = format!("{} is an interface of SocketCAN, which is Linux's", crate::error::quoted(name));
    Err(Error::new(cause, "run this command on Linux").in_option("--bus"))
}

/// One node of a CAN bus, classic or CAN FD.
pub trait Bus {
    /// Puts a frame on the bus at the time `at`.
    ///
    /// # Errors
    /// Errors of the hardware or of the operating system; a bus in memory has none.
    fn send(&mut self, at: Instant, frame: Frame) -> io::Result<()>;

    /// Takes the oldest frame of another node that was on the bus at or before `upto`, with its time; `None`: there is
    /// none yet. It does not wait.
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
