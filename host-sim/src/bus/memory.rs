//! A CAN bus in memory: frames that one node sends leave at every other node in the order of their times.
//!
//! The bus has no transmission time and no arbitration: frames of the same instant arrive in the order of sending. A
//! node may send ahead of time; no node receives the frame before its time. A log of the bus gets the times of a wire
//! from [`wire`](super::wire).

use super::{Bus, Frame};
use holdover::time::Instant;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::rc::Rc;

/// The bus. It lives as long as its nodes. All nodes belong to one thread, because one thread runs a world.
#[derive(Clone, Debug, Default)]
pub struct MemoryBus {
    inboxes: Rc<RefCell<Vec<Inbox>>>,
}

type Inbox = VecDeque<(Instant, Frame)>;

/// A node of a [`MemoryBus`].
#[derive(Debug)]
pub struct MemoryNode {
    bus: MemoryBus,
    index: usize,
}

impl MemoryBus {
    /// A bus without nodes.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Attaches one more node. It receives the frames that are sent from now on.
    #[must_use]
    pub fn node(&self) -> MemoryNode {
        let mut inboxes = self.inboxes.borrow_mut();
        inboxes.push(Inbox::new());
        MemoryNode { bus: self.clone(), index: inboxes.len() - 1 }
    }
}

impl Bus for MemoryNode {
    fn send(&mut self, at: Instant, frame: Frame) -> io::Result<()> {
        for (index, inbox) in self.bus.inboxes.borrow_mut().iter_mut().enumerate() {
            if index != self.index {
                insert(inbox, at, frame);
            }
        }
        Ok(())
    }

    fn receive(&mut self, upto: Instant) -> io::Result<Option<(Instant, Frame)>> {
        Ok(take(&mut self.bus.inboxes.borrow_mut()[self.index], upto))
    }
}

/// Inserts a frame after all frames that are not later. That is nearly always the end, so the search starts there.
pub(super) fn insert(inbox: &mut Inbox, at: Instant, frame: Frame) {
    let later = inbox.iter().rev().take_while(|(other, _)| *other > at).count();
    inbox.insert(inbox.len() - later, (at, frame));
}

/// Takes the first frame if its time has come.
pub(super) fn take(inbox: &mut Inbox, upto: Instant) -> Option<(Instant, Frame)> {
    inbox.pop_front_if(|(at, _)| *at <= upto)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(micros: u64) -> Instant {
        Instant::from_micros(micros)
    }

    fn frame(id: u16) -> Frame {
        Frame::standard(id, &[]).unwrap()
    }

    #[test]
    fn every_other_node_receives_a_frame_once_and_the_sender_does_not() {
        let bus = MemoryBus::new();
        let [mut a, mut b, mut c] = [bus.node(), bus.node(), bus.node()];
        a.send(at(5), frame(1)).unwrap();
        assert_eq!(a.receive(at(9)).unwrap(), None);
        for node in [&mut b, &mut c] {
            assert_eq!(node.receive(at(9)).unwrap(), Some((at(5), frame(1))));
            assert_eq!(node.receive(at(9)).unwrap(), None);
        }
    }

    #[test]
    fn frames_leave_in_the_order_of_time_and_then_of_sending() {
        let bus = MemoryBus::new();
        let (mut a, mut b) = (bus.node(), bus.node());
        for (time, id) in [(20, 1), (10, 2), (20, 3), (15, 4), (10, 5)] {
            a.send(at(time), frame(id)).unwrap();
        }
        let order: Vec<_> = std::iter::from_fn(|| b.receive(at(99)).unwrap()).collect();
        let expected = [(10, 2), (10, 5), (15, 4), (20, 1), (20, 3)];
        assert_eq!(order, expected.map(|(time, id)| (at(time), frame(id))));
    }

    #[test]
    fn nothing_is_received_before_its_time() {
        let bus = MemoryBus::new();
        let (mut a, mut b) = (bus.node(), bus.node());
        a.send(at(10), frame(1)).unwrap();
        assert_eq!(b.receive(at(9)).unwrap(), None);
        assert_eq!(b.receive(at(10)).unwrap(), Some((at(10), frame(1))));
    }
}
