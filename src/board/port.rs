//! What a board needs of a CAN port: frames to be sent enter, and what became of each leaves; received frames leave.

use super::frame::CanFrame;

/// A CAN controller, or a serial CAN adapter.
pub trait Port {
    /// Whether it can take back one frame, and nothing else is lost by it.
    const TAKES_BACK: bool;

    /// The next received frame.
    ///
    /// # Errors
    /// A frame came before there was room for it, and is lost.
    fn receive(&mut self) -> Result<Option<CanFrame>, Overrun>;

    /// Takes a frame to be sent; the place in which it has it, or `None` if it has none now. Places count from 0, and are fewer than 256.
    fn load(&mut self, frame: &CanFrame) -> Option<usize>;

    /// What became of the frame in this place. Anything but [`Fate::Underway`] is told once, and then the place is free.
    fn fate(&mut self, place: usize) -> Fate;

    /// Asks for the frame in this place back. It may still be sent, if it is on the bus just now: its fate tells.
    fn recall(&mut self, place: usize);

    /// Whether the controller has left the bus since the last call, after too many errors, or could not be put onto it. To be
    /// called every period: a controller that does not come back by itself is brought back by this.
    fn left_bus(&mut self) -> bool;
}

/// What became of a frame that the port took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It waits for the bus, or is on it.
    Underway,
    /// It has been on the bus.
    Sent,
    /// It was taken back, and has not been on the bus.
    Back,
}

/// A frame, or a part of one, came before there was room for it, and is lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overrun;
