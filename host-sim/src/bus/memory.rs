//! A CAN bus in memory: frames that one node sends leave at every other node in the order of their times.
//!
//! On a bus with a wire, frames take their time and are on the bus one after the other, and a node receives a frame at its
//! end. Without one, a frame takes no time, and frames of the same instant arrive in the order of sending: the side of a
//! real bus that is in this process. A node may send ahead of time; no node receives the frame before its time.

use super::wire::{Wanted, Wire, length};
use super::{Bus, Frame};
use holdover::time::{Duration, Instant};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io;
use std::rc::Rc;

/// The bus. It lives as long as its nodes. All nodes belong to one thread, because one thread runs a world.
#[derive(Clone, Debug, Default)]
pub struct MemoryBus {
    shared: Rc<RefCell<Shared>>,
}

#[derive(Clone, Debug, Default)]
struct Shared {
    wire: Option<Wire>,
    /// `None`: a node that only sends.
    inboxes: Vec<Option<Inbox>>,
    /// For each node, the last frame that it has sent, and when it was on the bus.
    confirmed: Vec<Option<(Instant, Frame)>>,
}

type Inbox = VecDeque<(Instant, Frame)>;

/// A node of a [`MemoryBus`].
#[derive(Debug)]
pub struct MemoryNode {
    bus: MemoryBus,
    index: usize,
}

impl MemoryBus {
    /// A bus without nodes, on which a frame takes no time.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A bus without nodes, with a wire.
    #[must_use]
    pub fn with_wire() -> Self {
        let bus = Self::new();
        bus.shared.borrow_mut().wire = Some(Wire::new());
        bus
    }

    /// For how long a frame is on the bus.
    #[must_use]
    pub fn length(&self, frame: &Frame) -> Duration {
        if self.shared.borrow().wire.is_some() { length(frame) } else { Duration::ZERO }
    }

    /// From now on a frame takes no time. Nothing has been sent yet.
    pub fn cut_wire(&self) {
        self.shared.borrow_mut().wire = None;
    }

    /// A bus of its own on which everything is as it is on this one. The nodes stay on this one; [`MemoryNode::on`] tells their places.
    #[must_use]
    pub fn copy(&self) -> Self {
        Self { shared: Rc::new(RefCell::new(self.shared.borrow().clone())) }
    }

    /// Attaches one more node. It receives the frames that are sent from now on.
    #[must_use]
    pub fn node(&self) -> MemoryNode {
        self.attach(Some(Inbox::new()))
    }

    /// Attaches a node that only sends.
    #[must_use]
    pub fn sender(&self) -> MemoryNode {
        self.attach(None)
    }

    fn attach(&self, inbox: Option<Inbox>) -> MemoryNode {
        let shared = &mut *self.shared.borrow_mut();
        shared.inboxes.push(inbox);
        shared.confirmed.push(None);
        MemoryNode { bus: self.clone(), index: shared.inboxes.len() - 1 }
    }
}

impl MemoryNode {
    /// The same node on a [copy](MemoryBus::copy) of its bus.
    #[must_use]
    pub fn on(&self, copy: &MemoryBus) -> Self {
        Self { bus: copy.clone(), index: self.index }
    }

    /// The last frame of this node that has been on the bus, and when: a controller's confirmation of transmission. As far as
    /// any node has received.
    #[must_use]
    pub fn confirmed(&self) -> Option<(Instant, Frame)> {
        self.bus.shared.borrow().confirmed[self.index]
    }

    /// Whether a frame that this node sent still waits for the bus at `now`.
    #[must_use]
    pub fn waits(&self, now: Instant, frame: &Frame) -> bool {
        let shared = &mut *self.bus.shared.borrow_mut();
        while shared.advance(now) {}
        shared.wire.as_ref().is_some_and(|wire| wire.waits(&Wanted { from: self.index, frame: *frame }))
    }
}

impl Shared {
    /// Carries the next frame if it starts before `upto`.
    fn advance(&mut self, upto: Instant) -> bool {
        let next = self.wire.as_mut().and_then(|wire| wire.next_before(upto));
        next.map(|(end, sent)| self.deliver(end, sent)).is_some()
    }

    /// A frame is on the bus at `at`.
    fn deliver(&mut self, at: Instant, sent: Wanted) {
        self.confirmed[sent.from] = Some((at, sent.frame));
        for (index, inbox) in self.inboxes.iter_mut().enumerate() {
            if let Some(inbox) = inbox.as_mut().filter(|_| index != sent.from) {
                insert(inbox, at, sent.frame);
            }
        }
    }
}

impl Bus for MemoryNode {
    fn send(&mut self, at: Instant, frame: Frame) -> io::Result<()> {
        let shared = &mut *self.bus.shared.borrow_mut();
        let wanted = Wanted { from: self.index, frame };
        match &mut shared.wire {
            Some(wire) => wire.want(at, wanted),
            None => shared.deliver(at, wanted),
        }
        Ok(())
    }

    fn receive(&mut self, upto: Instant) -> io::Result<Option<(Instant, Frame)>> {
        let shared = &mut *self.bus.shared.borrow_mut();
        // Frame by frame, so that what this node answers to one is on the bus among the next ones.
        loop {
            let received = shared.inboxes[self.index].as_mut().and_then(|inbox| take(inbox, upto));
            if received.is_some() || !shared.advance(upto) {
                return Ok(received);
            }
        }
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
    fn on_a_wire_a_frame_is_received_at_its_end_and_after_the_one_that_wins() {
        let bus = MemoryBus::with_wire();
        let [mut a, mut b, mut c] = [bus.node(), bus.sender(), bus.node()];
        a.send(at(10), frame(9)).unwrap();
        b.send(at(10), frame(4)).unwrap();
        assert_eq!(c.receive(at(10)).unwrap(), None);
        let mut ends = Vec::new();
        for id in [4, 9] {
            let (end, sent) = c.receive(at(10_000)).unwrap().unwrap();
            assert_eq!(sent, frame(id));
            ends.push(end.as_micros());
        }
        // A frame without data has 44 bits and its stuff bits, of 2 us each; three bits of intermission come before the second.
        assert!((10 + 88..10 + 108).contains(&ends[0]), "{ends:?}");
        assert!((94..114).contains(&(ends[1] - ends[0])), "{ends:?}");
        assert_eq!((a.confirmed(), c.confirmed()), (Some((at(ends[1]), frame(9))), None));
        assert_eq!(a.receive(at(10_000)).unwrap(), Some((at(ends[0]), frame(4))));
        assert_eq!(a.receive(at(10_000)).unwrap(), None);
    }

    #[test]
    fn a_copy_goes_on_as_the_bus_does_and_neither_hears_the_other() {
        let bus = MemoryBus::with_wire();
        let (mut a, mut b) = (bus.node(), bus.node());
        a.send(at(10), frame(1)).unwrap();
        let copy = bus.copy();
        let (mut c, mut d) = (a.on(&copy), b.on(&copy));
        let first = b.receive(at(5_000)).unwrap();
        assert!(first.is_some() && d.receive(at(5_000)).unwrap() == first);
        c.send(at(6_000), frame(2)).unwrap();
        assert_eq!(b.receive(at(9_000)).unwrap(), None);
        assert_eq!(d.receive(at(9_000)).unwrap().map(|(_, sent)| sent), Some(frame(2)));
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
