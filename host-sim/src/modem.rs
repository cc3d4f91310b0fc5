//! A vehicle's V2X modem: the unit's `Own*` frames enter and a message for the channel leaves; messages from the channel
//! enter and `Peer*` frames on the vehicle's own bus leave, with that bus's own counters.
//!
//! *Slots:* a station keeps its slot until it has been silent for [`SLOT_REUSE_S`]. A station without a slot gets a free
//! one, or else that of the station that has been silent longest, if that is long enough; otherwise it is not relayed,
//! and counted. Whom the unit follows can therefore not be pushed out by others while it is heard.
//!
//! *Intents* are relayed when a station gets its slot, when they change, and otherwise every [`INTENT_EVERY_S`], so that
//! eight peers fit the bus.

use holdover::wire::horizon::Knots;
use holdover::wire::intent::Intent;
use holdover::wire::motion::Motion;
use holdover::wire::{BaseId, Frame, Message, Said, Sender, Slot, StationHash};

/// Slots of the unit.
pub const PEERS: usize = 8;

/// A station that has been silent for this long may lose its slot.
pub const SLOT_REUSE_S: f64 = 2.0;

/// Time between two relays of an intent that does not change.
pub const INTENT_EVERY_S: f64 = 0.5;

/// What one vehicle broadcasts at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct V2xMessage {
    /// Its state.
    pub motion: Motion,
    /// How it drives; `None` if it does not say.
    pub intent: Option<Intent>,
    /// Its horizon from that state, if it computed one.
    pub horizon: Option<Knots>,
}

/// What the unit said since the last broadcast.
#[derive(Clone, Debug, Default)]
pub struct Transmitter {
    motion: Option<Motion>,
    intent: Option<Intent>,
    horizon: Option<Knots>,
}

impl Transmitter {
    /// Takes in one of the unit's own messages.
    pub fn take(&mut self, said: &Said) {
        match said {
            Said::Motion(motion) => self.motion = Some(*motion),
            Said::Intent(intent) => self.intent = Some(*intent),
            Said::Horizon(knots) => self.horizon = Some(*knots),
            Said::Geo(_) | Said::Route(_) => {}
        }
    }

    /// What is to be broadcast now, if the unit has said where it is. An intent holds until the next one.
    pub fn broadcast(&mut self) -> Option<V2xMessage> {
        let motion = self.motion.take()?;
        let horizon = self.horizon.take().filter(|knots| knots.tag == motion.tag);
        Some(V2xMessage { motion, intent: self.intent, horizon })
    }
}

/// A slot in use.
#[derive(Clone, Copy, Debug)]
struct Tenant {
    station: StationHash,
    heard_s: f64,
    intent: Option<(Intent, f64)>,
}

/// The receiving side.
#[derive(Clone, Debug)]
pub struct Relay {
    sender: Sender<PEERS>,
    slots: Vec<Option<Tenant>>,
    turned_away: u64,
}

impl Relay {
    /// On a bus whose catalogue starts at `base`.
    #[must_use]
    pub fn new(base: BaseId) -> Self {
        Self { sender: Sender::new(base), slots: vec![None; PEERS], turned_away: 0 }
    }

    /// Messages that found no slot.
    #[must_use]
    pub fn turned_away(&self) -> u64 {
        self.turned_away
    }

    /// Puts a message that was heard at `at_s` on the bus.
    pub fn hear(&mut self, at_s: f64, message: &V2xMessage, frames: &mut Vec<Frame>) {
        let Some(slot) = self.slot_of(message.motion.station, at_s) else {
            self.turned_away += 1;
            return;
        };
        let mut said = vec![Said::Motion(message.motion)];
        if let Some(intent) = message.intent.filter(|intent| self.is_intent_due(slot, intent, at_s)) {
            said.push(Said::Intent(intent));
        }
        said.extend(message.horizon.map(Said::Horizon));
        for said in said {
            #[allow(clippy::cast_possible_truncation)] // at most 16 slots
            let sent = self.sender.send(&Message::Peer(Slot(slot as u8), said), &mut |frame| frames.push(frame));
            debug_assert!(sent.is_ok(), "a peer says nothing that the catalogue has no line for");
        }
    }

    fn slot_of(&mut self, station: StationHash, at_s: f64) -> Option<usize> {
        let held = |tenant: &Option<Tenant>| tenant.is_some_and(|tenant| tenant.station == station);
        let slot = self.slots.iter().position(held).or_else(|| self.free_slot(at_s))?;
        match &mut self.slots[slot] {
            Some(tenant) if tenant.station == station => tenant.heard_s = at_s,
            free => *free = Some(Tenant { station, heard_s: at_s, intent: None }),
        }
        Some(slot)
    }

    fn free_slot(&self, at_s: f64) -> Option<usize> {
        if let Some(free) = self.slots.iter().position(Option::is_none) {
            return Some(free);
        }
        let heard_s = |slot: &usize| self.slots[*slot].map_or(0.0, |tenant| tenant.heard_s);
        let longest = (0..self.slots.len()).min_by(|a, b| heard_s(a).total_cmp(&heard_s(b)))?;
        (at_s - heard_s(&longest) >= SLOT_REUSE_S).then_some(longest)
    }

    fn is_intent_due(&mut self, slot: usize, intent: &Intent, at_s: f64) -> bool {
        let Some(tenant) = &mut self.slots[slot] else { return false };
        let is_due =
            tenant.intent.is_none_or(|(last, last_s)| last != *intent || at_s - last_s >= INTENT_EVERY_S - 1e-9);
        if is_due {
            tenant.intent = Some((*intent, at_s));
        }
        is_due
    }
}
