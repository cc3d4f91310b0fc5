//! The time master of a vehicle's bus. GNSS time enters; the two messages of the time base leave. A `FollowUp` says when its `Sync` was
//! on the bus, which only the bus can tell. What the vehicle takes for GNSS time may be off.

use std::io;

use holdover::time::{Duration, GnssTime, Instant};
use holdover::wire::sync::{FollowUp, Sync};
use holdover::wire::{Message, Sender};

use super::{Vehicle, frames};
use crate::bus::memory::{MemoryBus, MemoryNode};
use crate::bus::{Bus, Frame};
use crate::sim::time::gnss;

/// The time master.
pub(super) struct TimeMaster {
    bus: MemoryBus,
    node: MemoryNode,
    sequence: u8,
    /// The `Sync` whose `FollowUp` is still to be sent, and its frame.
    pending: Option<(Sync, Frame)>,
    is_awake: bool,
    /// By how much its time is ahead of GNSS time, in seconds.
    ahead_s: f64,
}

impl Vehicle {
    /// From now on the vehicle takes for GNSS time what is ahead of it by `ahead_s`; negative: behind it. It has to be
    /// called before the vehicle's time base speaks.
    pub fn mistake_time(&mut self, ahead_s: f64) {
        self.master.ahead_s = ahead_s;
    }
}

impl TimeMaster {
    /// A time master that has not sent anything yet.
    pub fn on(bus: &MemoryBus) -> Self {
        Self { bus: bus.clone(), node: bus.sender(), sequence: 0, pending: None, is_awake: false, ahead_s: 0.0 }
    }

    /// The same time master on a copy of its bus.
    pub fn beside(&self, copy: &MemoryBus) -> Self {
        Self { bus: copy.clone(), node: self.node.on(copy), ..*self }
    }

    /// Whether it has sent anything on the bus.
    pub fn is_awake(&self) -> bool {
        self.is_awake
    }

    /// What the vehicle takes for GNSS time at this time of the run.
    pub fn gnss(&self, at_s: f64) -> GnssTime {
        gnss(at_s + self.ahead_s)
    }

    /// Sends the first of the two messages, at an instant that is this time of the run. The very first one wakes the
    /// bus: it ends when the unit's first tick begins, so a log's first frame tells when that was.
    pub fn synchronise(&mut self, sender: &mut Sender<0>, at: Instant, at_s: f64) -> io::Result<()> {
        self.sequence = (self.sequence + 1) % 16;
        let sync = Sync { sequence: self.sequence, seconds: (self.gnss(at_s).as_micros() / 1_000_000) as u32 };
        let frames = frames(sender, &Message::Sync(sync))?;
        for frame in &frames {
            let before = if self.is_awake { Duration::ZERO } else { self.bus.length(frame) };
            self.node.send(at.minus(before), *frame)?;
        }
        self.is_awake = true;
        self.pending = frames.last().map(|frame| (sync, *frame));
        Ok(())
    }

    /// Sends the second one, if the first one has been on the bus. `time_of` tells the time of the run at an instant.
    pub fn follow_up(&mut self, sender: &mut Sender<0>, time_of: impl Fn(Instant) -> f64) -> io::Result<()> {
        let Some((sync, frame)) = self.pending else { return Ok(()) };
        let Some((at, _)) = self.node.confirmed().filter(|(_, sent)| *sent == frame) else { return Ok(()) };
        self.pending = None;
        let since = self.gnss(time_of(at)).as_micros().saturating_sub(u64::from(sync.seconds) * 1_000_000);
        let follow_up = FollowUp { sequence: sync.sequence, micros: since as u32 };
        let frames = frames(sender, &Message::FollowUp(follow_up))?;
        frames.iter().try_for_each(|frame| self.node.send(at, *frame))
    }
}
