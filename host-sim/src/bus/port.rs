//! A node of a bus in real time: frames enter and are sent at once; events of the bus leave as they occur, with their
//! times.
//!
//! [`Bus`](super::Bus) is for a caller that sets the time itself; a port is for a caller that has to keep up with the
//! bus.

use super::Frame;
use holdover::time::Instant;
use std::io;

/// An event on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A frame that this port sent is on the bus now.
    Sent(Frame),
    /// A frame of another node.
    Received(Frame),
    /// An error of the bus, reported by the controller or by a node that plays one.
    Error(BusError),
    /// The interface has gone down. Until it is up again, no frame can be received or sent.
    Down,
}

/// The content of an error frame of Linux.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BusError {
    /// Its classes, as bits of the identifier (`linux/can/error.h`).
    pub classes: u32,
    /// The details.
    pub data: [u8; 8],
}

impl BusError {
    /// No node acknowledged a frame.
    pub const NO_ACKNOWLEDGEMENT: Self = Self { classes: 0x20, data: [0; 8] };
    /// The controller has left the bus.
    pub const BUS_OFF: Self = Self { classes: 0x40, data: [0; 8] };
    /// The classes with their names.
    const CLASSES: [(u32, &'static str); 10] = [
        (0x001, "transmission timeout"),
        (0x002, "lost arbitration"),
        (0x004, "controller problem"),
        (0x008, "protocol violation"),
        (0x010, "transceiver"),
        (0x020, "no acknowledgement"),
        (0x040, "bus off"),
        (0x080, "bus error"),
        (0x100, "restarted"),
        (0x200, "error counters"),
    ];

    /// The error in words.
    #[must_use]
    pub fn words(&self) -> String {
        let named = Self::CLASSES.iter().filter(|(class, _)| self.classes & class != 0).map(|(_, name)| *name);
        let named: Vec<_> = named.collect();
        if named.is_empty() { format!("class {:#x}", self.classes) } else { named.join(", ") }
    }
}

/// One node of a CAN bus in real time.
pub trait Port {
    /// The bus's time.
    fn now(&self) -> Instant;

    /// Sends a frame now.
    ///
    /// # Errors
    /// `NetworkDown` while the interface is down, and any other reason for which the system refuses the frame.
    fn send(&mut self, frame: Frame) -> io::Result<()>;

    /// Puts an error frame on the bus, as a controller would that detected an error.
    ///
    /// # Errors
    /// As [`Port::send`].
    fn send_error(&mut self, error: BusError) -> io::Result<()>;

    /// The next event, with its time. It waits for the event until `until` at the latest. An event that has already
    /// occurred is returned at once, whatever `until` is.
    ///
    /// # Errors
    /// Errors of the system.
    fn wait(&mut self, until: Instant) -> io::Result<Option<(Instant, Event)>>;
}

impl<P: Port + ?Sized> Port for Box<P> {
    fn now(&self) -> Instant {
        (**self).now()
    }

    fn send(&mut self, frame: Frame) -> io::Result<()> {
        (**self).send(frame)
    }

    fn send_error(&mut self, error: BusError) -> io::Result<()> {
        (**self).send_error(error)
    }

    fn wait(&mut self, until: Instant) -> io::Result<Option<(Instant, Event)>> {
        (**self).wait(until)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_said_in_words() {
        assert_eq!(BusError { classes: 0x44, data: [0; 8] }.words(), "controller problem, bus off");
        assert_eq!(BusError { classes: 0x1000, data: [0; 8] }.words(), "class 0x1000");
    }
}
