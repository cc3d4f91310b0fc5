//! A vehicle's V2X modem: the unit's `Own*` frames enter and a message for the channel leaves; messages from the channel
//! enter and `Peer*` frames on the vehicle's own bus leave, with that bus's own counters.
//!
//! *Slots:* a station without a slot gets a free one, or else that of the station that has been silent longest, if that is
//! at least [`SLOT_REUSE_S`], or else that of the farthest one, if that is farther than it by more than [`FARTHER_M`];
//! otherwise it is not relayed, and counted. So the slots go to those nearest, whom the unit follows among them, and two
//! stations at nearly the same distance do not take turns.
//!
//! *Intents* are relayed when a station gets its slot, when they change, and otherwise every [`INTENT_EVERY_S`], so that
//! eight peers fit the bus.

use holdover::units::Position;
use holdover::wire::horizon::Knots;
use holdover::wire::intent::Intent;
use holdover::wire::motion::{Motion, WirePosition};
use holdover::wire::{BaseId, Frame, Message, Said, Sender, Slot, StationHash};

/// Slots of the unit.
pub const PEERS: usize = 8;

/// A station that has been silent for this long may lose its slot.
pub const SLOT_REUSE_S: f64 = 2.0;

/// A station that is farther than another one by this much may lose its slot to it.
pub const FARTHER_M: f64 = 10.0;

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
    position: WirePosition,
    intent: Option<(Intent, f64)>,
}

/// The receiving side.
#[derive(Clone, Debug)]
pub struct Relay {
    sender: Sender<PEERS>,
    slots: Vec<Option<Tenant>>,
    turned_away: u64,
    /// Where the vehicle itself is.
    own: Option<Position>,
}

impl Relay {
    /// On a bus whose catalogue starts at `base`.
    #[must_use]
    pub fn new(base: BaseId) -> Self {
        Self { sender: Sender::new(base), slots: vec![None; PEERS], turned_away: 0, own: None }
    }

    /// Messages that found no slot.
    #[must_use]
    pub fn turned_away(&self) -> u64 {
        self.turned_away
    }

    /// Takes note of where the vehicle itself is; before that, nobody is nearer than anybody else.
    pub fn place(&mut self, position: WirePosition) {
        self.own = Some(position.nearest_to(self.own.unwrap_or(Position::ZERO)));
    }

