//! What waits to be sent: the frames of a tick enter, and leave as fast as the port takes them. And what of it was lost.
//!
//! A bus may be blocked for seconds: nobody acknowledges, or others take all of it. What has waited meanwhile would be news to
//! a receiver, because counter and checksum fit. So nothing stale leaves:
//!
//! - *The newest message alone.* A frame of a later tick takes the place of those of its identifier that wait. Frames of one
//!   tick and one identifier are the parts of one message, and leave in their order.
//! - *An age.* What has waited for longer than [`MOST_AGE`] is dropped, also out of the port.
//! - *The most urgent first,* by the rule of the bus: the lower the identifier, the earlier. By default that is the command.
//!
//! What is dropped is counted.

use super::frame::CanFrame;
use super::port::{Fate, Port};
use embedded_can::{Frame, Id};
use heapless::Vec;
use holdover::health::Incident;
use holdover::time::{Duration, Instant};

/// Frames that may wait: an answer has 20 at most, one message of each kind, and a port has three more that it was not asked
/// for back in vain.
const CAPACITY: usize = 32;

/// The time for which the envelope lets a command stay in force beyond its period (`envelope.delay`), by default.
pub const MOST_AGE: Duration = Duration::from_millis(30);

/// What became of the most urgent frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// There is none, and none is underway.
    Nothing,
    /// The port has taken it.
    Taken,
    /// The port takes none now, or what it has is underway.
    Full,
}

/// A frame on its way.
struct Waiting {
    frame: CanFrame,
    /// The time of its tick.
    since: Instant,
    /// Where the port has it: in a byte, because dozens wait.
    place: Option<u8>,
    /// A newer one waits, or the port has left the bus: it is not to be sent any more.
    is_overtaken: bool,
    /// The port was asked for it.
    is_recalled: bool,
}

/// The frames that wait, in the order in which they came.
pub struct Outbox {
    waiting: Vec<Waiting, CAPACITY>,
    dropped: u32,
    keeps_all: bool,
}

impl Outbox {
    /// Nothing waits.
    pub const fn new() -> Self {
        Self { waiting: Vec::new(), dropped: 0, keeps_all: false }
    }

    /// For a harness that compares every frame: what was pushed leaves in that order, whatever its age.
    pub const fn in_order() -> Self {
        Self { waiting: Vec::new(), dropped: 0, keeps_all: true }
    }

    /// Queues a frame of the tick at this time.
    pub fn push(&mut self, tick: Instant, frame: &impl Frame) {
        if !self.keeps_all {
            self.overtake(|waiting| waiting.frame.id() == frame.id() && waiting.since < tick);
        }
        let queued = CanFrame::new(frame.id(), frame.data()).is_some_and(|frame| {
            let waiting = Waiting { frame, since: tick, place: None, is_overtaken: false, is_recalled: false };
            self.waiting.push(waiting).is_ok()
        });
        self.dropped = self.dropped.saturating_add(u32::from(!queued));
    }

    /// Gives the port the most urgent frame that it can take.
    pub fn pass<P: Port>(&mut self, now: Instant, port: &mut P) -> Pass {
        self.settle(now, port);
        let Some(next) = self.next().and_then(|next| self.waiting.get_mut(next)) else {
            return if self.waiting.is_empty() { Pass::Nothing } else { Pass::Full };
        };
        next.place = port.load(&next.frame).and_then(|place| u8::try_from(place).ok());
        if next.place.is_some() {
            return Pass::Taken;
        }
        let urgency = urgency(next.frame.id());
        self.make_room(urgency, port);
        Pass::Full
    }

    /// What was lost since the last call, and how often; to be called every period. Behind a port that left the bus nothing
    /// waits any more: when it is back, that will have been overtaken.
    pub fn lost(&mut self, port: &mut impl Port) -> [(Incident, u32); 2] {
        let has_left = port.left_bus();
        if has_left {
            self.overtake(|_| true);
            for waiting in &mut self.waiting {
                waiting.recall(port);
            }
        }
        let dropped = core::mem::take(&mut self.dropped);
        [(Incident::TransmitOverflow, dropped), (Incident::BusOff, u32::from(has_left))]
    }

