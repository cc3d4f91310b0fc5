//! What waits to be sent: the frames of a tick enter, and leave as fast as the port takes them. And what of it was lost.

use super::port::Port;
use embedded_can::Frame;
use heapless::Deque;
use holdover::health::Incident;

/// Frames that may wait: twice what one tick sends at most.
const CAPACITY: usize = 32;

/// What became of the oldest frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// There is none.
    Nothing,
    /// The port has taken it.
    Taken,
    /// The port takes none now.
    Full,
}

/// A queue of the port's frames.
pub struct Outbox<F> {
    waiting: Deque<F, CAPACITY>,
    dropped: u32,
}

impl<F: Frame> Outbox<F> {
    /// Nothing waits.
    pub const fn new() -> Self {
        Self { waiting: Deque::new(), dropped: 0 }
    }

    /// Queues a frame. One that finds the queue full is dropped: a later one says the same, but newer.
    pub fn push(&mut self, frame: &impl Frame) {
        let queued = F::new(frame.id(), frame.data()).is_some_and(|frame| self.waiting.push_back(frame).is_ok());
        self.dropped = self.dropped.saturating_add(u32::from(!queued));
    }

    /// Gives the port the oldest frame.
    pub fn pass(&mut self, port: &mut impl Port<Frame = F>) -> Pass {
        let Some(frame) = self.waiting.front_mut() else { return Pass::Nothing };
        match port.transmit(frame) {
            // A frame that this one took the place of.
            Ok(Some(back)) => *frame = back,
            Err(nb::Error::WouldBlock) => return Pass::Full,
            result => {
                self.dropped = self.dropped.saturating_add(u32::from(result.is_err()));
                self.waiting.pop_front();
            }
        }
        Pass::Taken
    }

    /// What was lost since the last call, and how often; to be called every period. Behind a port that left the bus nothing
    /// waits any more: when it is back, that will have been overtaken.
    pub fn lost(&mut self, port_left_bus: bool) -> [(Incident, u32); 2] {
        if port_left_bus {
            self.dropped = self.dropped.saturating_add(self.waiting.len() as u32);
            self.waiting.clear();
        }
        let dropped = core::mem::take(&mut self.dropped);
        [(Incident::TransmitOverflow, dropped), (Incident::BusOff, u32::from(port_left_bus))]
    }
}