    /// Puts a message that was heard at `at_s` on the bus.
    pub fn hear(&mut self, at_s: f64, message: &V2xMessage, frames: &mut Vec<Frame>) {
        let Some(slot) = self.slot_of(&message.motion, at_s) else {
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

    fn slot_of(&mut self, motion: &Motion, at_s: f64) -> Option<usize> {
        let held = |tenant: &Option<Tenant>| tenant.is_some_and(|tenant| tenant.station == motion.station);
        let slot = self.slots.iter().position(held).or_else(|| self.free_slot(motion, at_s))?;
        let intent = self.slots[slot].filter(|tenant| tenant.station == motion.station).and_then(|held| held.intent);
        let (station, position) = (motion.station, motion.position);
        self.slots[slot] = Some(Tenant { station, heard_s: at_s, position, intent });
        Some(slot)
    }

    fn free_slot(&self, motion: &Motion, at_s: f64) -> Option<usize> {
        if let Some(free) = self.slots.iter().position(Option::is_none) {
            return Some(free);
        }
        let heard_s = |slot: &usize| self.slots[*slot].map_or(0.0, |tenant| tenant.heard_s);
        let longest = (0..self.slots.len()).min_by(|a, b| heard_s(a).total_cmp(&heard_s(b)))?;
        if at_s - heard_s(&longest) >= SLOT_REUSE_S - 1e-9 {
            return Some(longest);
        }
        let distance_m = |slot: &usize| self.slots[*slot].map_or(0.0, |tenant| self.distance_m(tenant.position));
        let farthest = (0..self.slots.len()).max_by(|a, b| distance_m(a).total_cmp(&distance_m(b)))?;
        (distance_m(&farthest) > self.distance_m(motion.position) + FARTHER_M).then_some(farthest)
    }

    fn distance_m(&self, position: WirePosition) -> f64 {
        self.own.map_or(0.0, |own| position.nearest_to(own).ahead_of(own).magnitude().get().to_num())
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

#[cfg(test)]
mod tests {
    use super::*;
    use holdover::time::Stamp;
    use holdover::units::{Acceleration, Distance, FineSeconds, Gain, Jerk, Seconds, Speed};
    use holdover::wire::intent::Limits;
    use holdover::wire::{Predecessor, Received, Receiver, Role};

    fn message(station: u8, intent: Option<Intent>) -> V2xMessage {
        let motion = Motion {
            tag: 1,
            position: WirePosition::from_mm(i64::from(station) * 1000),
            speed: Speed::from_mm_per_s(10_000),
            acceleration: Acceleration::ZERO,
            demand: Acceleration::ZERO,
            stamp: Stamp::from_raw(7),
            position_accuracy: None,
            speed_accuracy: None,
            station: StationHash(station),
        };
        V2xMessage { motion, intent, horizon: None }
    }

    fn intent(target_speed: i32) -> Intent {
        Intent {
            length: Distance::from_mm(4800),
            standstill: Distance::from_mm(2000),
            predecessor: Predecessor::None,
            target_speed: Speed::from_mm_per_s(target_speed),
            time_gap: Seconds::from_millis(1000),
            gain: Gain::from_milli(500),
            damping: Seconds::from_millis(2000),
            lag: FineSeconds::from_millis(300),
            limits: Limits {
                acceleration: Acceleration::from_mm_per_s2(2000),
                braking: Acceleration::from_mm_per_s2(4000),
                jerk: Jerk::from_mm_per_s3(5000),
                emergency_braking: Acceleration::from_mm_per_s2(8000),
            },
            horizon_tenths: 39,
        }
    }

    /// The slots and stations of the motions, and how many intents, that a unit decodes from what is relayed.
    struct Unit {
        relay: Relay,
        receiver: Receiver<PEERS>,
    }

    impl Unit {
        fn new() -> Self {
            let base = BaseId::DEFAULT;
            let mut unit = Self { relay: Relay::new(base), receiver: Receiver::new(base, Role::Unit) };
            // The receiver trusts an identifier from its second frame on.
            for station in 1..=PEERS as u8 {
                unit.hear(-10.0, &message(station, Some(intent(1))));
                unit.hear(-10.0, &message(station, Some(intent(2))));
            }
            unit
        }

        fn hear(&mut self, at_s: f64, message: &V2xMessage) -> (Vec<(u8, u8)>, usize) {
            let mut frames = Vec::new();
            self.relay.hear(at_s, message, &mut frames);
            let (mut motions, mut intents) = (Vec::new(), 0);
            for frame in &frames {
                match self.receiver.receive(frame) {
                    Ok(Received::Whole(Message::Peer(slot, Said::Motion(motion)))) => {
                        motions.push((slot.0, motion.station.0));
                    }
                    Ok(Received::Whole(Message::Peer(_, Said::Intent(_)))) => intents += 1,
                    _ => {}
                }
            }
            (motions, intents)
        }
    }

    #[test]
    fn a_station_keeps_its_slot_and_a_ninth_is_turned_away_while_all_are_heard() {
        let mut unit = Unit::new();
        for round in 0..5 {
            let at_s = f64::from(round) * 0.1;
            for station in 1..=PEERS as u8 {
                assert_eq!(unit.hear(at_s, &message(station, None)).0, [(station - 1, station)]);
            }
            assert_eq!(unit.hear(at_s, &message(99, None)).0, []);
        }
        assert_eq!(unit.relay.turned_away(), 5);
    }

    #[test]
    fn the_station_silent_for_longest_makes_room_when_it_has_been_for_two_seconds() {
        let mut unit = Unit::new();
        for station in 1..=PEERS as u8 {
            unit.hear(f64::from(station) * 0.01, &message(station, None));
        }
        assert_eq!(unit.hear(2.009, &message(99, None)).0, []);
        assert_eq!(unit.hear(2.01, &message(99, None)).0, [(0, 99)]);
        // The one that lost its slot is a new station now.
        assert_eq!(unit.hear(2.02, &message(1, None)).0, [(1, 1)]);
    }

    #[test]
    fn a_nearer_station_takes_the_slot_of_the_farthest_and_one_at_the_same_distance_does_not() {
        let mut unit = Unit::new();
        // Stations 1 to 8 at 1 to 8 m; the vehicle is at 30 m, and then comes one at 9 m.
        unit.relay.place(WirePosition::from_mm(30_000));
        for station in 1..=PEERS as u8 {
            unit.hear(0.0, &message(station, None));
        }
        assert_eq!(unit.hear(0.1, &message(9, None)).0, [], "8 m nearer than the farthest");
        assert_eq!(unit.hear(0.1, &message(12, None)).0, [(0, 12)]);
        assert_eq!(unit.hear(0.2, &message(1, None)).0, []);
    }

    #[test]
    fn an_intent_is_relayed_when_it_changes_and_otherwise_twice_a_second() {
        let mut unit = Unit::new();
        assert_eq!(unit.hear(0.0, &message(3, Some(intent(11_000)))).1, 1);
        for tenth in 1..5 {
            assert_eq!(unit.hear(f64::from(tenth) * 0.1, &message(3, Some(intent(11_000)))).1, 0);
        }
        assert_eq!(unit.hear(0.5, &message(3, Some(intent(11_000)))).1, 1);
        assert_eq!(unit.hear(0.6, &message(3, Some(intent(12_000)))).1, 1);
    }

    #[test]
    fn a_horizon_is_broadcast_only_with_the_motion_it_was_computed_from() {
        let knots = |tag| Knots { tag, ..Knots { tag: 0, knots: Default::default() } };
        let mut transmitter = Transmitter::default();
        transmitter.take(&Said::Horizon(knots(1)));
        assert_eq!(transmitter.broadcast(), None);
        transmitter.take(&Said::Motion(message(1, None).motion));
        transmitter.take(&Said::Horizon(knots(2)));
        assert_eq!(transmitter.broadcast().unwrap().horizon, None);
        transmitter.take(&Said::Motion(message(1, None).motion));
        transmitter.take(&Said::Horizon(knots(1)));
        assert_eq!(transmitter.broadcast().unwrap().horizon, Some(knots(1)));
        assert_eq!(transmitter.broadcast(), None);
    }
}