    /// Drops what these are, and marks what of it the port has.
    fn overtake(&mut self, is_meant: impl Fn(&Waiting) -> bool) {
        let Self { waiting, dropped, .. } = self;
        for waiting in waiting.iter_mut() {
            waiting.is_overtaken |= is_meant(waiting);
        }
        retain(waiting, dropped, |waiting| waiting.place.is_some() || !waiting.is_overtaken);
    }

    /// Takes note of what became of the frames that the port has, asks for those that are not to be sent any more, and drops
    /// what is too old.
    fn settle<P: Port>(&mut self, now: Instant, port: &mut P) {
        let Self { waiting, dropped, keeps_all } = self;
        waiting.retain_mut(|waiting| waiting.place.is_none_or(|place| waiting.is_still_here(port.fate(place.into()))));
        let is_old = |waiting: &Waiting| !*keeps_all && now.since(waiting.since) > MOST_AGE;
        retain(waiting, dropped, |waiting| waiting.place.is_some() || !waiting.is_overtaken && !is_old(waiting));
        for waiting in waiting.iter_mut() {
            if is_old(waiting) || P::TAKES_BACK && waiting.is_overtaken {
                waiting.recall(port);
            }
        }
    }

    /// The most urgent frame that the port does not have. One of an identifier that it has waits for that one: a controller
    /// would not keep their order.
    fn next(&self) -> Option<usize> {
        let is_loaded = |id| self.waiting.iter().any(|waiting| waiting.place.is_some() && waiting.frame.id() == id);
        let order = |waiting: &Waiting| if self.keeps_all { 0 } else { urgency(waiting.frame.id()) };
        let free = self.waiting.iter().enumerate().filter(|(_, waiting)| waiting.place.is_none());
        free.filter(|(_, waiting)| !is_loaded(waiting.frame.id()))
            .min_by_key(|(number, waiting)| (order(waiting), *number))
            .map(|(number, _)| number)
    }

    /// Asks for the least urgent of the frames that the port has, if one that is more urgent waits for a place.
    fn make_room<P: Port>(&mut self, wanted: u32, port: &mut P) {
        let placed = self.waiting.iter_mut().filter(|waiting| waiting.place.is_some());
        let least = placed.max_by_key(|waiting| urgency(waiting.frame.id()));
        if let Some(least) = least.filter(|least| urgency(least.frame.id()) > wanted)
            && P::TAKES_BACK
            && !self.keeps_all
        {
            least.recall(port);
        }
    }
}

impl Waiting {
    /// Takes note of its fate; whether it is still to be dealt with.
    fn is_still_here(&mut self, fate: Fate) -> bool {
        if fate == Fate::Back {
            self.place = None;
            self.is_recalled = false;
        }
        fate != Fate::Sent
    }

    fn recall(&mut self, port: &mut impl Port) {
        if let Some(place) = self.place.filter(|_| !self.is_recalled) {
            port.recall(place.into());
            self.is_recalled = true;
        }
    }
}

/// The outbox of the firmware. In lock step a harness compares every frame with a twin's, and judges itself what is late.
#[cfg(target_os = "none")]
pub const fn of_the_shell() -> Outbox {
    if cfg!(feature = "lock-step") { Outbox::in_order() } else { Outbox::new() }
}

/// Keeps these alone, and counts the others.
fn retain(waiting: &mut Vec<Waiting, CAPACITY>, dropped: &mut u32, is_kept: impl Fn(&Waiting) -> bool) {
    let before = waiting.len();
    waiting.retain(is_kept);
    *dropped = dropped.saturating_add(before.saturating_sub(waiting.len()) as u32);
}

/// The identifier as the bus compares it: the first 11 bits, then standard before extended, then the other 18 bits.
fn urgency(id: Id) -> u32 {
    match id {
        Id::Standard(id) => u32::from(id.as_raw()) << 19,
        Id::Extended(id) => (id.as_raw() >> 18) << 19 | 1 << 18 | id.as_raw() & 0x3_ffff,
    }
}
