//! A node of a bus that runs by its own time: frames enter and are sent at once; what happens on the bus leaves when it
//! does, with the time at which it did.
//!
//! [`Bus`](super::Bus) is for those who make time themselves; a port is for those who have to keep up with it.

use super::Frame;
use holdover::time::Instant;
use std::io;

/// Something that happened on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A frame that this port sent is on the bus now.
    Sent(Frame),
    /// A frame of another node.
    Received(Frame),
    /// The controller, or somebody who plays one, reports an error of the bus.
    Error(BusError),
    /// The interface has gone down: nothing is heard and nothing can be sent until it is up again.
    Down,
}

/// What an error frame of Linux says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BusError {
    /// Its classes, as bits of the identifier (`linux/can/error.h`).
    pub classes: u32,
    /// The details.
    pub data: [u8; 8],
}

impl BusError {
    /// Nobody acknowledged a frame.
    pub const NO_ACKNOWLEDGEMENT: Self = Self { classes: 0x20, data: [0; 8] };
    /// The controller has left the bus.
    pub const BUS_OFF: Self = Self { classes: 0x40, data: [0; 8] };
    /// Classes with their names.
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

    /// What it says, in words.
    #[must_use]
    pub fn words(&self) -> String {
        let named = Self::CLASSES.iter().filter(|(class, _)| self.classes & class != 0).map(|(_, name)| *name);
        let named: Vec<_> = named.collect();
        if named.is_empty() { format!("class {:#x}", self.classes) } else { named.join(", ") }
    }
}

/// One node of a classic CAN bus in real time.
pub trait Port {
    /// The bus's time.
    fn now(&self) -> Instant;

    /// Sends a frame now.
    ///
    /// # Errors
    /// `NetworkDown` while the interface is down, and whatever else the system refuses it for.
    fn send(&mut self, frame: Frame) -> io::Result<()>;

    /// Puts an error frame on the bus, as a controller would that met with an error.
    ///
    /// # Errors
    /// As [`Port::send`].
    fn send_error(&mut self, error: BusError) -> io::Result<()>;

    /// The next thing that happens, with its time, waiting for it until then at the latest; what has happened already
    /// comes at once, whatever `until` is.
    ///
    /// # Errors
    /// The system's.
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
